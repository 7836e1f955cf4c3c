#include "geometry/cubes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace riven {

Cubes::Cubes(const std::vector<Point>& points, int dimension, double size)
    : points_(points),
      size_(size),
      dimension_(static_cast<std::size_t>(dimension)),
      begin_(std::bit_ceil(2 * points.size() + 1) + 1),
      entries_(points.size()) {
  std::vector<std::size_t> bucket(points.size());
  for (std::size_t n = 0; n < points.size(); ++n) ++begin_[(bucket[n] = bucket_of(cube_of(points[n]))) + 1];
  for (std::size_t b = 1; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t n = 0; n < points.size(); ++n) entries_[next[bucket[n]]++] = {cube_of(points[n]), n};
}

Cubes::Key Cubes::cube_of(const Point& x) const {
  Key key{};
  for (std::size_t a = 0; a < dimension_; ++a) key[a] = static_cast<std::int64_t>(std::floor(x[a] / size_));
  return key;
}

/// Multiples of large odd numbers, the upper bits of whose product are mixed best; the number of buckets is a
/// power of two.
std::size_t Cubes::bucket_of(const Key& key) const {
  const std::uint64_t mixed = static_cast<std::uint64_t>(key[0]) * 0x9e3779b97f4a7c15U +
                              static_cast<std::uint64_t>(key[1]) * 0xc2b2ae3d27d4eb4fU +
                              static_cast<std::uint64_t>(key[2]) * 0x165667b19e3779f9U;
  return static_cast<std::size_t>((mixed ^ (mixed >> 32)) & (begin_.size() - 2));
}

std::vector<std::size_t> Cubes::within(const Point& x, double distance) const {
  std::vector<std::size_t> found;
  within(x, distance, found);
  return found;
}

void Cubes::within(const Point& x, double distance, std::vector<std::size_t>& found) const {
  found.clear();
  const Key center = cube_of(x);
  const auto along = [&](std::size_t axis) { return axis < dimension_ ? 1 : 0; };
  for (int i = -along(0); i <= along(0); ++i)
    for (int j = -along(1); j <= along(1); ++j)
      for (int k = -along(2); k <= along(2); ++k) {
        const Key key{center[0] + i, center[1] + j, center[2] + k};
        const std::size_t bucket = bucket_of(key);
        for (std::size_t e = begin_[bucket]; e < begin_[bucket + 1]; ++e) {
          if (entries_[e].key != key) continue;  // another cube in the same bucket
          const Point& y = points_[entries_[e].number];
          const Point d{y[0] - x[0], y[1] - x[1], y[2] - x[2]};
          if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] <= distance * distance)
            found.push_back(entries_[e].number);
        }
      }
  std::sort(found.begin(), found.end());
}

}  // namespace riven
