#pragma once

#include <span>
#include <vector>

#include "geometry/shape.hpp"

namespace riven {

/// From places in space to a plane of view. Bodies in one or two dimensions are seen along the axes that they
/// do not use, bodies in three from above one corner (isometric): x to the lower right, y to the upper right,
/// z up.
class Projection {
 public:
  /// `positions` decide in which directions the body extends.
  explicit Projection(std::span<const Point> positions);

  /// Directions in which the body extends, 1 to 3.
  [[nodiscard]] int dimension() const { return static_cast<int>(axes_.size()); }
  /// Which they are, ascending.
  [[nodiscard]] const std::vector<std::size_t>& axes() const { return axes_; }

  /// A place on the plane: to the right, up, and towards the viewer (m).
  [[nodiscard]] Point operator()(const Point& place) const;

 private:
  std::vector<std::size_t> axes_;
};

}  // namespace riven
