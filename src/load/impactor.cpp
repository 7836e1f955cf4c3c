#include "load/impactor.hpp"

#include <cmath>
#include <limits>

#include "base/parallel.hpp"

namespace riven {

namespace {

struct Total {
  Point vector{};
  Total& operator+=(const Total& other) {
    for (std::size_t d = 0; d < 3; ++d) vector[d] += other.vector[d];
    return *this;
  }
};

double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Sum of term(i, depth) over the body's points that are deeper than `least` (m), in fixed order; each point
/// is looked at once.
template <class T, class Term>
T sum_of_depths(const Impactor& impactor, const Point& moved, const Body& body, std::span<const double> u,
                double least, const Term& term) {
  return ordered_sum<T>(body.points.size(), [&](std::size_t begin, std::size_t end) {
    T sum{};
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t i = body.points[n];
      Point at = body.position(i);
      for (std::size_t d = 0; d < static_cast<std::size_t>(body.dimension); ++d)
        at[d] += u[d * body.size() + i];
      const Depth depth = depth_of(impactor, moved, at, 0.5 * body.spacing);
      if (depth.value > least) sum += term(i, depth);
    }
    return sum;
  });
}

template <class Each>
Point total_force(const Impactor& impactor, const Point& moved, const Body& body, std::span<const double> u,
                  const Each& each) {
  const auto on_impactor = [&](std::size_t i, const Depth& depth) {
    const double size = impactor.stiffness * body.volume[i] * depth.value;
    each(i, size, depth.out);
    return Total{{-size * depth.out[0], -size * depth.out[1], -size * depth.out[2]}};
  };
  return sum_of_depths<Total>(impactor, moved, body, u, 0, on_impactor).vector;
}

}  // namespace

Point Impactor::start() const {
  if (const auto* sphere = std::get_if<RigidSphere>(&shape)) return sphere->center;
  return std::get<RigidPlane>(shape).point;
}

Depth depth_of(const Impactor& impactor, const Point& moved, const Point& place, double half_spacing) {
  const Point start = impactor.start();
  const Point from{place[0] - start[0] - moved[0], place[1] - start[1] - moved[1],
                   place[2] - start[2] - moved[2]};
  if (const auto* plane = std::get_if<RigidPlane>(&impactor.shape))
    return {half_spacing - dot(from, plane->normal), plane->normal};
  const double radius = std::get<RigidSphere>(impactor.shape).radius + half_spacing;
  const double far = radius + 2 * half_spacing, distance2 = dot(from, from);
  if (distance2 >= far * far) return {-std::numeric_limits<double>::infinity(), {}};  // spares a root
  const double distance = std::sqrt(distance2);
  if (distance == 0) return {radius, {}};  // no way out is nearer than another
  return {radius - distance, {from[0] / distance, from[1] / distance, from[2] / distance}};
}

Point push(const Impactor& impactor, const Point& moved, const Body& body, std::span<const double> u,
           std::span<double> force) {
  return total_force(impactor, moved, body, u, [&](std::size_t i, double size, const Point& out) {
    for (std::size_t d = 0; d < static_cast<std::size_t>(body.dimension); ++d)
      force[d * body.size() + i] += size * out[d];
  });
}

Point force_on(const Impactor& impactor, const Point& moved, const Body& body, std::span<const double> u) {
  return total_force(impactor, moved, body, u, [](std::size_t, double, const Point&) {});
}

double contact_energy(const Impactor& impactor, const Point& moved, const Body& body,
                      std::span<const double> u) {
  return sum_of_depths<double>(impactor, moved, body, u, 0, [&](std::size_t i, const Depth& depth) {
    return 0.5 * impactor.stiffness * body.volume[i] * depth.value * depth.value;
  });
}

/// As in SelfContact::add_bound: the energy of a point and the impactor is at most twice that of each with
/// the other one held.
double add_bound(const Impactor& impactor, const Point& moved, const Body& body, std::span<const double> u,
                 std::span<double> bound) {
  return sum_of_depths<double>(
      impactor, moved, body, u, -body.spacing, [&](std::size_t i, const Depth& depth) {
        const double row = 2 * impactor.stiffness * body.volume[i];
        const Point& e = depth.out;
        const double sum = std::abs(e[0]) + std::abs(e[1]) + std::abs(e[2]);
        for (std::size_t d = 0; d < static_cast<std::size_t>(body.dimension) && depth.value > 0; ++d)
          bound[d * body.size() + i] += row * std::abs(e[d]) * sum;
        return row;
      });
}

}  // namespace riven
