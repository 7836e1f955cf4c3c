#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cstdio>

#include "app/commands.hpp"
#include "app/gallery.hpp"
#include "base/error.hpp"
#include "input/case_reader.hpp"
#include "output/atomic_file.hpp"
#include "simulation/preflight.hpp"
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
  if (files.empty())
    throw InputError(fmt::format("{}: no case file (*.toml) in this folder", folder.string()));
  return files;
}

/// The case as it is to be run: with the overrides of its short variant, or with the user's.
struct Variant {
  Case input;
  bool brief = false;
  std::size_t unreached = 0;  // expectations that do not apply to what the user asked for
};

Variant make_variant(const fs::path& file, const Options& options, bool brief) {
  Variant variant{.input = read_case(file)};
  variant.brief = brief && variant.input.short_run;
  std::vector<std::string> set = options.set;
  if (variant.brief)
    set.insert(set.begin(), variant.input.short_run->set.begin(), variant.input.short_run->set.end());
  if (set.empty()) return variant;
  variant.input = read_case(file, set);
  if (variant.brief) variant.input.expects = variant.input.short_run->expect;
  if (!options.set.empty()) variant.unreached = drop_unreached_expectations(variant.input);
  return variant;
}

constexpr const char* kVerification = "verification.txt";

/// Prints what a verification found and leaves it in the result, which a later verification may then replace.
void tell(const fs::path& folder, const std::string& text) {
  fmt::print("{}\n", text);
  std::fflush(stdout);  // whoever reads a pipe waits for each case, not for all
  AtomicFile file(folder / kVerification);
  file.stream() << text;
  file.commit();
}

std::string verdicts_text(const fs::path& file, const Variant& variant,
                          const std::vector<Verdict>& verdicts) {
  std::string text =
      fmt::format("{}{}: {}\n{}", case_name(file), variant.brief ? " (short)" : "", variant.input.title,
                  verdicts.empty() ? "  no expectations\n" : table(verdicts));
  if (variant.unreached > 0)
    text += fmt::format("  not compared: {} at states that this run does not reach\n", variant.unreached);
  return text;
}

/// Results of shipped cases can be had again, and so can those of a verification; others took a user's time.
bool may_replace(const fs::path& file, const fs::path& folder, const Options& options) {
  return options.force || is_shipped(file) || fs::exists(folder / kVerification);
}

/// Runs one case and prints its table.
void verify_case(const fs::path& file, const Options& options, const VerifyOptions& how,
                 Verification& found) {
  const Variant variant = make_variant(file, options, how.brief);
  found.title = variant.input.title;
  found.brief = variant.brief;
  found.unreached = variant.unreached;
  const Summary summary = run_case(
      variant.input,
      {.folder = found.folder, .force = may_replace(file, found.folder, options), .case_name = found.name});
  found.summary = summary;
  found.code = summary.status == RunStatus::interrupted ? kInterrupted : kFailed;
  if (summary.status == RunStatus::interrupted) return;
  if (summary.status == RunStatus::failed) {
    found.problem = fmt::format("the run failed; see {}", (found.folder / "riven.log").string());
    return tell(found.folder, fmt::format("{}: {}\n", found.name, found.problem));
  }
  found.verdicts = judge(variant.input, variant.input.expects, found.folder);
  // With overrides the expectations of the full case say nothing that could decide.
  if (!options.set.empty())
    for (Verdict& verdict : found.verdicts) verdict.decides = false;
  tell(found.folder, verdicts_text(file, variant, found.verdicts));
  const bool met = std::all_of(found.verdicts.begin(), found.verdicts.end(),
                               [](const Verdict& v) { return v.met || !v.decides; });
  found.code = met ? kDone : kMissed;
  if (how.gallery) report_after({found.folder}, found.folder);
}

/// A case that is wrong or fails must not keep the others from being looked at.
Verification verify_guarded(const fs::path& file, const Options& options, const VerifyOptions& how) {
  Verification found{.name = case_name(file), .folder = default_output(file)};
  found.code = guarded([&] {
    try {
      verify_case(file, options, how, found);
    } catch (const std::exception& problem) {
      found.problem = problem.what();
      throw;
    }
    return found.code;
  });
  return found;
}

std::string conclusion(const std::vector<Verification>& all, bool decides) {
  const auto count = [&](int code) {
    return std::count_if(all.begin(), all.end(), [&](const Verification& each) { return each.code == code; });
  };
  const auto met = count(kDone), missed = count(kMissed);
  const auto failed = static_cast<std::ptrdiff_t>(all.size()) - met - missed;
  if (decides)
    return fmt::format("{} of {} cases meet their references, {} missed, {} failed", met, all.size(), missed,
                       failed);
  return fmt::format("{} of {} cases run with --set: deviations are reported and decide nothing, {} failed",
                     met, all.size(), failed);
}

}  // namespace

int verify(const Options& options, const VerifyOptions& how) {
  if (options.threads > 0) omp_set_num_threads(options.threads);
  std::vector<Verification> all;
  int worst = kDone;
  for (const fs::path& file : targets(options.target)) {
    all.push_back(verify_guarded(file, options, how));
    if (all.back().code == kInterrupted) return kInterrupted;
    worst = std::max(worst, all.back().code);
  }
  const std::string text = conclusion(all, options.set.empty());
  fmt::print("{}\n", text);
  if (how.gallery) {
    const fs::path file = "results/gallery.html";
    fs::create_directories(file.parent_path());
    write_gallery(file, all, text);
    fmt::print(stderr, "gallery: {}\n", file.string());
  }
  return worst;
}

}  // namespace riven::app
