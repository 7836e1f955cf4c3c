#pragma once

#include <memory>
#include <vector>

#include "load/external_force.hpp"
#include "solver/equilibrium.hpp"
#include "solver/work.hpp"

namespace riven {

struct LoadStepSettings {
  std::vector<double> targets;  // parameters of the output states, in the order they are reached
  double start = 1;             // parameter of the undeformed body
  double increment = 0.1;       // largest load step
  double tolerance = 1e-5;  // L2 norm of the free force over that of the reaction; a reaction below that of
                            // strains of about 1e-6 counts as that
  long max_iterations = 20000;  // of relaxation in a load step; then it is cut
  ExternalForces external;
};

/// Marches a model through states of equilibrium. A step starts from an affine predictor, later from the
/// extrapolated path, and is halved when it fails; where the first method fails at the smallest steps, the
/// next one takes that step.
///
/// Bonds that a state of equilibrium overloads break, all at once, and the body comes to rest without them
/// under the same loads, until none is overloaded. The step is halved to an eighth first. What the body loses
/// on the way to its rest counts as dissipated.
class LoadSteps {
 public:
  using Methods = std::vector<std::unique_ptr<Equilibrium>>;
  LoadSteps(Model& model, Constraints& constraints, const LoadStepSettings& settings, Methods methods,
            Observer& observer);

  /// Begins undeformed, or where a snapshot was taken. Throws SolverFailure when steps have become too small.
  State run(const Snapshot* from);

 private:
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    State::each_member(self.state_, "state", each);
    each("steps.start", self.start_);
    each("steps.before", self.before_);
    each("steps.offsets", self.offsets_);
    each("steps.last_change", self.last_change_);
    each("steps.target", self.target_);
    each("steps.stepping", self.stepping_);
    each("steps.next", self.next_);
    each("steps.step", self.step_);
    each("steps.iteration", self.iteration_);
    each("steps.increment", self.increment_);
    each("steps.cuts", self.cuts_);
    each("steps.good_steps", self.good_steps_);
    each("steps.method", self.method_);
    each("steps.broken", self.broken_);
    each("steps.overloaded", self.overloaded_);
  }
  [[nodiscard]] Snapshot save() const;
  void restore(const Snapshot& from);
  [[nodiscard]] Equilibrium& method() const { return *methods_[method_]; }

  void begin();
  void skip_reached_targets();
  void begin_step();
  void predict(double target);
  void iterate();
  void begin_iterations();
  void arrive();
  double break_overloaded();
  void accept();
  void keep_offsets();
  void cut();
  void retreat(const std::string& failure);
  [[noreturn]] void give_up(const std::string& failure) const;
  double balance();
  void tell_jump(double lost);
  void report() const;

  Model& model_;
  Constraints& constraints_;
  LoadStepSettings settings_;
  Methods methods_;
  Observer& observer_;
  State state_;
  WorkIntegral work_{WorkIntegral::Rule::parabolic};
  std::vector<double> start_, before_;         // states at the start of this load step, and of the last one
  std::vector<double> offsets_, last_change_;  // of the constraints (m): here, and in the last load step
  std::size_t target_ = 0;                     // number of the target that is aimed at
  bool stepping_ = false;                      // in the middle of a load step
  double next_ = 0, step_ = 0;                 // parameter at the end of this load step, and its length
  long iteration_ = 0;                         // of this load step
  double increment_ = 0;                       // largest load step, as it is cut now
  int cuts_ = 0;
  int good_steps_ = 0;              // since the last cut
  std::size_t method_ = 0;          // the one that works on this load step
  bool broken_ = false;             // bonds have broken in this load step
  std::vector<double> overloaded_;  // state of equilibrium in which they last did
};

}  // namespace riven
