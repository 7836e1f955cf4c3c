#pragma once

#include <numbers>
#include <vector>

#include "peridynamics/bond_membrane.hpp"
#include "support/states.hpp"

namespace riven::testing {

inline constexpr double kC1 = 0.5;  // Pa

inline Material rubber() {
  return {"rubber", NeoHookean{kC1}, 1};
}

/// Forces by eq. (2) of the theory note and (41) to (43) of the source, bond by bond; no inclusions.
inline State2 plain_force(const BondMembrane& membrane, const State2& u) {
  const Body& body = membrane.body();
  const std::size_t n = body.size();
  std::vector<double> volume = body.volume;
  std::vector<std::size_t> master(n);
  for (const std::size_t i : body.points) master[i] = i;
  for (const GhostPoint& ghost : body.ghosts) {
    master[ghost.point] = ghost.master;
    volume[ghost.point] = body.volume[ghost.master];
  }
  const BondLaw& law = membrane.law();
  const double c0 = kC1 / (std::numbers::pi * body.thickness * body.horizon * body.horizon);
  State2 force(membrane.dofs(), 0.0);
  for (const std::size_t i : body.points)
    body.for_each_neighbour(i, [&](std::size_t j) {
      const Eigen::Vector2d xi = plane(body.position(j)) - plane(body.position(i));
      const Eigen::Vector2d y = xi + Eigen::Vector2d(u[j] - u[i], u[n + j] - u[n + i]);
      const double s = y.norm() / xi.norm(), cosine = xi.dot(y) / (xi.norm() * y.norm());
      const Eigen::Vector2d g = 0.5 * (membrane.correction(i) + membrane.correction(master[j])),
                            direction = xi.normalized();
      const double ellipse =
          1 / std::sqrt(std::pow(direction.x() / g.x(), 2) + std::pow(direction.y() / g.y(), 2));
      const double bracket = law.p2 * s + 2 * law.p4 * s * s * s - 0.5 * law.m1 * std::pow(s, -2) -
                             law.m2 * std::pow(s, -3) - 2 * law.m4 * std::pow(s, -5) -
                             3 * law.m6 * std::pow(s, -7);
      const Eigen::Vector2d f = ellipse * 4 * c0 * body.horizon * cosine * cosine / xi.squaredNorm() *
                                bracket * y.normalized() * volume[i] * volume[j];
      force[i] += f.x();
      force[n + i] += f.y();
      if (body.kind[j] == PointKind::ghost) {
        force[j] -= 0.5 * f.x();
        force[n + j] -= 0.5 * f.y();
      }
    });
  return force;
}

}  // namespace riven::testing
