// What the linear peridynamic solid does seldom, family by family in plain loops: fields and tangent.

#include <Eigen/Dense>
#include <algorithm>

#include "base/parallel.hpp"
#include "peridynamics/lps.hpp"

namespace riven {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d along(const Vector3d& direction) {
  return direction * direction.transpose();
}

}  // namespace

double Lps::dilatation(std::size_t point, std::span<const double> u) const {
  double sum = 0;
  for_each_pull(point, u,
                [&](const Pull& pull) { sum += pull.bond.weight * pull.bond.length * pull.extension; });
  return inverse_moment_[point] * sum;
}

double Lps::family_energy(std::size_t point, std::span<const double> u) const {
  double extensions = 0;
  for_each_pull(point, u,
                [&](const Pull& pull) { extensions += pull.bond.weight * pull.extension * pull.extension; });
  const double theta = dilatation(point, u);
  return 0.5 * volume_[point] * (kappa_[point] * theta * theta + straight_[point] * extensions);
}

std::vector<ModelField> Lps::fields(std::span<const double> u) {
  const std::vector<std::size_t>& points = body().points;
  ModelField theta{"dilatation", 1, std::vector<double>(points.size()), {}};
  ModelField energy{"strain_energy_density", 1, std::vector<double>(points.size()), "J/m^3"};
  ModelField stress{"nominal_stress", 9, std::vector<double>(9 * points.size()), "Pa"};
  parallel_for(static_cast<std::ptrdiff_t>(points.size()), [&](std::ptrdiff_t number) {
    const auto n = static_cast<std::size_t>(number);
    const std::size_t i = points[n];
    theta.values[n] = dilatation(i, u);
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> p(stress.values.data() + 9 * n);
    p.setZero();
    double extensions = 0;
    for_each_pull(i, u, [&](const Pull& pull) {
      extensions += pull.bond.weight * pull.extension * pull.extension;
      p += pull.bond.weight * tension(i, theta.values[n], pull) * pull.direction * pull.bond.xi.transpose();
    });
    energy.values[n] = 0.5 * (kappa_[i] * theta.values[n] * theta.values[n] + straight_[i] * extensions);
    const LpsSettings& material = settings_[body().material_of(i)];
    if (body().dimension == 2 && material.plane == Plane::strain)
      p(2, 2) = material.poissons_ratio * (p(0, 0) + p(1, 1));
  });
  return {damage(), std::move(energy), std::move(stress), std::move(theta)};
}

/// The Hessian of W V of a family: kappa V g g^T with the gradient g of the dilatation, and for each bond
/// beta c omega along it and its force over its length across it.
void Lps::tangent(std::span<const double> u, std::size_t first, std::size_t last, TangentBlocks& to) const {
  const int dimension = body().dimension;
  for (std::size_t n = first; n < last; ++n) {
    const std::size_t i = body().points[n];
    const double c = inverse_moment_[i], volume = volume_[i], theta = dilatation(i, u);
    const auto size = static_cast<Eigen::Index>(body().family_size(i)) * dimension;
    Eigen::VectorXd gradient(size);  // of the dilatation
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
    std::vector<End> ends;
    Eigen::Index at = 0;
    for_each_pull(i, u, [&](const Pull& pull) {
      const double across = tension(i, theta, pull) / pull.r;
      const Matrix3d own = volume * pull.bond.weight *
                           (across * Matrix3d::Identity() + (straight_[i] - across) * along(pull.direction));
      hessian.block(at, at, dimension, dimension) = own.topLeftCorner(dimension, dimension);
      gradient.segment(at, dimension) =
          (c * pull.bond.weight * pull.bond.length * pull.direction).head(dimension);
      ends.push_back(static_cast<End>(pull.bond.end));
      at += dimension;
    });
    hessian.noalias() += (kappa_[i] * volume) * gradient * gradient.transpose();
    add_family_block(i, ends, {}, hessian, to);
  }
}

}  // namespace riven
