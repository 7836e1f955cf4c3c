#pragma once

#include <optional>

#include "solver/corrections.hpp"
#include "solver/load_steps.hpp"
#include "solver/tangent_system.hpp"

namespace riven {

/// Newton's method on the model's tangent, as a search for a minimum of the energy: where the tangent is not
/// positive definite a multiple of its row bounds is added, and steps that overshoot are halved. A small
/// multiple always is, far below the softness that counts: it keeps still what nothing holds, such as a free
/// translation. Converged when the residual is within the tolerance and so is what the last step has left, as
/// a part of the displacements.
class Newton final : public Equilibrium {
 public:
  Newton(Model& model, Constraints& constraints, const LoadStepSettings& settings);

  void begin(const State& state) override;
  Iteration iterate(State& state, long number) override;
  [[nodiscard]] const FreeForces& forces() const override { return forces_; }
  [[nodiscard]] int most_cuts() const override { return 4; }
  [[nodiscard]] std::string name() const override { return "Newton's method"; }
  void save(Snapshot& to) const override { each_member(*this, to.saving()); }
  void restore(const Snapshot& from) override { each_member(*this, from.restoring()); }

 private:
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    FreeForces::each_member(self.forces_, each);
    Corrections::each_member(self.steps_, "newton.steps", each);
  }
  [[nodiscard]] bool factor(const State& state);
  /// Moves the state along the step, all of it or a part; false if no part will do.
  [[nodiscard]] bool move(State& state, std::span<const double> step);

  Model& model_;
  Constraints& constraints_;
  double tolerance_;
  ExternalForces external_;
  FreeForces forces_;
  std::optional<TangentSystem> system_;
  std::vector<double> diagonal_;  // of what is added to the tangent, times the shift (N/m)
  Corrections steps_;             // their norms over that of the displacements
  double broken_ = 0;             // energy of the bonds that had broken when the system was made (J)
};

/// Marches a model with a tangent through states of equilibrium by Newton's method, by dynamic relaxation
/// where that fails; see LoadSteps.
State newton(Model& model, Constraints& constraints, const LoadStepSettings& settings, Observer& observer,
             const Snapshot* from = nullptr);

}  // namespace riven
