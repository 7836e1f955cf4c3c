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

/// Throws InputError for what would end a run late that can be told before it: a load whose table ends
/// before the run does, a time step above the stable one, an expectation of a metric, unit, state or file
/// that the run does not have.
void check_before_run(const Simulation& simulation, const Probes& probes);

/// What is allowed but rarely meant, for the user to read.
std::vector<std::string> warnings(const Simulation& simulation);

/// Bytes that a run of this case holds, known before anything is allocated.
double memory_estimate(const GeometryInput& geometry);
/// Throws InputError when that is more than this machine has.
void check_memory(const GeometryInput& geometry);

/// How long a run takes.
struct TimeEstimate {
  double evaluations = 0;   // of the force
  double evaluation_s = 0;  // one of them, measured
  [[nodiscard]] double total_s() const { return evaluations * evaluation_s; }
};
/// Measures the force for a moment. In statics the number of evaluations is a rule of thumb.
TimeEstimate time_estimate(const Simulation& simulation);

}  // namespace riven
