#include "geometry/shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace riven {
namespace {

Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double length(const Point& a) {
  return std::hypot(a[0], a[1], a[2]);
}

Point in_plane(const Point& a) {
  return {a[0], a[1], 0};
}

// Disc and ball alike: where `p` is, seen from the centre, in the directions in which the shape is round.
Point from_center(const Disc& disc, const Point& p) {
  return in_plane(minus(p, disc.center));
}
Point from_center(const Ball& ball, const Point& p) {
  return minus(p, ball.center);
}

double signed_distance_to(const Box& box, const Point& p) {
  Point outside{};
  double depth = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const double d = std::abs(p[k] - box.center[k]) - box.half_size[k];
    outside[k] = std::max(d, 0.0);
    depth = std::max(depth, d);
  }
  return length(outside) + std::min(depth, 0.0);
}

template <class Round>
double signed_distance_to(const Round& round, const Point& p) {
  return length(from_center(round, p)) - round.radius;
}

std::optional<Interval> chord_of(const Box& box, const Point& a, const Point& b, double tolerance) {
  Interval part{0, 1};
  for (std::size_t k = 0; k < 3; ++k) {
    const double half = box.half_size[k] - tolerance;
    const double start = a[k] - box.center[k];
    const double step = b[k] - a[k];
    if (half <= 0 || (step == 0 && std::abs(start) >= half)) return std::nullopt;
    if (step == 0) continue;
    const double enter = (std::copysign(half, -step) - start) / step;
    const double leave = (std::copysign(half, step) - start) / step;
    part = {std::max(part.from, enter), std::min(part.to, leave)};
  }
  if (part.from >= part.to) return std::nullopt;
  return part;
}

template <class Round>
std::optional<Interval> chord_of(const Round& round, const Point& a, const Point& b, double tolerance) {
  const double radius = round.radius - tolerance;
  const Point start = from_center(round, a);
  const Point step = minus(from_center(round, b), start);
  const double step2 = dot(step, step);
  const double nearest = step2 > 0 ? -dot(start, step) / step2 : 0;
  const double gap =
      std::hypot(start[0] + nearest * step[0], start[1] + nearest * step[1], start[2] + nearest * step[2]);
  if (gap >= radius) return std::nullopt;
  if (step2 == 0) return Interval{0, 1};
  const double half = std::sqrt((radius - gap) * (radius + gap) / step2);
  const Interval part{std::max(0.0, nearest - half), std::min(1.0, nearest + half)};
  if (part.from >= part.to) return std::nullopt;
  return part;
}

// Length that two intervals share, given their half lengths and the distance of their centres.
double common_length(double half_a, double half_b, double distance) {
  return std::clamp(half_a + half_b - distance, 0.0, 2 * std::min(half_a, half_b));
}

// Area between a circle's arc of less than half a turn and its chord.
double segment_area(double radius, double chord) {
  const double angle = 2 * std::asin(std::min(1.0, chord / (2 * radius)));
  return 0.5 * radius * radius * (angle - std::sin(angle));
}

// Area of the rectangle in the first quadrant that lies in the circle around the origin: below the arc the
// full height, then a trapezium and the segment over it. Free of cancellation for circles of any size.
double quadrant_area(double radius, Interval x, Interval y) {
  if (y.from >= radius || x.from >= radius) return 0;
  const auto arc = [radius](double s) { return s < radius ? std::sqrt((radius - s) * (radius + s)) : 0.0; };
  const double full = std::clamp(arc(y.to), x.from, x.to);
  const double end = std::clamp(arc(y.from), full, x.to);
  const double high = std::clamp(arc(full), y.from, y.to);
  const double low = std::clamp(arc(end), y.from, y.to);
  return (full - x.from) * (y.to - y.from) + (end - full) * (0.5 * (high + low) - y.from) +
         segment_area(radius, std::hypot(end - full, high - low));
}

// The interval center +- half folded at 0 onto the positive axis: one part, or two.
std::vector<Interval> folded(double center, double half) {
  const double near = std::abs(center) - half;
  const double far = std::abs(center) + half;
  if (near >= 0) return {{near, far}};
  return {{0, -near}, {0, far}};
}

// Fraction of the square of half edge `half` at `center` inside a circle around the origin.
double fraction_of_square(double radius, const Point& center, double half) {
  const double x = std::abs(center[0]);
  const double y = std::abs(center[1]);
  if (std::hypot(x + half, y + half) <= radius) return 1;
  if (std::hypot(std::max(x - half, 0.0), std::max(y - half, 0.0)) >= radius) return 0;
  double area = 0;
  for (const Interval& u : folded(x, half))
    for (const Interval& v : folded(y, half)) area += quadrant_area(radius, u, v);
  return area / (4 * half * half);
}

// Radius of the section of a circle or ball at `distance` from its centre.
double section(double radius, double distance) {
  return std::abs(distance) < radius ? std::sqrt((radius - distance) * (radius + distance)) : 0;
}

double fraction_of_line(double radius, double x, double half) {
  return common_length(radius, half, std::abs(x)) / (2 * half);
}

// Heights between `bottom` and `top` at which the section of a ball meets a corner or an edge of the square:
// in between, the section's area is a smooth function of the height.
std::vector<double> kinks(double radius, const Point& center, double half, double bottom, double top) {
  std::vector<double> heights{bottom, top};
  const auto add = [&](double distance) {
    const double z = section(radius, distance);
    for (const double height : {-z, z})
      if (height > bottom && height < top) heights.push_back(height);
  };
  for (const double x : {center[0] - half, center[0] + half}) {
    add(x);
    for (const double y : {center[1] - half, center[1] + half}) add(std::hypot(x, y));
  }
  for (const double y : {center[1] - half, center[1] + half}) add(y);
  std::sort(heights.begin(), heights.end());
  return heights;
}

double fraction_of_cube(double radius, const Point& center, double half) {
  // Gauss-Legendre, five points.
  constexpr std::array<double, 5> at{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                     0.9061798459386640};
  constexpr std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                         0.4786286704993665, 0.2369268850561891};
  const Point farthest{std::abs(center[0]) + half, std::abs(center[1]) + half, std::abs(center[2]) + half};
  if (length(farthest) <= radius) return 1;
  const double bottom = std::max(center[2] - half, -radius);
  const double top = std::min(center[2] + half, radius);
  if (bottom >= top) return 0;
  const std::vector<double> heights = kinks(radius, center, half, bottom, top);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
    const double middle = 0.5 * (heights[i] + heights[i + 1]);
    const double reach = 0.5 * (heights[i + 1] - heights[i]);
    for (std::size_t g = 0; g < at.size(); ++g) {
      // Near a kink the area goes like a power 3/2 of the height; this map, flat at both ends, smooths it.
      const double height = middle + 0.5 * reach * at[g] * (3 - at[g] * at[g]);
      const double slope = 1.5 * (1 - at[g] * at[g]);
      sum += reach * weight[g] * slope * fraction_of_square(section(radius, height), center, half);
    }
  }
  return sum / (2 * half);
}

double fraction(const Box& box, const Point& cell, double half, int dimension) {
  double product = 1;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k)
    product *= common_length(box.half_size[k], half, std::abs(cell[k] - box.center[k])) / (2 * half);
  return product;
}

double fraction(const Disc& disc, const Point& cell, double half, int dimension) {
  const Point center = from_center(disc, cell);
  if (dimension == 1) return fraction_of_line(section(disc.radius, center[1]), center[0], half);
  return fraction_of_square(disc.radius, center, half);
}

double fraction(const Ball& ball, const Point& cell, double half, int dimension) {
  const Point center = from_center(ball, cell);
  if (dimension == 3) return fraction_of_cube(ball.radius, center, half);
  return fraction(Disc{ball.center, section(ball.radius, center[2])}, cell, half, dimension);
}

bool shared(const Box& a, const Box& b, double tolerance) {
  for (std::size_t k = 0; k < 3; ++k)
    if (std::abs(a.center[k] - b.center[k]) >= a.half_size[k] + b.half_size[k] - tolerance) return false;
  return true;
}

bool shared(const Box& box, const Disc& disc, double tolerance) {
  const Point center{disc.center[0], disc.center[1], box.center[2]};
  return signed_distance_to(box, center) < disc.radius - tolerance;
}

bool shared(const Box& box, const Ball& ball, double tolerance) {
  return signed_distance_to(box, ball.center) < ball.radius - tolerance;
}

template <class Round>
bool shared(const Round& round, const Box& box, double tolerance) {
  return shared(box, round, tolerance);
}

template <class RoundA, class RoundB>
bool shared(const RoundA& a, const RoundB& b, double tolerance) {
  // A disc is endless along z, so that a ball and a disc are compared in the plane.
  const Point between = from_center(a, b.center);
  const Point backwards = from_center(b, a.center);
  return std::min(length(between), length(backwards)) < a.radius + b.radius - tolerance;
}

}  // namespace

double signed_distance(const Shape& shape, const Point& p) {
  return std::visit([&](const auto& s) { return signed_distance_to(s, p); }, shape);
}

std::optional<Interval> chord(const Shape& shape, const Point& a, const Point& b, double tolerance) {
  return std::visit([&](const auto& s) { return chord_of(s, a, b, tolerance); }, shape);
}

double covered_fraction(const Shape& shape, const Point& cell, double spacing, int dimension) {
  const double part =
      std::visit([&](const auto& s) { return fraction(s, cell, 0.5 * spacing, dimension); }, shape);
  // A cell that touches the surface from inside or outside counts as wholly in or out in spite of rounding.
  constexpr double rounding = 1e-12;
  if (part < rounding) return 0;
  return part > 1 - rounding ? 1 : part;
}

bool overlap(const Shape& a, const Shape& b, double tolerance) {
  return std::visit([&](const auto& s, const auto& t) { return shared(s, t, tolerance); }, a, b);
}

double distance(const Segment& segment, const Point& p) {
  const Point along = minus(segment.b, segment.a);
  const Point to_p = minus(p, segment.a);
  const double along2 = dot(along, along);
  const double t = along2 > 0 ? std::clamp(dot(to_p, along) / along2, 0.0, 1.0) : 0;
  return std::hypot(to_p[0] - t * along[0], to_p[1] - t * along[1], to_p[2] - t * along[2]);
}

bool crosses(const Segment& crack, const Point& a, const Point& b, double tolerance) {
  const Point along = in_plane(minus(crack.b, crack.a));
  const double size = length(along);
  if (size <= tolerance) return false;
  const auto height = [&](const Point& p) {
    return (along[0] * (p[1] - crack.a[1]) - along[1] * (p[0] - crack.a[0])) / size;
  };
  const double above_a = height(a);
  const double above_b = height(b);
  if (std::min(above_a, above_b) >= -tolerance || std::max(above_a, above_b) <= tolerance) return false;
  const double t = above_a / (above_a - above_b);
  const Point meeting{a[0] + t * (b[0] - a[0]) - crack.a[0], a[1] + t * (b[1] - a[1]) - crack.a[1], 0};
  const double place = dot(meeting, along) / size;
  return place >= -tolerance && place <= size + tolerance;
}

}  // namespace riven
