#include <fmt/format.h>
#include <omp.h>

#include <cstdio>
#include <filesystem>

#include "app/commands.hpp"
#include "input/case_reader.hpp"
#include "simulation/preflight.hpp"
#include "simulation/run.hpp"

namespace riven::app {

namespace fs = std::filesystem;

namespace {

std::string resume_command(const Options& options) {
  std::string command = "riven run " + shell_word(options.target) + " --resume";
  if (!options.output.empty()) command += " -o " + shell_word(options.output.string());
  for (const std::string& set : options.set) command += " --set " + shell_word(set);
  if (!options.checkpoint_every.empty())
    command += " --checkpoint-every " + shell_word(options.checkpoint_every);
  if (options.threads > 0) command += " --threads " + std::to_string(options.threads);
  if (options.report) command += " --report";
  return command;
}

}  // namespace

int run(const Options& options) {
  if (options.threads > 0) omp_set_num_threads(options.threads);
  const auto file = find_case(options.target);
  std::vector<std::string> set = options.set;
  if (!options.checkpoint_every.empty()) set.push_back("output.checkpoint_every=" + options.checkpoint_every);
  Case input = read_case(file, set);
  const std::size_t unreached = options.set.empty() ? 0 : drop_unreached_expectations(input);
  if (unreached > 0) fmt::print(stderr, "{}\n", left_out(unreached));
  const fs::path folder = options.output.empty() ? default_output(file) : options.output;
  const Summary summary = run_case(input, {.folder = folder,
                                           .force = options.force,
                                           .resume = options.resume,
                                           .resume_command = resume_command(options),
                                           .case_name = case_name(file)});
  const int reported = options.report ? report_after({folder}, folder) : kDone;
  if (summary.status == RunStatus::interrupted) return kInterrupted;
  return summary.status == RunStatus::finished ? reported : kFailed;
}

}  // namespace riven::app
