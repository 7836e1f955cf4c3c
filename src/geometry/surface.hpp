#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/shape.hpp"

namespace riven {

/// Triangles on shared corners.
struct Triangles {
  std::vector<Point> corner;  // m
  std::vector<std::array<std::uint32_t, 3>> triangle;
};

/// A closed surface of triangles, and what lies inside of it. Bodies may touch, overlap (they count once) and
/// have cavities, whose triangles face the other way.
class Surface {
 public:
  /// Throws InputError unless every edge is run through as often in one direction as in the other, and the
  /// triangles enclose a volume. Triangles that all face inwards are taken as if they faced outwards.
  explicit Surface(Triangles triangles);

  [[nodiscard]] std::size_t size() const { return mesh_.triangle.size(); }
  /// The smallest box around it.
  [[nodiscard]] const Box& box() const { return box_; }
  /// Enclosed volume (m^3) by the divergence theorem; overlaps count twice.
  [[nodiscard]] double volume() const { return volume_; }
  /// For each face of the box, lower and upper along x, y, z: whether triangles cover all of it.
  [[nodiscard]] std::array<bool, 6> filled_faces() const;

  /// Parts that lie inside of `count` cubes of edge `spacing` (m) in a row along x, the first one centred at
  /// `first`. Lengths of 4 x 4 lines along x through each cube: exact for boxes that end at or between cubes
  /// along x and at quarters of them across; the volume of a ball 20 cells across errs by 1e-4, with an
  /// order of 3/2 and more. Throws InputError where triangles face inwards that enclose a body of their own.
  [[nodiscard]] std::vector<double> covered_fractions(const Point& first, double spacing, int count) const;

 private:
  struct Crossing {
    double x = 0;  // m
    int into = 0;  // 1 into the body, -1 out of it
  };

  void check_closed() const;
  void measure();
  void fill_bins();
  [[nodiscard]] std::size_t bin_of(std::size_t axis, double x) const;
  [[nodiscard]] const std::vector<std::uint32_t>& near(double y, double z) const;
  [[nodiscard]] bool crossings(double y, double z, std::vector<Crossing>& found) const;
  [[nodiscard]] std::vector<Interval> inside(double y, double z, double step) const;

  Triangles mesh_;
  Box box_;
  double volume_ = 0;
  int outwards_ = 1;                             // -1: all triangles face inwards
  std::size_t bins_ = 1;                         // along y and along z
  std::vector<std::vector<std::uint32_t>> bin_;  // triangles over each bin of the box's y-z side
};

}  // namespace riven
