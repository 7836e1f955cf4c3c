#pragma once

#include <vector>

#include "geometry/lattice.hpp"

namespace riven {

/// The neighbours of a lattice point within the horizon: neighbour k of point i is `i + shift[k]`.
struct Stencil {
  std::vector<Cell> offset;           // in cells; no (0, 0, 0)
  std::vector<std::ptrdiff_t> shift;  // in storage entries
  std::vector<std::size_t> opposite;  // offset[opposite[k]] = -offset[k]
  std::vector<Point> bond;            // reference bond vector (m)
  std::vector<double> length;         // |bond| (m)

  [[nodiscard]] std::size_t size() const { return offset.size(); }
};

/// The horizon with a relative slack, far above rounding and far below the gap between neighbour shells: a
/// horizon of n spacings means n also where rounding put it a little below.
double horizon_limit(double horizon);

/// Largest number of cells along an axis within the horizon.
int stencil_reach(double horizon, double spacing);

/// All neighbours whose distance is at most the horizon (m), sorted by storage shift.
Stencil make_stencil(const Lattice& lattice, double horizon);

}  // namespace riven
