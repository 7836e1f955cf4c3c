#pragma once

#include "load/external_force.hpp"
#include "solver/solver.hpp"

namespace riven {

/// Brings a body into equilibrium under the loads of the constraints' parameter, by Newton's method from the
/// undeformed state, all at once or in as few parts of the loads as it takes. Tolerance as in
/// LoadStepSettings. Throws SolverFailure where a 256th part is still too much.
void bring_to_rest(Model& model, Constraints& constraints, const ExternalForces& external, double tolerance,
                   State& state);

}  // namespace riven
