#include <algorithm>

#include "body/stencil.hpp"
#include "geometry/cubes.hpp"
#include "simulation/build_parts.hpp"

namespace riven {

namespace {

constexpr double kTouch = 1e-6;  // of the spacing

bool cuts(const CrackInput& crack, const Shape& body, double touch) {
  return std::any_of(crack.segments.begin(), crack.segments.end(),
                     [&](const Segment& piece) { return chord(body, piece.a, piece.b, touch).has_value(); });
}

/// Whether a crack is between two points of the body that would be neighbours without it.
bool separates(const CrackSurface& crack, const Body& body) {
  const double reach = horizon_limit(body.horizon);
  std::vector<Point> near;
  for (const std::size_t i : body.points)
    if (const Point x = body.position(i); crack.distance(x) <= reach) near.push_back(x);
  const Cubes cubes(near, body.dimension, reach);
  return std::any_of(near.begin(), near.end(), [&](const Point& x) {
    const std::vector<std::size_t> others = cubes.within(x, reach);
    return std::any_of(others.begin(), others.end(), [&](std::size_t other) {
      return crack.crosses(x, near[other], kTouch * body.spacing);
    });
  });
}

}  // namespace

void add_crack(const CrackInput& crack, Defects& to) {
  to.cracks.insert(to.cracks.end(), crack.segments.begin(), crack.segments.end());
  if (crack.surface) to.crack_surfaces.push_back(crack.surface);
}

void check_cracks(const Case& in, const Body& body) {
  for (const CrackInput& crack : in.cracks) {
    if (!crack.segments.empty() && !cuts(crack, in.geometry.shape, kTouch * in.geometry.spacing))
      throw InputError(crack.at, "crack: lies outside of the body; expected one that cuts it");
    if (crack.surface && !separates(*crack.surface, body))
      throw InputError(
          crack.at,
          "crack: cuts no bond: it lies outside of the body, or between its points; expected one "
          "that cuts it");
  }
}

}  // namespace riven
