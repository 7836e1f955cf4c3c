#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/snapshot.hpp"
#include "load/constraints.hpp"
#include "model/model.hpp"

namespace riven {

/// Where the energy of a run is (J).
struct EnergyBalance {
  double kinetic = 0;
  double strain = 0;
  double dissipated = 0;
  double damped = 0;         // by the solver's damping
  double held = 0;           // by external forces, such as contacts
  double external_work = 0;  // of the loads, and what brought the body into the state it started from
  double largest = 0;        // largest of the above so far, the scale of the error

  [[nodiscard]] double total() const { return kinetic + strain + dissipated + damped + held; }
  [[nodiscard]] double error() const { return largest > 0 ? (total() - external_work) / largest : 0; }

  template <class Self, class Each>
  static void each_member(Self& self, const std::string& name, const Each& each) {
    each(name + ".kinetic", self.kinetic);
    each(name + ".strain", self.strain);
    each(name + ".dissipated", self.dissipated);
    each(name + ".damped", self.damped);
    each(name + ".held", self.held);
    each(name + ".external_work", self.external_work);
    each(name + ".largest", self.largest);
  }
};

/// What a solver has reached.
struct State {
  double parameter = 1;   // stretch in statics, time (s) in dynamics
  std::vector<double> u;  // displacements, the model's layout
  std::vector<double> v;  // velocities; empty in statics
  EnergyBalance energy;
  long steps = 0;        // load or time steps
  long iterations = 0;   // of statics, all steps together
  long evaluations = 0;  // of the force

  template <class Self, class Each>
  static void each_member(Self& self, const std::string& name, const Each& each) {
    each(name + ".parameter", self.parameter);
    each(name + ".u", self.u);
    each(name + ".v", self.v);
    EnergyBalance::each_member(self.energy, name + ".energy", each);
    each(name + ".steps", self.steps);
    each(name + ".iterations", self.iterations);
    each(name + ".evaluations", self.evaluations);
  }
};

/// What a solver is doing, for those who wait.
struct SolverProgress {
  double parameter = 0;       // aimed at (statics) or reached (dynamics)
  double reached = 0;         // by the last complete step
  double begin = 0, end = 0;  // of the whole run
  long step = 0;              // of `steps`, as far as one can tell (statics); taken (dynamics)
  long steps = 0;
  long iteration = 0;    // within the step
  long iterations = 0;   // so far (statics)
  long evaluations = 0;  // of the force, so far
  double residual = 0;   // free force / reaction; 0 in dynamics
  double tolerance = 0;
};

/// Watches a run.
class Observer {
 public:
  virtual ~Observer() = default;
  /// Called often; must be cheap.
  virtual void progressed(const SolverProgress&) {}
  /// A load step converged, or a history time was reached. `output`: this state is one the user asked for.
  virtual void reached(const State&, const Constraints&, bool /*output*/) {}
  /// Something the user should know while the run goes on.
  virtual void remarked(const std::string&) {}
  /// Called after every time step or iteration and all that follows from it; must be cheap. `take` makes the
  /// snapshot from which the run goes on bit for bit. What the observer throws here ends the run.
  virtual void safe_point(const std::function<Snapshot()>& /*take*/) {}
};

/// A solver could not go on: why, where it happened and what might help. The observers hold the last good
/// state.
class SolverFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace riven
