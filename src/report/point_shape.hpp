#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/shape.hpp"

namespace riven {

/// What a point stands for in a picture: a cell as wide as the distance to its neighbours, which deforms with
/// them.
struct PointShape {
  double spacing = 0;               // m, undeformed
  std::array<double, 9> gradient;   // of the deformation, row by row
  std::array<bool, 6> joined = {};  // to a neighbour in the direction -x, x, -y, y, -z, z of a lattice
};

struct PointShapes {
  std::vector<PointShape> shapes;
  bool on_lattice = false;  // all spacings are the same: cells are squares or cubes
};

/// Shapes of points from where they and their neighbours were and are (m); the body extends along `axes`.
/// Neighbours that have moved far away tell nothing: those behind a crack do not open a cell.
PointShapes point_shapes(const std::vector<Point>& positions, std::span<const Point> deformed,
                         const std::vector<std::size_t>& axes);

}  // namespace riven
