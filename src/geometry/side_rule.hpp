#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace riven {

/// A quadrature point on a side of an element: shape functions of the side's nodes, corners first, and their
/// slopes along its one or two reference coordinates.
struct SidePoint {
  std::array<double, 4> value{};
  std::array<std::array<double, 4>, 2> slope{};
  double weight = 0;
};

/// Of a straight edge of two nodes, an edge of three with the middle one last, a triangle of three and a
/// quadrilateral of four. Exact for shape function times normal, in any deformation.
[[nodiscard]] const std::vector<SidePoint>& side_rule(int dimension, std::size_t nodes);

}  // namespace riven
