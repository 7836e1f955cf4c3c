// What the linear peridynamic solid does seldom, family by family in plain loops: fields, tangent, bound.

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

/// The tangent is at most a block-diagonal matrix, whose blocks the rows bound. A bond's part
/// (x_i - x_j) k (x_i - x_j) is at most 2 x_i |k| x_i + 2 x_j |k| x_j. The dilatation's part kappa V (g x)^2
/// is, by Cauchy's inequality, at most kappa V sum|g| sum(|g| (n x)^2), with the directions n of the parts of
/// g; it lowers the tangent where kappa is negative.
void Lps::stiffness_bound(std::span<const double> u, std::span<double> bound) {
  struct Family {
    double dilatation = 0;
    double gradients = 0;             // kappa V sum|g| (N/m)
    Vector3d own = Vector3d::Zero();  // of the dilatation with the point itself (1/m)
  };
  std::vector<Family> families(body().size());
  const double kappa = std::max(constants_.kappa, 0.0);
  parallel_for(static_cast<std::ptrdiff_t>(body().points.size()), [&](std::ptrdiff_t number) {
    const std::size_t i = body().points[static_cast<std::size_t>(number)];
    Family& family = families[i];
    double lengths = 0;
    for_each_pull(i, u, [&](const Pull& pull) {
      const double part = inverse_moment_[i] * pull.bond.weight * pull.bond.length;
      family.dilatation += part * pull.extension;
      lengths += part;
      family.own -= part * pull.direction;
    });
    family.gradients = kappa * volume_[i] * (lengths + family.own.norm());
  });
  std::fill(bound.begin(), bound.end(), 0.0);
  const auto size = static_cast<std::ptrdiff_t>(body().size());
  parallel_for(size, [&](std::ptrdiff_t number) {
    const auto i = static_cast<std::size_t>(number);
    const Family& family = families[i];
    Matrix3d block = Matrix3d::Zero();
    if (family.own.norm() > 0) block += family.gradients / family.own.norm() * along(family.own);
    for_each_pull(i, u, [&](const Pull& pull) {
      const std::size_t j = pull.bond.end;
      const Matrix3d n = along(pull.direction);
      const double c = inverse_moment_[i] + inverse_moment_[j];
      const double across =
          std::abs(tension(i, family.dilatation, pull) + tension(j, families[j].dilatation, pull)) / pull.r;
      const double weight = volume_[i] * pull.bond.weight;
      block += 2 * weight * (constants_.beta * c * n + across * (Matrix3d::Identity() - n));
      // omega V of the other end, seen from there: of this point.
      block += families[j].gradients * inverse_moment_[j] * pull.bond.weight / volume_[j] * volume_[i] *
               pull.bond.length * n;
    });
    for (int d = 0; d < body().dimension; ++d)
      bound[static_cast<std::size_t>(d) * body().size() + i] =
          block.row(d).head(body().dimension).cwiseAbs().sum();
  });
}

}  // namespace riven
