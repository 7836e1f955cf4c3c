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
    energy.values[n] = 0.5 * (constants_.kappa * theta.values[n] * theta.values[n] +
                              constants_.beta * inverse_moment_[i] * extensions);
    if (body().dimension == 2 && settings_.plane == Plane::strain)
      p(2, 2) = settings_.poissons_ratio * (p(0, 0) + p(1, 1));
  });
  return {damage(), std::move(energy), std::move(stress), std::move(theta)};
}

/// The Hessian of W V of a family: kappa V g g^T with the gradient g of the dilatation, and for each bond
/// beta c omega along it and its force over its length across it.
void Lps::tangent(std::span<const double> u, std::size_t first, std::size_t last, TangentBlocks& to) const {
  const int dimension = body().dimension;
  for (std::size_t n = first; n < last; ++n) {
    const std::size_t i = body().points[n];
    std::vector<Pull> pulls;
    double theta = 0;
    const double c = inverse_moment_[i], volume = volume_[i];
    for_each_pull(i, u, [&](const Pull& pull) {
      pulls.push_back(pull);
      theta += c * pull.bond.weight * pull.bond.length * pull.extension;
    });
    const auto ends = static_cast<Eigen::Index>(pulls.size() + 1), size = dimension * ends;
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
    const std::size_t values = to.values.size();
    to.values.resize(values + static_cast<std::size_t>(size * size), 0.0);
    Eigen::Map<Eigen::MatrixXd> k(to.values.data() + values, size, size);
    // Entries of end e: [dimension e, dimension (e + 1)), the point itself first.
    for (Eigen::Index e = 1; e < ends; ++e) {
      const Pull& pull = pulls[static_cast<std::size_t>(e - 1)];
      const Eigen::VectorXd g = (c * pull.bond.weight * pull.bond.length * pull.direction).head(dimension);
      gradient.segment(dimension * e, dimension) = g;
      gradient.head(dimension) -= g;
    }
    k.noalias() = (constants_.kappa * volume) * gradient * gradient.transpose();
    for (Eigen::Index e = 1; e < ends; ++e) {
      const Pull& pull = pulls[static_cast<std::size_t>(e - 1)];
      const double across = tension(i, theta, pull) / pull.r;
      const Matrix3d own =
          volume * pull.bond.weight *
          (across * Matrix3d::Identity() + (constants_.beta * c - across) * along(pull.direction));
      const auto block = own.topLeftCorner(dimension, dimension);
      k.block(0, 0, dimension, dimension) += block;
      k.block(dimension * e, dimension * e, dimension, dimension) += block;
      k.block(0, dimension * e, dimension, dimension) -= block;
      k.block(dimension * e, 0, dimension, dimension) -= block;
    }
    const auto add_end = [&](std::size_t point) {
      for (int d = 0; d < dimension; ++d)
        to.dofs.push_back(static_cast<std::size_t>(d) * body().size() + point);
    };
    add_end(i);
    for (const Pull& pull : pulls) add_end(pull.bond.end);
    to.begin.push_back(to.dofs.size());
  }
}

}  // namespace riven
