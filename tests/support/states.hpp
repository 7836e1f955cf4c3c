#pragma once

#include <Eigen/LU>
#include <array>
#include <vector>

#include "peridynamics/membrane.hpp"
#include "support/random.hpp"

namespace riven::testing {

using State2 = std::vector<double>;  // a membrane's displacements, in the layout of `Membrane`

inline Eigen::Vector2d plane(const Point& p) {
  return {p[0], p[1]};
}

/// Body points and ghosts: the lattice entries of a state that mean something.
inline std::vector<std::size_t> live_points(const Body& body) {
  std::vector<std::size_t> live = body.points;
  for (const GhostPoint& ghost : body.ghosts) live.push_back(ghost.point);
  return live;
}

/// Entries of a state that are a degree of freedom or a ghost's.
inline std::vector<std::size_t> live_entries(const Membrane& membrane) {
  const std::size_t n = membrane.body().size();
  std::vector<std::size_t> entries;
  for (const std::size_t i : live_points(membrane.body())) {
    entries.push_back(i);
    entries.push_back(n + i);
  }
  for (std::size_t d = 2 * n; d < membrane.dofs(); ++d) entries.push_back(d);
  return entries;
}

inline Eigen::Vector2d center_of(const Shape& inclusion) {
  if (const auto* box = std::get_if<Box>(&inclusion)) return plane(box->center);
  return plane(std::get<Disc>(inclusion).center);
}

/// Radius of gyration: the lever of an inclusion's third entry.
inline double gyration_of(const Shape& inclusion) {
  if (const auto* disc = std::get_if<Disc>(&inclusion)) return std::sqrt(0.5) * disc->radius;
  const Box& box = std::get<Box>(inclusion);
  return std::sqrt((box.half_size[0] * box.half_size[0] + box.half_size[1] * box.half_size[1]) / 3);
}

/// y = F X + shift of everything; inclusions turn by the rotation of F, which is exact only where F is a
/// rotation.
inline State2 affine_state(const PointModel& membrane, const Eigen::Matrix2d& f,
                           const Eigen::Vector2d& shift = Eigen::Vector2d::Zero()) {
  const Body& body = membrane.body();
  const std::size_t n = body.size();
  State2 u(membrane.dofs(), 0.0);
  for (const std::size_t i : live_points(body)) {
    const Eigen::Vector2d x = plane(body.position(i)), d = f * x + shift - x;
    u[i] = d.x();
    u[n + i] = d.y();
  }
  for (std::size_t c = 0; c < body.defects.inclusions.size(); ++c) {
    const Eigen::Vector2d x = center_of(body.defects.inclusions[c]), d = f * x + shift - x;
    const std::size_t dof = membrane.inclusion_dof(c);
    u[dof] = d.x();
    u[dof + 1] = d.y();
    u[dof + 2] = std::atan2(f(1, 0) - f(0, 1), f(0, 0) + f(1, 1)) * gyration_of(body.defects.inclusions[c]);
  }
  return u;
}

/// A large inhomogeneous deformation: stretch and rotation far from the inclusions, their rigid motion near
/// them, noise on every entry (ghosts too, independently of their masters). Softened until the sheet neither
/// collapses nor folds.
inline State2 random_state(Membrane& membrane, Random& random, double noise = 0.12) {
  const Body& body = membrane.body();
  const std::size_t n = body.size();
  const double d = body.spacing;
  const Eigen::Matrix2d rotation = random.rotation();
  const Eigen::Vector2d shift(random.between(-1, 1), random.between(-1, 1));
  const State2 rigid = affine_state(membrane, rotation, shift);
  const Eigen::Matrix2d stretch = random.gradient(0.9, 1.3);
  const Eigen::Matrix2d f = rotation * stretch.transpose() * stretch;
  const auto& inclusions = body.defects.inclusions;
  const Eigen::Vector2d center = inclusions.empty() ? Eigen::Vector2d(0, 0) : center_of(inclusions[0]);
  const State2 affine =
      affine_state(membrane, f, shift + (rotation - f) * center);  // both agree at the centre
  State2 change(membrane.dofs(), 0.0);
  for (const std::size_t i : live_points(body)) {
    double distance = 10 * d;
    for (const Shape& shape : inclusions)
      distance = std::min(distance, signed_distance(shape, body.position(i)));
    const double far = std::min(1.0, distance / (4 * d)), blend = far * far * (3 - 2 * far);
    for (const std::size_t e : {i, n + i})
      change[e] = blend * (affine[e] - rigid[e]) + noise * std::min(d, distance) * random.between(-1, 1);
  }
  for (std::size_t e = 2 * n; e < membrane.dofs(); ++e) change[e] = 0.02 * d * random.between(-1, 1);
  State2 force(membrane.dofs());
  for (double share = 1; share > 0.05; share *= 0.8) {
    State2 u = rigid;
    for (std::size_t e = 0; e < u.size(); ++e) u[e] += share * change[e];
    if (!membrane.internal_force(u, force) && !membrane.inspect(u)) return u;
  }
  throw std::logic_error("no random state of this body is admissible");
}

/// Force at every entry.
inline State2 force_of(Membrane& membrane, const State2& u) {
  State2 force(membrane.dofs());
  if (const auto breakdown = membrane.internal_force(u, force)) throw std::logic_error(breakdown->what);
  return force;
}

inline double norm(const State2& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

inline double largest(const State2& v) {
  double most = 0;
  for (const double x : v) most = std::max(most, std::abs(x));
  return most;
}

}  // namespace riven::testing
