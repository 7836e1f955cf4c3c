#pragma once

#include <string>
#include <vector>

#include "app/sweep_results.hpp"

namespace riven::app {

/// `sweep.png`, and `sweep-2.png`, ... if several charts are asked for. Unless one is: of one key of numbers
/// the metrics of the first probe at the final state over it, otherwise the first column of the histories
/// over time or stretch, a line per variant. Variants that differ in their seeds only share a colour.
/// Pictures of the runs before are removed; returns the names of those there are.
std::vector<std::string> draw_sweep(const SweepResults& results);

}  // namespace riven::app
