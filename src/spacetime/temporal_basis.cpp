#include "spacetime/temporal_basis.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace riven {

QuadraticLagrange::Others QuadraticLagrange::others(std::size_t function) const {
  const double x = nodes_[function], p = nodes_[(function + 1) % 3], q = nodes_[(function + 2) % 3];
  return {p, q, (x - p) * (x - q)};
}

double QuadraticLagrange::value(std::size_t function, double s) const {
  const Others o = others(function);
  return (s - o.p) * (s - o.q) / o.scale;
}

double QuadraticLagrange::first(std::size_t function, double s) const {
  const Others o = others(function);
  return (2 * s - o.p - o.q) / o.scale;
}

double QuadraticLagrange::second(std::size_t function, double /*s*/) const {
  return 2 / others(function).scale;
}

/// Golub and Welsch (1969): points are the eigenvalues of the recurrence of Legendre's polynomials, weights
/// the squares of the eigenvectors' first entries.
TemporalRule gauss_rule(std::size_t points) {
  const auto n = static_cast<Eigen::Index>(points);
  Eigen::VectorXd off(n - 1);
  for (Eigen::Index k = 1; k < n; ++k) {
    const auto number = static_cast<double>(k);
    off(k - 1) = number / std::sqrt(4 * number * number - 1);
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::VectorXd::Zero(n), off);
  TemporalRule rule;
  for (Eigen::Index k = 0; k < n; ++k) {
    // The mean with the mirror image takes the rounding out of the symmetry.
    const Eigen::Index mirror = n - 1 - k;
    const double x = 0.5 * (solver.eigenvalues()(k) - solver.eigenvalues()(mirror));
    const double first = solver.eigenvectors()(0, k), last = solver.eigenvectors()(0, mirror);
    rule.point.push_back(0.5 + 0.5 * x);
    rule.weight.push_back(0.5 * (first * first + last * last));
  }
  return rule;
}

TemporalMatrices temporal_matrices(const TemporalBasis& basis, const TemporalRule& rule) {
  const auto n = static_cast<Eigen::Index>(basis.size());
  TemporalMatrices matrices{Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, n)};
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b < n; ++b) {
      const auto test = static_cast<std::size_t>(a), trial = static_cast<std::size_t>(b);
      double inertia = basis.first(test, 0) * basis.first(trial, 0);
      double stiffness = basis.value(test, 0) * basis.value(trial, 0);
      for (std::size_t q = 0; q < rule.point.size(); ++q) {
        const double s = rule.point[q], weighted = rule.weight[q] * basis.first(test, s);
        inertia += weighted * basis.second(trial, s);
        stiffness += weighted * basis.value(trial, s);
      }
      matrices.inertia(a, b) = inertia;
      matrices.stiffness(a, b) = stiffness;
    }
  return matrices;
}

}  // namespace riven
