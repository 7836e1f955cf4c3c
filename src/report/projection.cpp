#include "report/projection.hpp"

#include <algorithm>
#include <array>
#include <numbers>

namespace riven {

Projection::Projection(std::span<const Point> positions) {
  std::array<double, 3> extent{};
  for (std::size_t axis = 0; axis < 3 && !positions.empty(); ++axis) {
    const auto [low, high] =
        std::minmax_element(positions.begin(), positions.end(),
                            [&](const Point& a, const Point& b) { return a[axis] < b[axis]; });
    extent[axis] = (*high)[axis] - (*low)[axis];
  }
  constexpr double kFlat = 1e-9;  // of the longest side: rounding
  const double longest = *std::max_element(extent.begin(), extent.end());
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (extent[axis] > kFlat * longest) axes_.push_back(axis);
  if (axes_.empty()) axes_.push_back(0);
}

Point Projection::operator()(const Point& place) const {
  if (dimension() == 1) return {place[axes_[0]], 0, 0};
  if (dimension() == 2) return {place[axes_[0]], place[axes_[1]], 0};
  // The viewer stands at (1, -1, 1).
  constexpr double kTwo = 1 / std::numbers::sqrt2, kThree = std::numbers::inv_sqrt3, kSix = kTwo * kThree;
  const auto& [x, y, z] = place;
  return {kTwo * (x + y), kSix * (-x + y + 2 * z), kThree * (x - y + z)};
}

}  // namespace riven
