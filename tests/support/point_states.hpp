#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "peridynamics/point_model.hpp"
#include "support/pmb_bodies.hpp"

namespace riven::testing {

inline double largest_of(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

inline std::vector<double> force_of(PointModel& model, const std::vector<double>& u) {
  std::vector<double> force(model.dofs(), 0.0);
  EXPECT_FALSE(model.internal_force(u, force));
  return force;
}

inline Eigen::Vector3d vector_of(const std::vector<double>& from, const Body& body, std::size_t i) {
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  for (int d = 0; d < body.dimension; ++d) v[d] = from[static_cast<std::size_t>(d) * body.size() + i];
  return v;
}

inline void set_vector(std::vector<double>& to, const Body& body, std::size_t i, const Eigen::Vector3d& v) {
  for (int d = 0; d < body.dimension; ++d) to[static_cast<std::size_t>(d) * body.size() + i] = v[d];
}

inline Eigen::Vector3d place(const Body& body, std::size_t i) {
  return Eigen::Vector3d(body.position(i).data());
}

inline Eigen::Matrix3d random_matrix(Random& random, int dimension) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  for (int a = 0; a < dimension; ++a)
    for (int b = 0; b < dimension; ++b) m(a, b) = random.between(-1, 1);
  return m;
}

/// u = G X of all bonded points.
inline std::vector<double> homogeneous(const PointModel& model, const Eigen::Matrix3d& gradient) {
  std::vector<double> u(model.dofs(), 0.0);
  for (const std::size_t i : bonded_points(model.body()))
    set_vector(u, model.body(), i, gradient * place(model.body(), i));
  return u;
}

/// Points that see no free surface: their families are complete, and those of their neighbours.
inline std::vector<std::size_t> inner_points(const Body& body) {
  std::vector<std::size_t> inner;
  for (const std::size_t i : body.points) {
    bool all = body.complete[i];
    body.for_each_neighbour(i, [&](std::size_t j) { all = all && body.complete[j]; });
    if (all) inner.push_back(i);
  }
  return inner;
}

inline Eigen::Matrix3d stress_at(PointModel& model, const std::vector<double>& u, std::size_t point) {
  const auto& points = model.body().points;
  const auto n = static_cast<std::size_t>(std::find(points.begin(), points.end(), point) - points.begin());
  const auto fields = model.fields(u);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(fields[2].values.data() + 9 * n);
}

inline std::size_t middle_point(const Body& body) {
  return *std::min_element(body.points.begin(), body.points.end(), [&](std::size_t a, std::size_t b) {
    return place(body, a).norm() < place(body, b).norm();
  });
}

}  // namespace riven::testing
