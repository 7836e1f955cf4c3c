#include "geometry/defects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace riven {

bool Defects::cuts(const Point& a, const Point& b, double tolerance) const {
  // One order of the end points, so that rounding cannot make the answer depend on the order.
  if (b < a) return cuts(b, a, tolerance);
  const auto through = [&](const Shape& hole) {
    // Holes are convex: a part that starts at an end point inside is the only part.
    const std::optional<Interval> part = chord(hole, a, b, tolerance);
    return part && part->from > 0 && part->to < 1;
  };
  const auto across = [&](const Segment& crack) { return crosses(crack, a, b, tolerance); };
  return std::any_of(holes.begin(), holes.end(), through) ||
         std::any_of(cracks.begin(), cracks.end(), across) ||
         std::any_of(crack_surfaces.begin(), crack_surfaces.end(),
                     [&](const auto& crack) { return crack->crosses(a, b, tolerance); });
}

double Defects::distance_to_edge(const Point& p) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Shape& hole : holes) nearest = std::min(nearest, std::abs(signed_distance(hole, p)));
  for (const Segment& crack : cracks) nearest = std::min(nearest, distance(crack, p));
  for (const auto& crack : crack_surfaces) nearest = std::min(nearest, crack->distance(p));
  for (const Shape& body : inclusions) nearest = std::min(nearest, std::abs(signed_distance(body, p)));
  return nearest;
}

}  // namespace riven
