#pragma once

#include "linalg/cholesky.hpp"
#include "solver/tangent_matrix.hpp"

namespace riven {

/// The tangent stiffness of a model under constraints, as a sparse linear system.
class TangentSystem {
 public:
  /// Finds the system's pattern and an ordering for it; see TangentMatrix. Throws FactorFailure.
  TangentSystem(const Model& model, const Constraints& constraints, std::span<const double> u,
                std::span<const double> mass = {});

  /// Sums the tangent of a state, that of the last force evaluation.
  void assemble(std::span<const double> u, const ExternalForces& external, double parameter) {
    tangent_.assemble(u, external, parameter);
  }
  /// Factors the tangent plus `shift` times `diagonal`, which has an entry per entry of the state (N/m).
  /// False unless the sum is positive definite.
  [[nodiscard]] bool factor(double shift, std::span<const double> diagonal);
  /// The displacements (m) that the forces (N) on a state's free entries call for; 0 elsewhere.
  void solve(std::span<const double> force, std::span<double> increment);

  [[nodiscard]] std::size_t unknowns() const { return tangent_.matrix().rows(); }
  /// Operations and memory (bytes) of a factorisation.
  [[nodiscard]] double flops() const { return cholesky_.flops(); }
  [[nodiscard]] double bytes() const;

 private:
  TangentMatrix tangent_;
  SparseCholesky cholesky_;
};

}  // namespace riven
