#include "solver/tangent_system.hpp"

#include <algorithm>

namespace riven {

TangentSystem::TangentSystem(const Model& model, const Constraints& constraints, std::span<const double> u,
                             std::span<const double> mass)
    : tangent_(model, constraints, u, mass) {
  cholesky_.analyse(tangent_.matrix());
}

bool TangentSystem::factor(double shift, std::span<const double> diagonal) {
  const std::span<const std::size_t> entries = tangent_.entries();
  std::vector<double> unshifted(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    unshifted[i] = tangent_.diagonal(i);
    tangent_.diagonal(i) += shift * diagonal[entries[i]];
  }
  const bool definite = cholesky_.factor(tangent_.matrix());
  for (std::size_t i = 0; i < entries.size(); ++i) tangent_.diagonal(i) = unshifted[i];
  return definite;
}

void TangentSystem::solve(std::span<const double> force, std::span<double> increment) {
  const std::span<const std::size_t> entries = tangent_.entries();
  std::vector<double> x(entries.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = force[entries[i]];
  cholesky_.solve(x);
  std::fill(increment.begin(), increment.end(), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) increment[entries[i]] = x[i];
}

double TangentSystem::bytes() const {
  return cholesky_.bytes() +
         static_cast<double>(tangent_.matrix().column.size()) * (2 * sizeof(double) + 3 * sizeof(int));
}

}  // namespace riven
