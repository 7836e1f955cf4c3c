#include "load/follower_pressure.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "geometry/side_rule.hpp"

namespace riven {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// [v] x w = v x w.
Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

FollowerPressure::FollowerPressure(LoadFunction pressure, std::vector<PressedSide> sides,
                                   std::vector<Point> place, int dimension, double thickness)
    : pressure_(std::move(pressure)),
      sides_(std::move(sides)),
      place_(std::move(place)),
      dimension_(dimension),
      thickness_(thickness) {}

std::vector<double> FollowerPressure::pressures(double parameter) const {
  std::vector<double> list;
  for (const PressedSide& side : sides_)
    for (const std::uint32_t node : side.node) list.push_back(pressure_(place_[node], parameter));
  return list;
}

template <class Visit>
void FollowerPressure::for_each_point(const PressedSide& side, std::span<const double> u,
                                      const std::vector<double>& pressure, const Visit& visit) const {
  for (const SidePoint& point : side_rule(dimension_, side.node.size())) {
    Vector3d r = Vector3d::Zero(), s = Vector3d::Zero();
    double p = 0;
    for (std::size_t a = 0; a < side.node.size(); ++a) {
      Vector3d x(place_[side.node[a]].data());
      for (int d = 0; d < dimension_; ++d)
        x(d) += u[static_cast<std::size_t>(d) * place_.size() + side.node[a]];
      r += point.slope[0][a] * x;
      s += point.slope[1][a] * x;
      p += point.value[a] * pressure[a];
    }
    if (dimension_ == 2) s = {0, 0, thickness_};
    visit(point, point.weight * p, r, s);
  }
}

template <class Visit>
void FollowerPressure::for_each_force(std::span<const double> u, const std::vector<double>& pressure,
                                      const Visit& visit) const {
  std::size_t first = 0;
  for (const PressedSide& side : sides_) {
    const std::vector<double> own(pressure.begin() + static_cast<std::ptrdiff_t>(first),
                                  pressure.begin() + static_cast<std::ptrdiff_t>(first + side.node.size()));
    first += side.node.size();
    for_each_point(side, u, own, [&](const SidePoint& point, double p, const Vector3d& r, const Vector3d& s) {
      const Vector3d normal = r.cross(s);
      for (std::size_t a = 0; a < side.node.size(); ++a)
        for (int d = 0; d < dimension_; ++d)
          visit(static_cast<std::size_t>(d) * place_.size() + side.node[a], -p * point.value[a] * normal(d));
    });
  }
}

void FollowerPressure::add(std::span<const double> u, std::span<const double> /*v*/, double parameter,
                           std::span<double> force) {
  for_each_force(u, pressures(parameter), [&](std::size_t entry, double value) { force[entry] += value; });
}

void FollowerPressure::tangent(std::span<const double> u, double parameter, TangentBlocks& to) const {
  const std::vector<double> pressure = pressures(parameter);
  std::size_t first = 0;
  for (const PressedSide& side : sides_) {
    const std::size_t nodes = side.node.size();
    const std::vector<double> own(pressure.begin() + static_cast<std::ptrdiff_t>(first),
                                  pressure.begin() + static_cast<std::ptrdiff_t>(first + nodes));
    first += nodes;
    const auto size = static_cast<Eigen::Index>(nodes) * dimension_;
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(size, size);
    // -df_a = p N_a (dr x s + r x ds), where dr and ds are slopes times the du of the nodes b.
    for_each_point(side, u, own, [&](const SidePoint& point, double p, const Vector3d& r, const Vector3d& s) {
      for (std::size_t b = 0; b < nodes; ++b) {
        Matrix3d change = -point.slope[0][b] * cross_matrix(s);
        if (dimension_ == 3) change += point.slope[1][b] * cross_matrix(r);
        for (std::size_t a = 0; a < nodes; ++a)
          k.block(static_cast<Eigen::Index>(a) * dimension_, static_cast<Eigen::Index>(b) * dimension_,
                  dimension_, dimension_) +=
              p * point.value[a] * change.topLeftCorner(dimension_, dimension_);
      }
    });
    const Eigen::MatrixXd symmetric = 0.5 * (k + k.transpose());
    for (const std::uint32_t node : side.node)
      for (int d = 0; d < dimension_; ++d)
        to.dofs.push_back(static_cast<std::size_t>(d) * place_.size() + node);
    to.begin.push_back(to.dofs.size());
    to.values.insert(to.values.end(), symmetric.data(), symmetric.data() + symmetric.size());
  }
}

double FollowerPressure::work(std::span<const double> u_before, double before, std::span<const double> u,
                              double parameter) const {
  const std::vector<double> start = pressures(before), end = pressures(parameter);
  std::vector<double> there(u.size()), pressure(start.size());
  double work = 0;
  // The forces are squares of the way, and cubes with the pressure: two points of Gauss's rule.
  for (const double part : {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)}) {
    for (std::size_t i = 0; i < u.size(); ++i) there[i] = u_before[i] + part * (u[i] - u_before[i]);
    for (std::size_t i = 0; i < start.size(); ++i) pressure[i] = start[i] + part * (end[i] - start[i]);
    for_each_force(there, pressure, [&](std::size_t entry, double value) {
      work += 0.5 * value * (u[entry] - u_before[entry]);
    });
  }
  return work;
}

Point FollowerPressure::total(std::span<const double> u, double parameter) const {
  Point sum{};
  for_each_force(u, pressures(parameter),
                 [&](std::size_t entry, double value) { sum[entry / place_.size()] += value; });
  return sum;
}

}  // namespace riven
