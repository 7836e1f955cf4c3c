#pragma once

#include "solver/load_steps.hpp"

namespace riven {

/// Adaptive dynamic relaxation: fictitious masses from the tangent's row sums, damping from a Rayleigh
/// quotient of the velocity (peridynamics theory, eq. (11), after Underwood 1983).
class DynamicRelaxation final : public Equilibrium {
 public:
  DynamicRelaxation(Model& model, Constraints& constraints, const LoadStepSettings& settings);

  void begin(const State& state) override;
  Iteration iterate(State& state, long number) override;
  [[nodiscard]] const FreeForces& forces() const override { return forces_; }
  [[nodiscard]] int most_cuts() const override { return 8; }
  [[nodiscard]] std::string name() const override { return "dynamic relaxation"; }
  void save(Snapshot& to) const override { each_member(*this, to.saving()); }
  void restore(const Snapshot& from) override { each_member(*this, from.restoring()); }

 private:
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    FreeForces::each_member(self.forces_, each);
    StallWatch::each_member(self.stall_, each);
    each("relaxation.velocity", self.velocity_);
  }
  /// Sums for the damping, gathered in one sweep.
  struct Sums {
    double stiffness = 0;  // v.K v, with K v = -(change of F) since the last step moved u by v
    double inertia = 0;    // v.D v

    Sums& operator+=(const Sums& other) {
      stiffness += other.stiffness;
      inertia += other.inertia;
      return *this;
    }
  };
  [[nodiscard]] double mass(std::size_t entry) const { return 0.25 * forces_.row_bounds()[entry]; }
  [[nodiscard]] Sums sweep() const;
  static double damping(const Sums& sums);
  void advance(State& state, double damping, bool first);

  Constraints& constraints_;
  double tolerance_;
  long max_iterations_;
  FreeForces forces_;
  StallWatch stall_;
  std::vector<double> velocity_;  // per fictitious step 1 (m)
};

/// Marches a model through states of equilibrium by dynamic relaxation; see LoadSteps.
State relax(Model& model, Constraints& constraints, const LoadStepSettings& settings, Observer& observer,
            const Snapshot* from = nullptr);

}  // namespace riven
