#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "linalg/symmetric_factors.hpp"
#include "solver/equilibrium.hpp"
#include "solver/tangent_matrix.hpp"

namespace riven {

/// The tangent stiffness of a body under loads that a parameter scales, whether it is definite or not, and
/// what the parameter does to the body's forces.
class PathTangent {
 public:
  /// `difference`: of the parameter, small against what changes the body by much, for derivatives.
  PathTangent(Model& model, Constraints& constraints, const ExternalForces& external, double difference);

  /// Factors the tangent of a state, that of the last force evaluation at the constraints' parameter. False
  /// if it is singular. If the first one is, or nearly, as nothing holds the body in some direction, this and
  /// all later ones have a small multiple of their row bounds added. Throws FactorFailure.
  [[nodiscard]] bool factor(std::span<const double> u, std::span<const double> row_bounds);
  /// Of the tangent last factored: how many directions it gives way in.
  [[nodiscard]] int negative() const { return factors_.negative(); }
  /// The displacements (m) that forces (N) on the free entries call for, by the tangent last factored.
  void solve(std::span<const double> force, std::span<double> increment);

  /// Displacements per unit of the parameter (m) that keep the forces on free entries as they are, by the
  /// tangent last factored; what is wrong if a state beside cannot be evaluated. Forces must be evaluated
  /// anew afterwards.
  [[nodiscard]] std::optional<std::string> follow(State& state, FreeForces& forces,
                                                  std::span<double> displacement);

  /// An eigenvalue of the tangent last factored, the one next to zero, and its vector.
  struct Mode {
    double stiffness = 0;       // N/m
    std::vector<double> shape;  // of norm 1, 0 at entries that are not free
  };
  [[nodiscard]] Mode softest();

  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    each("tangent.shift", self.shift_);
  }

 private:
  [[nodiscard]] bool factor_shifted(std::span<const double> row_bounds);
  std::optional<std::string> forces_at(double parameter, State& state, FreeForces& forces,
                                       std::vector<double>& values);

  Model& model_;
  Constraints& constraints_;
  ExternalForces external_;
  double difference_;
  double shift_ = -1;  // of the diagonal, in row bounds; below 0: not decided yet
  std::optional<TangentMatrix> matrix_;
  SymmetricFactors factors_;
};

}  // namespace riven
