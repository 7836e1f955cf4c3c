#pragma once

#include <cstdint>
#include <vector>

#include "geometry/shape.hpp"

namespace riven {

/// Points sorted into squares or cubes, to find those near a place. The cubes have no bounds: their numbers
/// are hashed.
class Cubes {
 public:
  /// Keeps a reference to the points. `size` of a cube (m).
  Cubes(const std::vector<Point>& points, int dimension, double size);

  /// Numbers of the points within `distance` (at most the cubes' size) of x, ascending.
  [[nodiscard]] std::vector<std::size_t> within(const Point& x, double distance) const;
  /// The same into a list that is there already.
  void within(const Point& x, double distance, std::vector<std::size_t>& found) const;

 private:
  using Key = std::array<std::int64_t, 3>;
  struct Entry {
    Key key{};
    std::size_t number = 0;
  };

  [[nodiscard]] Key cube_of(const Point& x) const;
  [[nodiscard]] std::size_t bucket_of(const Key& key) const;

  const std::vector<Point>& points_;
  double size_;
  std::size_t dimension_;
  std::vector<std::size_t> begin_;  // of each bucket in entries_
  std::vector<Entry> entries_;
};

}  // namespace riven
