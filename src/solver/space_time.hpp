#pragma once

#include "solver/time_steps.hpp"

namespace riven {

enum class SlabKind {
  two_field,     // damps what steps do not resolve
  single_field,  // as published; has an energy law for nonlinear forces too
};

struct SpaceTimeSettings : TimeStepSettings {
  SlabKind scheme = SlabKind::two_field;
  std::size_t gauss_points = 3;  // of the single-field scheme, 2 to 6
};

/// Marches a model through time by slabs of time-discontinuous elements (space-time theory, sections 2 and
/// 3), of third order, stable for any step. A slab is solved by Newton's method with the operator of the
/// linear slab, one complex factorisation, which is kept while it does; where it converges too slowly it
/// preconditions GMRES on the exact tangents of all stages. Throws SolverFailure where slabs cannot be
/// solved.
State march_slabs(Model& model, Constraints& constraints, const SpaceTimeSettings& settings,
                  Observer& observer, const Snapshot* from = nullptr);

}  // namespace riven
