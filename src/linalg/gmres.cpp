#include "linalg/gmres.hpp"

#include <Eigen/QR>
#include <cmath>
#include <vector>

#include "base/parallel.hpp"

namespace riven {

namespace {

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return ordered_sum_of(a.size(), [&](std::size_t i) { return a[i] * b[i]; });
}

void add(double factor, const std::vector<double>& what, std::span<double> to) {
  parallel_pieces(to.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) to[i] += factor * what[i];
  });
}

/// Takes the earlier directions out of one, twice for rounding's sake, and scales it to length 1.
Eigen::VectorXd orthogonalise(const std::vector<std::vector<double>>& basis, std::vector<double>& direction) {
  Eigen::VectorXd column = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(basis.size()) + 1);
  for (int pass = 0; pass < 2; ++pass)
    for (std::size_t k = 0; k < basis.size(); ++k) {
      const double part = dot(direction, basis[k]);
      column(static_cast<Eigen::Index>(k)) += part;
      add(-part, basis[k], direction);
    }
  const double length = std::sqrt(dot(direction, direction));
  column(column.size() - 1) = length;
  if (length > 0)
    for (double& entry : direction) entry /= length;
  return column;
}

}  // namespace

std::size_t gmres(const VectorMap& product, const VectorMap& precondition, double tolerance, std::size_t most,
                  std::span<double> x) {
  std::vector<std::vector<double>> basis{{x.begin(), x.end()}}, steps;
  const double length = std::sqrt(dot(basis[0], basis[0]));
  std::fill(x.begin(), x.end(), 0.0);
  if (length == 0) return 0;
  for (double& entry : basis[0]) entry /= length;
  const auto size = static_cast<Eigen::Index>(most);
  Eigen::MatrixXd hessenberg = Eigen::MatrixXd::Zero(size + 1, size);
  Eigen::VectorXd best;
  std::size_t done = 0;
  while (done < most) {
    steps.push_back(basis.back());
    precondition(steps.back());
    std::vector<double> next = steps.back();
    product(next);
    const Eigen::VectorXd column = orthogonalise(basis, next);
    basis.push_back(std::move(next));
    hessenberg.col(static_cast<Eigen::Index>(done)).head(column.size()) = column;
    const auto n = static_cast<Eigen::Index>(++done);
    const Eigen::MatrixXd h = hessenberg.topLeftCorner(n + 1, n);
    const Eigen::VectorXd right = length * Eigen::VectorXd::Unit(n + 1, 0);
    best = h.householderQr().solve(right);
    if ((right - h * best).norm() <= tolerance * length || column(n) == 0) break;
  }
  for (std::size_t k = 0; k < done; ++k) add(best(static_cast<Eigen::Index>(k)), steps[k], x);
  return done;
}

}  // namespace riven
