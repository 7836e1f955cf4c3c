#pragma once

#include <chrono>
#include <optional>

#include "output/checkpoint.hpp"
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
  using Clock = std::chrono::steady_clock;
  /// `start`: of this program's work on the run. With a checkpoint the files go on behind it: what was
  /// written later is cut off.
  Recorder(const Simulation& simulation, const Probes& probes, const ResultFolder& folder, Progress& screen,
           Log& log, Clock::time_point start, const Checkpoint* from);

  void progressed(const SolverProgress& progress) override;
  void reached(const State& state, const Constraints& constraints, bool output) override;
  void remarked(const std::string& message) override;
  /// Writes a checkpoint when it is time. Throws Interrupted, with a checkpoint written, when SIGINT or
  /// SIGTERM has come.
  void safe_point(const std::function<Snapshot()>& take) override;

  /// Writes the last state that was reached, if it is not written yet: what a failed run leaves.
  void keep_last();
  /// What has been reached, for summary.json; `status` and timing are the caller's.
  [[nodiscard]] Summary summary() const;
  [[nodiscard]] const State& last() const { return last_; }
  /// Force evaluations so far, those of an unfinished step included.
  [[nodiscard]] long evaluations() const { return evaluations_; }
  /// Of static solvers.
  [[nodiscard]] long iterations() const { return iterations_; }
  /// Wall time (s) so far, of the programs before a resumption too.
  [[nodiscard]] double wall_s() const;

 private:
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each);
  void go_on(const Snapshot& from);
  void write_checkpoint(Snapshot state);
  void bring_results_to_disk();
  void add_state(double parameter, const std::vector<double>& values);
  void write_fields();
  void look_at_rotations(const ModelField& gradient);
  /// At the last state; a model whose force is not the gradient of its energy has no balance.
  [[nodiscard]] EnergySummary energy() const;

  const Simulation& simulation_;
  const Probes& probes_;
  const ResultFolder& folder_;
  Progress& screen_;
  Log& log_;
  HistoryWriter history_, energy_;
  Collection collection_;
  State last_;
  Snapshot last_model_;              // what the model remembered then
  std::vector<double> last_values_;  // of the probes
  LargestValues largest_;
  long evaluations_ = 0, iterations_ = 0;
  bool last_written_ = true;
  bool rotations_told_ = false;
  std::vector<SummaryState> states_;
  std::vector<double>
      state_values_;  // what they were made of: of each the parameter, then the probes' values

  Clock::time_point start_, last_checkpoint_;
  double wall_before_s_ = 0;  // in the programs before
  long steps_since_checkpoint_ = 0;
  std::size_t states_on_disk_ = 0;
  std::map<std::string, std::string> case_values_;
};

}  // namespace riven
