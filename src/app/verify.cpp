#include <fmt/format.h>
#include <omp.h>

#include <algorithm>

#include "app/commands.hpp"
#include "base/error.hpp"
#include "input/case_reader.hpp"
#include "simulation/run.hpp"
#include "simulation/verify.hpp"

namespace riven::app {

namespace fs = std::filesystem;

namespace {

/// The cases that a target names: a folder of cases, a shipped topic, or one case. Nothing: all that ship.
std::vector<fs::path> targets(const std::string& target) {
  fs::path folder = target.empty() ? cases_folder() : fs::path(target);
  if (!fs::is_directory(folder)) folder = cases_folder() / target;
  if (!fs::is_directory(folder)) return {find_case(target)};
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.empty()) throw InputError(fmt::format("{}: no case file (*.toml) in this folder", folder.string()));
  return files;
}

/// Runs one case and prints its table. Returns its exit code.
int verify_case(const fs::path& file, const Options& options, bool brief) {
  Case input = read_case(file);
  std::vector<std::string> set = options.set;
  const bool short_variant = brief && input.short_run;
  if (short_variant) set.insert(set.begin(), input.short_run->set.begin(), input.short_run->set.end());
  if (!set.empty()) input = read_case(file, set);
  // With overrides the expectations of the full case say nothing that could decide.
  const bool decide = options.set.empty();

  const fs::path folder = default_output(file);
  const Summary summary = run_case(input, {.folder = folder, .force = true, .case_name = case_name(file)});
  if (summary.status == RunStatus::interrupted) return kInterrupted;
  if (summary.status == RunStatus::failed) {
    fmt::print("{}: the run failed; see {}\n\n", case_name(file), (folder / "riven.log").string());
    return kFailed;
  }
  const auto& expects = short_variant ? input.short_run->expect : input.expects;
  std::vector<Verdict> verdicts = judge(input, expects, folder);
  if (!decide)
    for (Verdict& verdict : verdicts) verdict.decides = false;
  const bool met = std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.met || !v.decides; });
  fmt::print("{}{}: {}\n{}\n", case_name(file), short_variant ? " (short)" : "", input.title,
             verdicts.empty() ? std::string("  no expectations\n") : table(verdicts));
  return met ? kDone : kMissed;
}

}  // namespace

int verify(const Options& options, bool brief) {
  if (options.threads > 0) omp_set_num_threads(options.threads);
  int worst = kDone;
  int missed = 0, failed = 0, met = 0;
  for (const fs::path& file : targets(options.target)) {
    const int code = verify_case(file, options, brief);
    if (code == kInterrupted) return code;
    worst = std::max(worst, code);
    ++(code == kDone ? met : code == kMissed ? missed : failed);
  }
  fmt::print("{} cases meet their references, {} miss one, {} failed\n", met, missed, failed);
  return worst;
}

}  // namespace riven::app
