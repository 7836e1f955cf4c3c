#pragma once

#include "solver/time_steps.hpp"

namespace riven {

struct GeneralisedAlphaSettings : TimeStepSettings {
  double spectral_radius = 0.8;  // of infinitely fast motions, 0 to 1
};

/// Marches a model through time by the generalised-alpha method (Chung and Hulbert 1993), of second order,
/// with forces weighted between the ends of a step; spectral radius 1 is Newmark's method of average
/// acceleration. Newton's method solves its steps. Throws InputError without a step: it has no error
/// indicator.
State generalised_alpha(Model& model, Constraints& constraints, const GeneralisedAlphaSettings& settings,
                        Observer& observer, const Snapshot* from = nullptr);

}  // namespace riven
