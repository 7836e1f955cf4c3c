#include "geometry/turned_shape.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace riven {
namespace {

/// Length, area or volume of the ball of radius 1 in 1, 2 and 3 dimensions.
constexpr std::array<double, 3> kUnitBall = {2, std::numbers::pi, 4 * std::numbers::pi / 3};

double measure_of(const Box& box, int dimension) {
  double product = 1;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) product *= 2 * box.half_size[k];
  return product;
}

double measure_of(const Ball& ball, int dimension) {
  return kUnitBall[static_cast<std::size_t>(dimension) - 1] * std::pow(ball.radius, dimension);
}

double measure_of(const Disc& disc, int dimension) {
  return dimension == 3 ? std::numeric_limits<double>::infinity()
                        : measure_of(Ball{disc.center, disc.radius}, dimension);
}

}  // namespace

Point center_of(const TurnedShape& turned) {
  return std::visit([](const auto& shape) { return shape.center; }, turned.shape);
}

double signed_distance(const TurnedShape& turned, const Point& p) {
  if (turned.angle == 0) return signed_distance(turned.shape, p);
  const Point center = center_of(turned);
  const double c = std::cos(turned.angle), s = std::sin(turned.angle);
  const double x = p[0] - center[0], y = p[1] - center[1];
  return signed_distance(turned.shape, {center[0] + c * x + s * y, center[1] - s * x + c * y, p[2]});
}

double measure(const TurnedShape& turned, int dimension) {
  return std::visit([&](const auto& shape) { return measure_of(shape, dimension); }, turned.shape);
}

}  // namespace riven
