#pragma once

#include <filesystem>
#include <string>

#include "simulation/simulation.hpp"

namespace riven {

/// What a run takes, told before it starts.

/// Bytes of memory at the peak of a run, known before anything is allocated.
double memory_estimate(const Case& input);
/// Throws InputError, with a spacing that would fit, when that is more than `available` bytes.
void check_memory(const Case& input, double available);

/// Bytes that the fields and the history take at most: their numbers do not always compress.
double output_estimate(const Simulation& simulation);
/// Throws InputError when that is more than `available` bytes.
void check_disk(const Simulation& simulation, double available);

/// How long a run takes.
struct TimeEstimate {
  const char* unit = "force evaluations";  // or "iterations", of Newton's method
  double evaluations = 0;
  double evaluation_s = 0;  // one of them with what a step does besides
  [[nodiscard]] double total_s() const { return evaluations * evaluation_s; }
};
/// Measures the force for a fifth of a second at most. In statics the number of evaluations is a rule of
/// thumb, and so is the time of an iteration of Newton's method.
TimeEstimate time_estimate(const Simulation& simulation);

}  // namespace riven
