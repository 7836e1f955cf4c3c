#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "output/parameter.hpp"

namespace riven {

/// A named result in SI; the unit is empty if dimensionless.
struct Metric {
  double value = 0;
  std::string unit;
};
using Metrics = std::map<std::string, Metric>;

enum class RunStatus { finished, failed, interrupted };

/// "finished", "failed" or "interrupted".
constexpr std::string_view name(RunStatus status) {
  switch (status) {
    case RunStatus::finished:
      return "finished";
    case RunStatus::failed:
      return "failed";
    case RunStatus::interrupted:
      return "interrupted";
  }
  return "";
}

/// Metrics at one output state.
struct SummaryState {
  double value = 0;  // stretch, time (s) or cycle
  Metrics metrics;
};

/// Energies at the end (J); NaN where the model has none, written as null.
struct EnergySummary {
  double kinetic = std::numeric_limits<double>::quiet_NaN();
  double strain = std::numeric_limits<double>::quiet_NaN();
  double dissipated = std::numeric_limits<double>::quiet_NaN();  // by damage
  double damped = std::numeric_limits<double>::quiet_NaN();      // by the solver's damping
  double held = std::numeric_limits<double>::quiet_NaN();        // by external forces, such as contacts
  double external_work = std::numeric_limits<double>::quiet_NaN();
  double balance_error = std::numeric_limits<double>::quiet_NaN();  // relative
};

struct TimingSummary {
  double wall_s = 0;
  std::int64_t steps = 0;                  // time steps or load steps
  std::optional<std::int64_t> iterations;  // of all load steps; left out by explicit solvers
  std::int64_t points = 0;
  std::int64_t bonds = 0;
  double bond_evaluations_per_second = 0;
};

/// What a run gives in `summary.json`.
struct Summary {
  RunStatus status = RunStatus::finished;
  std::string case_name;
  std::string version = RIVEN_VERSION;
  std::string instruction_set = {};          // of the kernels; empty in results of Riven before it was kept
  Parameter parameter = Parameter::stretch;  // of the states
  Metrics metrics;                           // at the final state
  std::vector<SummaryState> states;
  EnergySummary energy;
  TimingSummary timing;
  std::int64_t memory_peak_bytes = 0;
};

/// Writes `summary.json`; numbers that are not finite become null. The file appears only when complete.
/// Throws RunError when it cannot be written.
void write_summary(const std::filesystem::path& path, const Summary& summary);

/// Reads it back; null becomes NaN. Throws InputError when the file is missing or damaged, with what is
/// wrong.
Summary read_summary(const std::filesystem::path& path);

/// The largest memory this process has held so far, in bytes.
std::int64_t peak_memory_bytes();

}  // namespace riven
