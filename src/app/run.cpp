#include <fmt/format.h>
#include <omp.h>

#include <cstdio>

#include "app/commands.hpp"
#include "input/case_reader.hpp"
#include "simulation/preflight.hpp"
#include "simulation/run.hpp"

namespace riven::app {

int run(const Options& options) {
  if (options.threads > 0) omp_set_num_threads(options.threads);
  const auto file = find_case(options.target);
  Case input = read_case(file, options.set);
  const std::size_t unreached = options.set.empty() ? 0 : drop_unreached_expectations(input);
  if (unreached > 0) fmt::print(stderr, "{}\n", left_out(unreached));
  const Summary summary =
      run_case(input, {.folder = options.output.empty() ? default_output(file) : options.output,
                       .force = options.force,
                       .case_name = case_name(file)});
  if (summary.status == RunStatus::interrupted) return kInterrupted;
  return summary.status == RunStatus::finished ? kDone : kFailed;
}

}  // namespace riven::app
