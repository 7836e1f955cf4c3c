#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "load/external_force.hpp"
#include "solver/solver.hpp"
#include "solver/watchdog.hpp"

namespace riven {

/// The forces on the free entries of a state, and how far they are from balance.
class FreeForces {
 public:
  FreeForces(Model& model, Constraints& constraints, const ExternalForces& external);

  /// Sets the scale of the residual anew where there is next to no reaction, from the tangent's row bounds.
  void rescale(const State& state);
  /// Bounds of the constrained tangent's rows (N/m), of the last `rescale`.
  [[nodiscard]] std::span<const double> row_bounds() const { return bound_; }

  /// Forces of a state; what is wrong with it if anything.
  std::optional<std::string> evaluate(State& state);
  [[nodiscard]] std::span<const double> values() const { return force_; }
  /// Those of the evaluation before.
  [[nodiscard]] std::span<const double> previous() const { return previous_; }
  /// L2 norm of the force over those of the constraint and the external forces, that of strains of about 1e-6
  /// at least.
  [[nodiscard]] double residual() const;
  /// What the residual is measured with (N).
  [[nodiscard]] double scale() const;
  /// What ends a run whatever the solver.
  [[nodiscard]] std::optional<std::string> alarm(const State& state) const;
  /// How far from equilibrium a state is, and where most.
  [[nodiscard]] std::string unrest(double tolerance) const;
  /// An energy below which everything is rounding (J).
  [[nodiscard]] double least_energy() const;

  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    each("forces.force", self.force_);
    each("forces.bound", self.bound_);
    each("forces.least_reaction", self.least_reaction_);
    each("forces.external_norm", self.external_norm_);
  }

 private:
  void add_external(const State& state);

  Model& model_;
  Constraints& constraints_;
  ExternalForces external_;
  Watchdog watchdog_;
  std::vector<double> force_, previous_, bound_, applied_;
  double external_norm_ = 0;   // N
  double least_reaction_ = 0;  // N
};

/// How an iteration ended.
struct Iteration {
  enum class Outcome { going_on, converged, failed };
  Outcome outcome = Outcome::going_on;
  std::string failure{};
  bool worth_telling = true;  // of a progress that is shown now and then
};

/// Brings a body to equilibrium under loads that stand still, iteration by iteration.
class Equilibrium {
 public:
  virtual ~Equilibrium() = default;
  /// Starts from a state that obeys its constraints.
  virtual void begin(const State& state) = 0;
  /// One iteration, the first of which is number 0.
  virtual Iteration iterate(State& state, long number) = 0;
  [[nodiscard]] virtual const FreeForces& forces() const = 0;
  /// How often a load step may be halved before the method is of no more use.
  [[nodiscard]] virtual int most_cuts() const = 0;
  /// For messages.
  [[nodiscard]] virtual std::string name() const = 0;
  virtual void save(Snapshot& to) const = 0;
  virtual void restore(const Snapshot& from) = 0;
};

}  // namespace riven
