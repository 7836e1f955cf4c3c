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

/// The table on the screen: keys, status, the first metrics, wall time; below it the means over seeds.
std::string sweep_table(const SweepResults& results);

/// `sweep.csv`: a row per variant with the values as given and in SI, the status, all metrics at the final
/// state, the wall time and the folder. Where seeds are swept besides other keys, `sweep-means.csv`: the
/// means over the seeds and the standard deviations. Returns the names of the files.
std::vector<std::string> write_sweep_tables(const SweepResults& results);

/// A metric at the end; nan if there is none.
double metric_of(const SweepOutcome& outcome, const std::string& name);
/// The SI values of a key, if it is a number in all variants.
std::optional<std::vector<SiValue>> si_values(const SweepPlan& plan, std::size_t key);
/// What belongs to keys that are no seeds, of a list that has an entry per key.
std::vector<std::string> without_seeds(const SweepPlan& plan, const std::vector<std::string>& of_keys);

}  // namespace riven::app
