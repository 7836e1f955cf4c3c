#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <list>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "app/child_run.hpp"
#include "app/commands.hpp"
#include "app/sweep_charts.hpp"
#include "app/sweep_plan.hpp"
#include "app/sweep_results.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "output/atomic_file.hpp"
#include "output/result_folder.hpp"
#include "simulation/interrupt.hpp"

namespace riven::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMark = "sweep.toml";

const FolderKind kSweep{"a sweep of Riven", kMark,
                        [](const fs::path& folder) { return fs::exists(folder / kMark); }};

std::string toml_list(const std::vector<std::string>& texts) {
  std::string list;
  for (const std::string& text : texts)
    list.append(list.empty() ? "" : ", ").append(nlohmann::json(text).dump());
  return "[" + list + "]";
}

/// What decides what a sweep runs. The checksum is last: a difference that can be named is.
std::string mark_text(const SweepPlan& plan, const SweepOptions& options) {
  std::string text =
      fmt::format("case = {}\nset = {}\n", nlohmann::json(fs::absolute(plan.file).string()).dump(),
                  toml_list(options.set));
  for (const SweptKeys& keys : plan.swept) {
    std::vector<std::string> values;
    for (std::size_t row = 0; row < keys.values.size(); ++row) values.push_back(keys.text(row));
    text += fmt::format("\n[[key]]\nname = {}\nvalues = {}\n", nlohmann::json(keys.name()).dump(),
                        toml_list(values));
  }
  return text + fmt::format("\n[case_values]\nchecksum = \"{:08x}\"\n", plan.checksum);
}

/// A sweep that goes on runs what it ran before.
void check_same_sweep(const fs::path& folder, const std::string& mark) {
  if (!kSweep.is(folder))
    throw InputError(fmt::format("{}: is not {} (it has no {}); expected one to go on with", folder.string(),
                                 kSweep.what, kSweep.marks));
  std::ifstream file(folder / kMark);
  std::istringstream now(mark);
  std::string was, is;
  while (true) {
    const bool more = static_cast<bool>(std::getline(file, was));
    if (more != static_cast<bool>(std::getline(now, is)) || (more && was != is))
      throw InputError(
          fmt::format("{}: holds another sweep (was {}, is {}); expected the same case, keys and "
                      "values, or --force instead of --resume to start over",
                      folder.string(), more ? was : "nothing", now ? is : "nothing"));
    if (!more) return;
  }
}

/// The folder of a sweep; others stay out as long as it is open.
class SweepFolder {
 public:
  SweepFolder(const fs::path& path, const std::string& mark, const SweepOptions& options) {
    if (options.resume) {
      check_same_sweep(path, mark);
      lock_ = lock_folder(path);
      return;
    }
    check_free(fs::weakly_canonical(fs::absolute(path)), options.force, kSweep);
    fs::remove_all(path);
    fs::create_directories(path);
    lock_ = lock_folder(path);
    AtomicFile file(path / kMark);
    file.stream() << mark;
    file.commit();
  }
  ~SweepFolder() {
    if (lock_ >= 0) ::close(lock_);
  }
  SweepFolder(const SweepFolder&) = delete;
  SweepFolder& operator=(const SweepFolder&) = delete;

 private:
  int lock_ = -1;
};

/// The runs of a sweep, as many side by side as are wanted.
class SweepRuns {
 public:
  SweepRuns(const SweepPlan& plan, const fs::path& folder, const SweepOptions& options)
      : threads_(options.threads > 0 ? options.threads : std::max(1, omp_get_num_procs() / plan.jobs)),
        results_{plan, folder, std::vector<SweepOutcome>(plan.variants.size())} {}

  /// Returns when all have ended, or have been stopped by an interrupt.
  const SweepResults& run() {
    constexpr std::chrono::milliseconds kMoment{20};
    std::size_t next = 0;
    const std::size_t count = results_.plan.variants.size();
    while (!running_.empty() || (next < count && !interrupt_requested())) {
      while (next < count && running_.size() < static_cast<std::size_t>(results_.plan.jobs) &&
             !interrupt_requested())
        start(next++);
      std::this_thread::sleep_for(kMoment);
      if (interrupt_requested())
        for (Running& each : running_) each.run.interrupt();
      std::erase_if(running_, [&](Running& each) {
        const auto code = each.run.ended();
        if (code) conclude(each, *code);
        return code.has_value();
      });
    }
    return results_;
  }

 private:
  struct Running {
    std::size_t variant;
    ChildRun run;
  };

  [[nodiscard]] fs::path folder(std::size_t n) const {
    return results_.folder / results_.plan.variants[n].name;
  }
  [[nodiscard]] fs::path log(std::size_t n) const { return folder(n).string() + ".log"; }

  void start(std::size_t n) {
    std::vector<std::string> words{"run",       results_.plan.file.string(), "-o", folder(n).string(),
                                   "--threads", std::to_string(threads_)};
    for (const std::string& set : results_.plan.variants[n].set) words.insert(words.end(), {"--set", set});
    if (fs::exists(folder(n))) {
      wait_until_free(folder(n));
      words.emplace_back("--resume");
    }
    running_.push_back({n, ChildRun(words, log(n))});
  }

  /// The runs of a sweep that was killed write a checkpoint before they end.
  static void wait_until_free(const fs::path& folder) {
    constexpr int kMostTries = 300;
    constexpr std::chrono::milliseconds kPause{100};
    for (int tries = 0; tries < kMostTries && !interrupt_requested(); ++tries) {
      try {
        ::close(lock_folder(folder));
        return;
      } catch (const InputError&) {
        std::this_thread::sleep_for(kPause);
      }
    }
  }

  void conclude(const Running& of, int code) {
    SweepOutcome& outcome = results_.outcomes[of.variant];
    const fs::path summary = folder(of.variant) / "summary.json";
    if (code != kWrongInput && fs::exists(summary)) outcome.summary = read_summary(summary);
    outcome.status = code == kDone ? "finished" : code == kInterrupted ? "interrupted" : "failed";
    ++ended_;
    const std::size_t count = results_.outcomes.size();
    std::string line = fmt::format("[{}/{}] {}: {} in {}", ended_, count,
                                   results_.plan.text(results_.plan.variants[of.variant]), outcome.status,
                                   duration_text(of.run.seconds()));
    if (ended_ < count && !interrupt_requested())
      line += fmt::format(", about {} left", duration_text(since_start() / static_cast<double>(ended_) *
                                                           static_cast<double>(count - ended_)));
    if (code == kDone && outcome.summary && !outcome.summary->metrics.empty())
      line += fmt::format(": {}", metrics_text(outcome.summary->metrics, results_.plan));
    if (outcome.status == "failed") line += fmt::format(": {}", last_words(of.variant));
    fmt::print(stderr, "{}\n", line);
    std::error_code ignored;
    if (code == kDone) fs::remove(log(of.variant), ignored);
  }

  /// The last error that a run told.
  [[nodiscard]] std::string last_words(std::size_t n) const {
    std::ifstream file(log(n));
    std::string words = "see " + log(n).string();
    for (std::string line; std::getline(file, line);)
      if (line.starts_with("error: ")) words = line.substr(7);
    return words;
  }

  [[nodiscard]] double since_start() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  int threads_;
  SweepResults results_;
  std::list<Running> running_;
  std::size_t ended_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string resume_command(const SweepOptions& options, const fs::path& folder) {
  std::string command = "riven sweep " + shell_word(options.target);
  for (const std::string& key : options.keys) command += fmt::format(" {}", shell_word(key));
  for (const std::string& set : options.set) command += fmt::format(" --set {}", shell_word(set));
  for (const std::string& plot : options.plots) command += fmt::format(" --plot {}", shell_word(plot));
  command += fmt::format(" -o {}", shell_word(folder.string()));
  if (options.jobs > 0) command += fmt::format(" -j {}", options.jobs);
  if (options.threads > 0) command += fmt::format(" --threads {}", options.threads);
  if (options.report) command += " --report";
  return command + " --resume";
}

int exit_code(const SweepResults& results) {
  const bool all = std::all_of(results.outcomes.begin(), results.outcomes.end(),
                               [](const SweepOutcome& outcome) { return outcome.status == "finished"; });
  return all ? kDone : kFailed;
}

/// Folders of the variants that have something to show.
std::vector<fs::path> reached(const SweepResults& results) {
  std::vector<fs::path> folders;
  for (std::size_t n = 0; n < results.outcomes.size(); ++n)
    if (results.outcomes[n].summary) folders.push_back(results.folder / results.plan.variants[n].name);
  return folders;
}

}  // namespace

int sweep(const SweepOptions& options) {
  const SweepPlan plan = plan_sweep(options);
  const fs::path path =
      options.output.empty() ? fs::path(default_output(plan.file).string() + "-sweep") : options.output;
  const SweepFolder folder(path, mark_text(plan, options), options);
  fmt::print(stderr, "{}: {}, {} at a time -> {}\n", plan.title,
             count_text(static_cast<double>(plan.variants.size()), "variant"), plan.jobs, path.string());
  watch_interrupts();
  SweepRuns runs(plan, path, options);
  const SweepResults& results = runs.run();
  std::vector<std::string> files = write_sweep_tables(results);
  for (std::string& picture : draw_sweep(results)) files.push_back(std::move(picture));
  fmt::print("{}", sweep_table(results));
  const int reported = options.report ? report_after(reached(results), path) : kDone;
  fmt::print(stderr, "results: {}/ ({})\n", path.string(), fmt::join(files, ", "));
  if (interrupt_requested()) {
    fmt::print(stderr, "warning: interrupted. To go on: {}\n", resume_command(options, path));
    return kInterrupted;
  }
  return reported == kDone ? exit_code(results) : reported;
}

}  // namespace riven::app
