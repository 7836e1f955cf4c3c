#include "peridynamics/weights.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace riven {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Below this ratio to the base weight a weight counts as bad: negative weights make a family unstable.
constexpr double kSmallestRatio = 0.05;
// Largest error of a moment with which the identities (7) are still taken as exact.
constexpr double kMomentTolerance = 1e-6;

double base_weight(const PlaneBond& bond) {
  return 1 / std::hypot(bond.x, bond.y);
}

/// Non-negative least squares min |A x - b|, x >= 0 by the active sets of Lawson and Hanson (1974), ch. 23.
VectorXd non_negative_least_squares(const MatrixXd& a, const VectorXd& b) {
  const Eigen::Index n = a.cols();
  VectorXd x = VectorXd::Zero(n);
  std::vector<Eigen::Index> passive;
  const double tolerance = 1e-12 * a.norm() * b.norm();
  for (Eigen::Index outer = 0; outer < 3 * n; ++outer) {
    const VectorXd gradient = a.transpose() * (b - a * x);
    Eigen::Index enter = -1;
    for (Eigen::Index j = 0; j < n; ++j) {
      const bool active = std::find(passive.begin(), passive.end(), j) == passive.end();
      if (active && gradient(j) > tolerance && (enter < 0 || gradient(j) > gradient(enter))) enter = j;
    }
    if (enter < 0) break;
    passive.push_back(enter);
    while (!passive.empty()) {
      const VectorXd z = a(Eigen::all, passive).colPivHouseholderQr().solve(b);
      double step = 1;
      for (std::size_t p = 0; p < passive.size(); ++p) {
        const auto zp = z(static_cast<Eigen::Index>(p));
        if (zp <= 0) step = std::min(step, x(passive[p]) / (x(passive[p]) - zp));
      }
      for (std::size_t p = 0; p < passive.size(); ++p)
        x(passive[p]) += step * (z(static_cast<Eigen::Index>(p)) - x(passive[p]));
      if (step == 1) break;
      std::erase_if(passive, [&](Eigen::Index j) {
        if (x(j) > 1e-14) return false;
        x(j) = 0;
        return true;
      });
    }
  }
  return x;
}

/// Weights at least kSmallestRatio w0 with the right moments, as close to w0 as they can be.
VectorXd bounded_weights(const MatrixXd& phi, const VectorXd& w0) {
  constexpr double kMomentPenalty = 1e5;  // moments count, closeness only chooses among equals
  const Eigen::Index n = w0.size();
  MatrixXd a(kMoments + n, n);
  VectorXd b(kMoments + n);
  a.topRows(kMoments) = kMomentPenalty * (phi * w0.asDiagonal());
  b.head(kMoments) = -kSmallestRatio * a.topRows(kMoments).rowwise().sum();
  b(0) += kMomentPenalty;
  a.bottomRows(n) = MatrixXd(w0.cwiseSqrt().asDiagonal());
  b.tail(n) = (1 - kSmallestRatio) * w0.cwiseSqrt();
  const VectorXd x = non_negative_least_squares(a, b);
  return w0.cwiseProduct(x + VectorXd::Constant(n, kSmallestRatio));
}

}  // namespace

Moments angular_functions(const PlaneBond& bond) {
  const double length2 = bond.x * bond.x + bond.y * bond.y;
  const double c2 = (bond.x * bond.x - bond.y * bond.y) / length2;
  const double s2 = 2 * bond.x * bond.y / length2;
  return {1, c2, s2, c2 * c2 - s2 * s2, 2 * c2 * s2};
}

double total_weight(std::span<const PlaneBond> bonds) {
  double sum = 0;
  for (const PlaneBond& bond : bonds) sum += base_weight(bond);
  return sum;
}

FamilyWeights base_weights(std::span<const PlaneBond> bonds) {
  FamilyWeights family;
  family.kind = FamilyWeights::Kind::gradient;
  const double scale = total_weight(bonds);
  for (const PlaneBond& bond : bonds) family.weight.push_back(base_weight(bond) / scale);
  return family;
}

FamilyWeights moment_corrected_weights(std::span<const PlaneBond> bonds) {
  if (bonds.empty()) return base_weights(bonds);
  FamilyWeights family;
  const auto n = static_cast<Eigen::Index>(bonds.size());
  MatrixXd phi(kMoments, n);
  VectorXd w0(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const PlaneBond& bond = bonds[static_cast<std::size_t>(j)];
    const Moments f = angular_functions(bond);
    for (std::size_t m = 0; m < kMoments; ++m) phi(static_cast<Eigen::Index>(m), j) = f[m];
    w0(j) = base_weight(bond);
  }
  const double scale = w0.sum();
  w0 /= scale;

  const VectorXd target = VectorXd::Unit(kMoments, 0);
  const MatrixXd gram = phi * w0.asDiagonal() * phi.transpose();
  const VectorXd c = gram.colPivHouseholderQr().solve(target);
  VectorXd weight = w0.cwiseProduct(phi.transpose() * c);
  const auto moment_error = [&] { return (phi * weight - target).cwiseAbs().maxCoeff(); };

  family.smallest_ratio = weight.cwiseQuotient(w0).minCoeff();
  if (moment_error() <= 1e-10 && family.smallest_ratio >= kSmallestRatio) {
    for (std::size_t m = 0; m < kMoments; ++m)
      family.coefficients[m] = c(static_cast<Eigen::Index>(m)) / scale;  // of 1/length itself
  } else {
    weight = bounded_weights(phi, w0);
    if (moment_error() <= kMomentTolerance) {
      family.kind = FamilyWeights::Kind::listed;
      // The penalty leaves 1e-10 in the moments, and a force at rest; what is free to move takes that away.
      const VectorXd free = weight - kSmallestRatio * w0;
      const MatrixXd system = phi * free.asDiagonal() * phi.transpose();
      const VectorXd missing = target - phi * weight;
      weight += free.cwiseProduct(phi.transpose() * system.completeOrthogonalDecomposition().solve(missing));
    } else {
      weight = w0;
      family.kind = FamilyWeights::Kind::gradient;
    }
  }
  family.weight.assign(weight.data(), weight.data() + n);
  return family;
}

}  // namespace riven
