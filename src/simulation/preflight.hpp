#pragma once

#include <string>
#include <vector>

#include "simulation/probes.hpp"
#include "simulation/simulation.hpp"

namespace riven {

/// Whether two stretches or times mean the same output state.
bool same_state(double a, double b);

/// Whether a run of this case has an output state there: a stretch, or a time (s).
bool reaches(const Case& input, double state);

/// Takes out the expectations at states that a run with overrides no longer reaches. Returns how many.
std::size_t drop_unreached_expectations(Case& input);
/// A line for the user about them.
std::string left_out(std::size_t expectations);

/// An expectation of a metric with its values in the metric's unit: SI, but for angles, which are in degrees.
/// Throws InputError for values of another dimension.
ExpectInput in_unit_of_metric(ExpectInput expect, const std::string& metric_unit);

/// Throws InputError for what would end a run late that can be told before it: a load whose table ends
/// before the run does, a time step above the stable one, an expectation of a metric, unit, state or file
/// that the run does not have.
void check_before_run(const Simulation& simulation, const Probes& probes);

/// What is allowed but rarely meant, for the user to read.
std::vector<std::string> warnings(const Simulation& simulation);

}  // namespace riven
