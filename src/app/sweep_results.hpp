#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/sweep_plan.hpp"
#include "output/summary.hpp"

namespace riven::app {

/// What became of a variant.
struct SweepOutcome {
  std::string status = "not started";  // or that of the run
  std::optional<Summary> summary;
};

/// All of a sweep that tables and charts need; outcomes in the order of the variants.
struct SweepResults {
  const SweepPlan& plan;
  const std::filesystem::path& folder;
  std::vector<SweepOutcome> outcomes;
};

/// The first metrics of a state in one line: "force_x 220.9 N, hole_x 1.43".
std::string metrics_text(const Metrics& metrics, const SweepPlan& plan);

/// The table on the screen: keys, status, the first metrics, wall time.
std::string sweep_table(const SweepResults& results);

/// `sweep.csv`: a row per variant with the values as given and in SI, the status, all metrics at the final
/// state, the wall time and the folder.
void write_sweep_csv(const SweepResults& results);

/// `sweep.png`. One key of numbers: the metrics of the first probe at the final state against it. Otherwise:
/// the first column of the histories against time or stretch, a line per variant. Returns whether there was
/// something to draw.
bool draw_sweep(const SweepResults& results);

}  // namespace riven::app
