#pragma once

#include <optional>

#include "output/collection.hpp"
#include "output/log.hpp"
#include "output/progress.hpp"
#include "output/result_folder.hpp"
#include "simulation/probes.hpp"

namespace riven {

/// The user stopped the run.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Writes what a run reaches to its result folder as it comes, and shows how far it is.
class Recorder final : public Observer {
 public:
  Recorder(const Simulation& simulation, const Probes& probes, const ResultFolder& folder, Progress& screen,
           Log& log);

  /// Throws Interrupted when SIGINT or SIGTERM has come.
  void progressed(const SolverProgress& progress) override;
  void reached(const State& state, const Constraints& constraints, bool output) override;
  void remarked(const std::string& message) override;

  /// Writes the last state that was reached, if it is not written yet: what a failed run leaves.
  void keep_last();
  /// What has been reached, for summary.json; `status` and timing are the caller's.
  [[nodiscard]] Summary summary() const;
  [[nodiscard]] const State& last() const { return last_; }
  /// Force evaluations so far, those of an unfinished step included.
  [[nodiscard]] long evaluations() const { return evaluations_; }

 private:
  void write_fields();

  const Simulation& simulation_;
  const Probes& probes_;
  const ResultFolder& folder_;
  Progress& screen_;
  Log& log_;
  HistoryWriter history_;
  Collection collection_;
  State last_;
  long evaluations_ = 0;
  bool last_written_ = true;
  std::vector<SummaryState> states_;
  Metrics metrics_;  // of the last state
};

}  // namespace riven
