#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "load/external_force.hpp"
#include "solver/solver.hpp"
#include "solver/time_schedule.hpp"
#include "solver/watchdog.hpp"

namespace riven {

/// Of implicit methods of motion.
struct TimeStepSettings {
  double until = 0;            // s
  double every = 0;            // time between output states (s)
  double history_every = 0;    // time between history rows (s)
  std::optional<double> step;  // s; default: as the method's error indicator says
  double tolerance = 1e-8;     // of residual and increment, each over its own scale
  // Largest energy that a method takes in a step, over that of the motion, where steps are chosen.
  double step_tolerance = 1e-4;
  bool inertia = true;  // without, the body is in equilibrium at any time
  // Of the equilibrium to start in under the loads of time 0, as LoadStepSettings::tolerance; nothing: the
  // initial state.
  std::optional<double> rest_tolerance;
  std::vector<double> initial_u, initial_v;  // m, m/s, of the free entries; empty: 0
  ExternalForces external;
};

/// An implicit step of time, and its solution between the ends.
class TimeStepMethod {
 public:
  virtual ~TimeStepMethod() = default;
  /// The motion starts, or goes on with fewer bonds. `internal`: the model's forces in that state (N);
  /// `force`: all forces on its free entries.
  virtual void restart(const State& state, std::span<const double> internal,
                       std::span<const double> force) = 0;
  /// Tries the step to the time `end` (s). The constraints are at the state's time, and afterwards at `end`.
  /// Returns why it failed, if it did.
  virtual std::optional<std::string> step(const State& from, double end) = 0;
  /// The last step has been taken; forces as for `restart`.
  virtual void accept(std::span<const double> internal, std::span<const double> force) = 0;

  /// Takes the model's memory to a part s of the last step, for the forces there. Returns how many forces
  /// that took.
  virtual long lead_model_to(double s) = 0;
  /// In the last step, at a part s of it in [0, 1].
  virtual void displacement(double s, std::span<double> u) const = 0;
  virtual void velocity(double s, std::span<double> v) const = 0;
  /// Of the loads up to there (J).
  [[nodiscard]] virtual double work(double s) const = 0;
  /// Energy that the method took in the last step, as far as it is known (J).
  [[nodiscard]] virtual double dissipated() const = 0;

  /// Force evaluations and iterations of the last step.
  [[nodiscard]] virtual long evaluations() const = 0;
  [[nodiscard]] virtual long iterations() const = 0;
  /// Whether it takes energy from any motion, and never adds some but for the error of its steps.
  [[nodiscard]] virtual bool never_adds_energy() const = 0;
  /// For messages.
  [[nodiscard]] virtual std::string name() const = 0;
  virtual void save(Snapshot& to) const = 0;
  virtual void restore(const Snapshot& from) = 0;
};

/// Marches a model through time by an implicit method. Steps that fail are halved, and those that take more
/// than the tolerance from the energy if no step is given. Output states and history rows lie inside steps.
/// What is irreversible happens once, at a step's end; the motion goes on from there with the new forces.
class TimeSteps {
 public:
  TimeSteps(Model& model, Constraints& constraints, const TimeStepSettings& settings,
            std::unique_ptr<TimeStepMethod> method, Observer& observer);

  /// Begins with the initial state, or where a snapshot was taken. Throws SolverFailure when steps have
  /// become too small.
  State run(const Snapshot* from);

 private:
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    State::each_member(self.state_, "state", each);
    each("time_steps.internal", self.internal_);
    each("time_steps.force", self.force_);
    each("time_steps.rest_energy", self.rest_energy_);
    each("time_steps.wanted", self.wanted_);
    each("time_steps.least", self.least_);
    each("time_steps.good", self.good_);
    Leg::each_member(self.leg_, "time_steps.leg", each);
    Schedule::each_member(self.outputs_, "time_steps.outputs", each);
    Schedule::each_member(self.history_, "time_steps.history", each);
  }
  [[nodiscard]] Snapshot save() const;
  void restore(const Snapshot& from);
  [[nodiscard]] bool unfinished() const { return state_.parameter < settings_.until * (1 - 1e-12); }

  void begin();
  void plan() { leg_ = Leg::between(state_.parameter, settings_.until, wanted_); }
  void take_step();
  [[nodiscard]] std::optional<std::string> attempt(State& end);
  [[nodiscard]] bool is_too_long(const State& end);
  void shorten(const std::string& failure);
  void lengthen();
  void accept(State end);
  void show(const State& from, const State& end, const Constraints::Prescribed& start);
  /// Returns whether some broke.
  bool break_bonds();
  std::optional<Breakdown> evaluate(State& state);
  void take_forces(const State& state);
  void balance(State& state);
  [[nodiscard]] double rounding_energy() const;
  void check_energy() const;
  void check_points(const State& state) const;
  void tell_progress() const;
  [[noreturn]] void fail(const State& state, const std::string& what) const;

  Model& model_;
  Constraints& constraints_;
  TimeStepSettings settings_;
  std::unique_ptr<TimeStepMethod> method_;
  Observer& observer_;
  Watchdog watchdog_;
  State state_;
  std::vector<double> mass_;
  std::vector<double> internal_, force_;  // in the state: of the model, and all on the free entries (N)
  double rest_energy_ = 0;                // that the model has without displacement (J)
  double wanted_ = 0, least_ = 0;         // step (s)
  double taken_ = 0;                      // by the method in the last step, over the energy of the motion
  long good_ = 0;                         // steps since the last one that was too long
  Leg leg_;
  Schedule outputs_, history_;
};

}  // namespace riven
