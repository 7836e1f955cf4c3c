#include "geometry/cubes.hpp"

#include <algorithm>
#include <cmath>

namespace riven {

Cubes::Cubes(const std::vector<Point>& points, int dimension, double size)
    : points_(points), size_(size), dimension_(static_cast<std::size_t>(dimension)) {
  for (std::size_t n = 0; n < points.size(); ++n) sorted_.emplace_back(cube_of(points[n]), n);
  std::sort(sorted_.begin(), sorted_.end());
}

Cubes::Key Cubes::cube_of(const Point& x) const {
  Key key{};
  for (std::size_t a = 0; a < dimension_; ++a) key[a] = static_cast<std::int64_t>(std::floor(x[a] / size_));
  return key;
}

std::vector<std::size_t> Cubes::within(const Point& x, double distance) const {
  std::vector<std::size_t> found;
  const Key center = cube_of(x);
  const auto along = [&](std::size_t axis) { return axis < dimension_ ? 1 : 0; };
  for (int i = -along(0); i <= along(0); ++i)
    for (int j = -along(1); j <= along(1); ++j) {
      // Cubes that differ in z alone follow one another.
      const Key first{center[0] + i, center[1] + j, center[2] - along(2)};
      const Key last{first[0], first[1], center[2] + along(2)};
      auto at = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(first, std::size_t{0}));
      for (; at != sorted_.end() && at->first <= last; ++at)
        if (std::hypot(points_[at->second][0] - x[0], points_[at->second][1] - x[1],
                       points_[at->second][2] - x[2]) <= distance)
          found.push_back(at->second);
    }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace riven
