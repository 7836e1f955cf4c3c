#pragma once

#include <optional>
#include <vector>

#include "load/external_force.hpp"
#include "solver/solver.hpp"

namespace riven {

struct VelocityVerletSettings {
  double until = 0;          // s
  double every = 0;          // time between output states (s)
  double history_every = 0;  // time between history rows (s)
  std::optional<double>
      step;  // s; default: safety times the stable step, estimated again as the body deforms
  double safety = 0.8;
  // Steps are halved, three times at the most, while the bonds that break in one hold more than this beyond
  // the energy at which they should.
  double excess = 0.1;
  std::vector<double> initial_u, initial_v;  // m, m/s, of the free entries; empty: 0
  ExternalForces external;
  double damping = 0;  // force per mass and velocity (1/s)
  // Brings the body to rest under the loads of time 0 first, to this residual (see LoadStepSettings).
  std::optional<double> rest_tolerance;
};

/// Largest stable step of Verlet's method (s) in a state, from the bound of the tangent's rows.
double stable_step(Model& model, const Constraints& constraints, std::span<const double> u,
                   const ExternalForces& external = {}, double time = 0);

/// Marches a model through time by velocity Verlet (peridynamics theory, section 8), from its initial state
/// or from where a snapshot was taken. Prescribed entries move as they are told; they carry no inertia of
/// their own in the energy balance. Throws InputError for a given step above the stable one, SolverFailure
/// when the run blows up.
State march(Model& model, Constraints& constraints, const VelocityVerletSettings& settings,
            Observer& observer, const Snapshot* from = nullptr);

}  // namespace riven
