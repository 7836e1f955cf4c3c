#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/shape.hpp"

namespace riven {

/// Points sorted into squares or cubes, to find those near a place.
class Cubes {
 public:
  /// Keeps a reference to the points. `size` of a cube (m).
  Cubes(const std::vector<Point>& points, int dimension, double size);

  /// Numbers of the points within `distance` (at most the cubes' size) of x, ascending.
  [[nodiscard]] std::vector<std::size_t> within(const Point& x, double distance) const;

 private:
  using Key = std::array<std::int64_t, 3>;

  [[nodiscard]] Key cube_of(const Point& x) const;

  const std::vector<Point>& points_;
  double size_;
  std::size_t dimension_;
  std::vector<std::pair<Key, std::size_t>> sorted_;
};

}  // namespace riven
