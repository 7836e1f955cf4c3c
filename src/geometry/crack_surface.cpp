#include "geometry/crack_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "geometry/surface.hpp"

namespace riven {
namespace {

constexpr double kFlat = 1e-6;     // of a polygon's extent
constexpr double kNoArea = 1e-12;  // of its extent, squared

Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double length(const Point& a) {
  return std::hypot(a[0], a[1], a[2]);
}

Point unit(const Point& a) {
  const double size = length(a);
  return {a[0] / size, a[1] / size, a[2] / size};
}

/// Two directions across `normal` and each other: the first is across the axis that lies least along it.
std::array<Point, 2> axes_across(const Point& normal) {
  std::size_t least = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(normal[k]) < std::abs(normal[least])) least = k;
  Point axis{};
  axis[least] = 1;
  const Point first = unit(cross(normal, axis));
  return {first, cross(normal, first)};
}

/// Twice the area of a polygon as a vector along its normal (Newell), also where it isn't quite flat.
Point area_vector(const std::vector<Point>& corner) {
  Point sum{};
  for (std::size_t n = 0; n < corner.size(); ++n) {
    const Point part = cross(minus(corner[n], corner[0]), minus(corner[(n + 1) % corner.size()], corner[0]));
    for (std::size_t k = 0; k < 3; ++k) sum[k] += part[k];
  }
  return sum;
}

double extent(const std::vector<Point>& corner) {
  double most = 0;
  for (const Point& a : corner)
    for (const Point& b : corner) most = std::max(most, length(minus(a, b)));
  return most;
}

std::string text(const Point& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", p[0], p[1], p[2]);
}

/// A polygon that is not flat, or crosses itself, is a slip in one of its corners.
const std::vector<Point>& checked(const std::vector<Point>& corner) {
  if (corner.size() < 3)
    throw InputError(fmt::format("found {} corners; expected three or more", corner.size()));
  const double size = extent(corner);
  const Point twice_area = area_vector(corner);
  if (!(length(twice_area) > kNoArea * size * size))
    throw InputError("the corners enclose no area; expected corners that do not lie on one line");
  const Point normal = unit(twice_area);
  const auto height = [&](const Point& p) { return dot(minus(p, corner[0]), normal); };
  const auto [low, high] = std::minmax_element(
      corner.begin(), corner.end(), [&](const Point& a, const Point& b) { return height(a) < height(b); });
  if (height(*high) - height(*low) > kFlat * size)
    throw InputError(
        fmt::format("the corners do not lie in one plane: across the plane that fits them, {} is {:.3g} m "
                    "away from {}; expected less than {:.3g} m, a millionth of the polygon's extent",
                    text(*high), height(*high) - height(*low), text(*low), kFlat * size));
  const std::array<Point, 2> axis = axes_across(normal);
  const auto flat = [&](std::size_t n) {
    const Point from = minus(corner[n % corner.size()], corner[0]);
    return Point{dot(from, axis[0]), dot(from, axis[1]), 0};
  };
  for (std::size_t a = 0; a < corner.size(); ++a)
    for (std::size_t b = a + 2; b < corner.size() && b - a < corner.size() - 1; ++b)
      if (crosses(Segment{flat(a), flat(a + 1)}, flat(b), flat(b + 1), kFlat * size))
        throw InputError(fmt::format(
            "the edge from {} to {} crosses the one from {} to {}; expected corners "
            "in their order around the crack",
            text(corner[a]), text(corner[a + 1]), text(corner[b]), text(corner[(b + 1) % corner.size()])));
  return corner;
}

}  // namespace

double CrackSurface::Face::height(const Point& p) const {
  return dot(minus(p, origin), normal);
}

CrackSurface::InPlane CrackSurface::Face::in_plane(const Point& p) const {
  const Point from = minus(p, origin);
  return {dot(from, axis[0]), dot(from, axis[1])};
}

double CrackSurface::Face::beyond_outline(const InPlane& q) const {
  if (corner.empty()) return std::hypot(q[0], q[1]) - radius;
  bool inside = false;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < corner.size(); ++n) {
    const InPlane &a = corner[n], &b = corner[(n + 1) % corner.size()];
    nearest = std::min(nearest, riven::distance(Segment{{a[0], a[1], 0}, {b[0], b[1], 0}}, {q[0], q[1], 0}));
    // A line from q along the first axis passes the outline an odd number of times if q is inside.
    if ((a[1] > q[1]) != (b[1] > q[1]) && q[0] < a[0] + (q[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
      inside = !inside;
  }
  return inside ? -nearest : nearest;
}

bool CrackSurface::Face::crosses(const Point& a, const Point& b, double tolerance) const {
  const double above_a = height(a), above_b = height(b);
  if (std::min(above_a, above_b) >= -tolerance || std::max(above_a, above_b) <= tolerance) return false;
  const double t = above_a / (above_a - above_b);
  const Point meeting{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
  return beyond_outline(in_plane(meeting)) <= tolerance;
}

double CrackSurface::Face::distance(const Point& p) const {
  return std::hypot(height(p), std::max(0.0, beyond_outline(in_plane(p))));
}

double CrackSurface::Face::area() const {
  if (corner.empty()) return std::numbers::pi * radius * radius;
  double twice = 0;
  for (std::size_t n = 0; n < corner.size(); ++n) {
    const InPlane &a = corner[n], &b = corner[(n + 1) % corner.size()];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return 0.5 * std::abs(twice);
}

Bounds CrackSurface::Face::bounds() const {
  Bounds box{origin, origin};
  for (std::size_t k = 0; k < 3; ++k) {
    const double reach = radius * std::hypot(axis[0][k], axis[1][k]);
    box.low[k] -= reach;
    box.high[k] += reach;
    for (const InPlane& q : corner) {
      const double x = origin[k] + q[0] * axis[0][k] + q[1] * axis[1][k];
      box.low[k] = std::min(box.low[k], x);
      box.high[k] = std::max(box.high[k], x);
    }
  }
  return box;
}

CrackSurface::Face CrackSurface::flat(const std::vector<Point>& corner) {
  Face face;
  face.origin = corner[0];
  face.normal = unit(area_vector(corner));
  face.axis = axes_across(face.normal);
  for (const Point& p : corner) face.corner.push_back(face.in_plane(p));
  return face;
}

CrackSurface::Face CrackSurface::round(const PennyCrack& penny) {
  Face face;
  face.origin = penny.center;
  face.normal = unit(penny.normal);
  face.axis = axes_across(face.normal);
  face.radius = penny.radius;
  return face;
}

std::vector<CrackSurface::Face> CrackSurface::faces_of(const Triangles& triangles) {
  std::vector<Face> faces;
  for (const auto& [a, b, c] : triangles.triangle) {
    const std::vector<Point> corner{triangles.corner[a], triangles.corner[b], triangles.corner[c]};
    const double size = extent(corner);
    if (length(area_vector(corner)) > kNoArea * size * size) faces.push_back(flat(corner));
  }
  if (faces.empty()) throw InputError("there is no triangle with an area; expected a surface");
  return faces;
}

CrackSurface::CrackSurface(std::vector<Face> faces)
    : faces_(std::move(faces)), tree_([this] {
        std::vector<Bounds> boxes;
        for (const Face& face : faces_) boxes.push_back(face.bounds());
        return boxes;
      }()) {}

CrackSurface::CrackSurface(const PolygonCrack& polygon)
    : CrackSurface(std::vector<Face>{flat(checked(polygon.corner))}) {}

CrackSurface::CrackSurface(const PennyCrack& penny) : CrackSurface(std::vector<Face>{round(penny)}) {}

CrackSurface::CrackSurface(const Triangles& triangles) : CrackSurface(faces_of(triangles)) {}

bool CrackSurface::crosses(const Point& a, const Point& b, double tolerance) const {
  Bounds region{a, a};
  for (std::size_t k = 0; k < 3; ++k) {
    region.low[k] = std::min(a[k], b[k]) - tolerance;
    region.high[k] = std::max(a[k], b[k]) + tolerance;
  }
  return tree_.any_in(region, [&](std::uint32_t n) { return faces_[n].crosses(a, b, tolerance); });
}

double CrackSurface::distance(const Point& p) const {
  return tree_.nearest(p, [&](std::uint32_t n) { return faces_[n].distance(p); });
}

double CrackSurface::area() const {
  double sum = 0;
  for (const Face& face : faces_) sum += face.area();
  return sum;
}

}  // namespace riven
