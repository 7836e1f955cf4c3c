#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace riven {

/// What of a result is left out where a page would become too large.

/// A number of output states, and of points in each.
struct Extent {
  std::size_t states = 0, points = 0;
  bool operator==(const Extent&) const = default;
};

/// Bytes that the fields of a result take in a page.
struct ViewSize {
  Extent all;
  double fixed = 0;      // whatever is left out
  double per_point = 0;  // a position
  double per_value = 0;  // a point in one state
  bool mesh = false;     // its points cannot be left out

  [[nodiscard]] double bytes(const Extent& of) const;
};

/// What fits: states are left out until 40 remain, then points until 100 000 remain, then states until 10
/// remain, then points. A mesh keeps its points. No states or no points: nothing fits.
Extent fitting(const ViewSize& size, double budget);

/// Parts of a budget: what needs less than an equal part gets what it needs, the others share the rest. If
/// all get what they need, what remains is shared out.
std::vector<double> shares(const std::vector<double>& needs, double budget);

/// `count` of the numbers 0 to `of` - 1: the last one, and if there are more the first and evenly spaced
/// ones.
std::vector<std::size_t> evenly_spaced(std::size_t count, std::size_t of);

using Positions = std::span<const std::array<double, 3>>;

/// Some of the points of a cloud.
struct Selection {
  std::vector<std::size_t> points;  // rising
  double cell = 0;                  // m; edge of the cells of which each shown point stands for one
};

/// One point of each occupied cell of a grid: the one nearest the cell's centre, the first of several. The
/// cells begin half a spacing before the lowest positions, so that those of a lattice lie within cells.
Selection one_per_cell(Positions positions, double spacing, double cell);

/// The same with cells so large that at most `most` points remain, and not many fewer.
Selection thinned(Positions positions, double spacing, std::size_t most);

}  // namespace riven
