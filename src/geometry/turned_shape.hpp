#pragma once

#include "geometry/shape.hpp"

namespace riven {

/// A shape turned about its centre in the x-y plane, counterclockwise.
struct TurnedShape {
  Shape shape;
  double angle = 0;  // rad
};

/// As of a shape.
double signed_distance(const TurnedShape& turned, const Point& p);

Point center_of(const TurnedShape& turned);

/// Length, area or volume in 1, 2 or 3 dimensions (m, m^2, m^3); infinite where a disc is an endless
/// cylinder.
double measure(const TurnedShape& turned, int dimension);

}  // namespace riven
