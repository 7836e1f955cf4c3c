#pragma once

#include <vector>

#include "solver/solver.hpp"

namespace riven {

struct DynamicRelaxationSettings {
  std::vector<double> targets;  // parameters of the output states, in the order they are reached
  double start = 1;             // parameter of the undeformed body
  double increment = 0.1;       // largest load step
  double tolerance = 1e-5;  // L2 norm of the free force over that of the reaction; a reaction below that of
                            // strains of about 1e-6 counts as that
  long max_iterations = 20000;  // of a load step; then it is cut
};

/// Marches a model through states of equilibrium by adaptive dynamic relaxation: fictitious masses from the
/// tangent's row sums, damping from a Rayleigh quotient of the velocity (peridynamics theory, eq. (11), after
/// Underwood 1983). A step starts from an affine predictor, later from the extrapolated path, and is halved
/// when it fails. Begins undeformed, or where a snapshot was taken. Throws SolverFailure when steps have
/// become too small.
State relax(Model& model, Constraints& constraints, const DynamicRelaxationSettings& settings,
            Observer& observer, const Snapshot* from = nullptr);

}  // namespace riven
