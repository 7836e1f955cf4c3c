#include "load/indenter.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace riven {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kMayTouch = 10;  // spacings
constexpr double kBound = 4;
constexpr double kTouch = 1e-9;  // spacings: an indenter that lies on a face at the start touches it

Vector3d vector(const Point& p) {
  return {p[0], p[1], p[2]};
}

/// A function of a place, with its first and second derivatives.
struct Local {
  double value = 0;
  Vector3d slope = Vector3d::Zero();
  Matrix3d bend = Matrix3d::Zero();
};

/// Depth of a place (m), and the part of the penalty that acts there.
struct Reach {
  Local depth;
  Local part{.value = 1};
};

Reach reach(const RigidPlane& plane, const Vector3d& at) {
  const Vector3d n = vector(plane.normal);
  return {.depth = {.value = n.dot(vector(plane.point) - at), .slope = -n}};
}

/// At the centre no way out is nearer than another.
Reach reach(const RigidSphere& sphere, const Vector3d& at) {
  const Vector3d from = at - vector(sphere.center);
  const double distance = from.norm();
  if (distance == 0) return {.depth = {.value = sphere.radius}};
  const Vector3d out = from / distance;
  return {.depth = {.value = sphere.radius - distance,
                    .slope = -out,
                    .bend = (out * out.transpose() - Matrix3d::Identity()) / distance}};
}

/// Beyond an end the part falls as 1 - 3 q^2 + 2 q^3 of the distance q over the length of fading: a node that
/// slides past it is let go without a jump of its energy.
Reach reach(const RigidFlat& flat, const Vector3d& at) {
  const Vector3d from = vector(flat.from), along = (vector(flat.to) - from).normalized();
  const double length = (vector(flat.to) - from).norm(), s = along.dot(at - from);
  const Vector3d out(along.y(), -along.x(), 0);
  Reach reach{.depth = {.value = out.dot(from - at), .slope = -out}};
  const double beyond = std::max(s - length, -s), q = beyond / flat.fade;
  if (beyond <= 0) return reach;
  if (q >= 1) {
    reach.part.value = 0;
    return reach;
  }
  const Vector3d away = (s > length ? 1 : -1) / flat.fade * along;
  reach.part = {.value = 1 + q * q * (2 * q - 3),
                .slope = 6 * q * (q - 1) * away,
                .bend = (12 * q - 6) * away * away.transpose()};
  return reach;
}

Reach reach_of(const IndenterSettings& of, const Vector3d& at) {
  return std::visit([&](const auto& shape) { return reach(shape, at); }, of.shape);
}

/// Of g^2 / 2, at a depth g of which slope and bend are given.
Local half_square(const Local& depth, double g) {
  return {.value = 0.5 * g * g,
          .slope = g * depth.slope,
          .bend = depth.slope * depth.slope.transpose() + g * depth.bend};
}

/// Projects onto the indenter's surface at a place.
Matrix3d along_surface(const IndenterSettings& of, const Vector3d& at) {
  const Vector3d normal = reach_of(of, at).depth.slope;
  return Matrix3d::Identity() - normal * normal.transpose();
}

}  // namespace

Point start_of(const IndenterShape& shape) {
  if (const auto* sphere = std::get_if<RigidSphere>(&shape)) return sphere->center;
  if (const auto* plane = std::get_if<RigidPlane>(&shape)) return plane->point;
  const auto& flat = std::get<RigidFlat>(shape);
  return {std::midpoint(flat.from[0], flat.to[0]), std::midpoint(flat.from[1], flat.to[1]), 0};
}

Indenter::Indenter(IndenterSettings settings, std::vector<LoadShare> surface, std::size_t points,
                   int dimension)
    : settings_(std::move(settings)),
      surface_(std::move(surface)),
      points_(points),
      dimension_(static_cast<std::size_t>(dimension)),
      sticks_(surface_.size(), 0),
      first_(3 * surface_.size(), 0.0),
      stored_(surface_.size(), 0.0) {}

/// Seen from the indenter as if it had not moved.
Vector3d Indenter::place(std::size_t share, std::span<const double> u, const Point& moved) const {
  Vector3d at = vector(surface_[share].position) - vector(moved);
  for (std::size_t d = 0; d < dimension_; ++d)
    at(static_cast<Eigen::Index>(d)) += u[d * points_ + surface_[share].point];
  return at;
}

Vector3d Indenter::first_place(std::size_t share) const {
  return {first_[3 * share], first_[3 * share + 1], first_[3 * share + 2]};
}

double Indenter::depth(std::size_t share, std::span<const double> u, double parameter) const {
  const auto [depth, part] = reach_of(settings_, place(share, u, settings_.way(parameter)));
  return part.value > 0 ? depth.value : -std::numeric_limits<double>::infinity();
}

Indenter::Push Indenter::push(std::size_t share, const Vector3d& at) const {
  const auto [depth, part] = reach_of(settings_, at);
  if (depth.value <= 0 || part.value == 0) return {};
  Local square = half_square(depth, depth.value),
        tame = half_square(depth, std::min(depth.value, settings_.deepest));
  if (sticks_[share] != 0) {
    const Vector3d first = first_place(share);
    const Matrix3d along = along_surface(settings_, first);
    const Vector3d slip = along * (at - first);
    for (Local* local : {&square, &tame}) {
      local->value += 0.5 * slip.squaredNorm();
      local->slope += slip;
      local->bend += along;
    }
  }
  const double size = settings_.stiffness * surface_[share].extent;
  const Matrix3d mixed = tame.slope * part.slope.transpose();
  return {.energy = size * part.value * square.value,
          .slope = size * (part.value * square.slope + square.value * part.slope),
          .stiffness = size * (part.value * tame.bend + mixed + mixed.transpose() + tame.value * part.bend)};
}

void Indenter::add(std::span<const double> u, std::span<const double> /*v*/, double parameter,
                   std::span<double> force) {
  const Point moved = settings_.way(parameter);
  for (std::size_t n = 0; n < surface_.size(); ++n) {
    const Vector3d slope = push(n, place(n, u, moved)).slope;
    for (std::size_t d = 0; d < dimension_; ++d)
      force[d * points_ + surface_[n].point] -= slope(static_cast<Eigen::Index>(d));
  }
}

void Indenter::tangent(std::span<const double> u, double parameter, TangentBlocks& to) const {
  const Point moved = settings_.way(parameter);
  for (std::size_t n = 0; n < surface_.size(); ++n) {
    const Matrix3d stiffness = push(n, place(n, u, moved)).stiffness;
    if (stiffness.isZero(0)) continue;
    for (std::size_t r = 0; r < dimension_; ++r) {
      to.dofs.push_back(r * points_ + surface_[n].point);
      for (std::size_t c = 0; c < dimension_; ++c)
        to.values.push_back(stiffness(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)));
    }
    to.begin.push_back(to.dofs.size());
  }
}

Point Indenter::force_on(std::span<const double> u, double parameter) const {
  const Point moved = settings_.way(parameter);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t n = 0; n < surface_.size(); ++n) sum += push(n, place(n, u, moved)).slope;
  return {sum.x(), sum.y(), sum.z()};
}

/// Nodes take energy from the indenter's motion and from its store: what comes from outside is what moves it
/// against the force on it. Where a node comes or goes, its depth taken as linear in between tells when.
double Indenter::work(std::span<const double> u_before, double before, std::span<const double> u,
                      double parameter) const {
  const Point from = settings_.way(before), to = settings_.way(parameter);
  Vector3d force = Vector3d::Zero();
  for (std::size_t n = 0; n < surface_.size(); ++n) {
    const Vector3d first = place(n, u_before, from), last = place(n, u, to);
    const double a = reach_of(settings_, first).depth.value, b = reach_of(settings_, last).depth.value;
    if (std::max(a, b) <= 0) continue;
    const double inside = std::min(a, b) >= 0 ? 1 : std::max(a, b) / std::abs(a - b);  // of the way
    force += 0.5 * inside * (push(n, first).slope + push(n, last).slope);
  }
  return -force.dot(vector(to) - vector(from));
}

double Indenter::held(std::span<const double> u, double parameter) const {
  const Point moved = settings_.way(parameter);
  double energy = lost_;
  for (std::size_t n = 0; n < surface_.size(); ++n) {
    const Vector3d at = place(n, u, moved);
    const bool off = sticks_[n] != 0 && reach_of(settings_, at).depth.value <= 0;
    energy += off ? stored_[n] : push(n, at).energy;
  }
  return energy;
}

/// Curvature and fading make the tangent softer, but for a part of the order of depth over spacing.
void Indenter::stiffness_bound(std::span<const double> u, double parameter, std::span<double> bound) const {
  const Point moved = settings_.way(parameter);
  for (std::size_t n = 0; n < surface_.size(); ++n) {
    const Local depth = reach_of(settings_, place(n, u, moved)).depth;
    if (depth.value < -kMayTouch * settings_.spacing) continue;
    Matrix3d tangent = depth.slope * depth.slope.transpose();
    if (settings_.sticking) tangent = Matrix3d::Identity();
    const double size = kBound * settings_.stiffness * surface_[n].extent;
    for (std::size_t d = 0; d < dimension_; ++d)
      bound[d * points_ + surface_[n].point] +=
          size * tangent.row(static_cast<Eigen::Index>(d)).cwiseAbs().sum();
  }
}

void Indenter::advance(std::span<const double> u, double parameter) {
  if (!settings_.sticking) return;
  const Point moved = settings_.way(parameter);
  for (std::size_t n = 0; n < surface_.size(); ++n) {
    const Vector3d at = place(n, u, moved);
    const auto [depth, part] = reach_of(settings_, at);
    if (sticks_[n] != 0 && (depth.value <= 0 || part.value == 0)) {
      if (depth.value <= 0) lost_ += stored_[n];
      sticks_[n] = 0;
    }
    if (sticks_[n] == 0 && depth.value >= -kTouch * settings_.spacing && part.value > 0) {
      sticks_[n] = 1;
      std::copy_n(at.data(), 3, first_.begin() + static_cast<std::ptrdiff_t>(3 * n));
    }
    stored_[n] = push(n, at).energy;
  }
}

}  // namespace riven
