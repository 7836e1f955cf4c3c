#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.hpp"
#include "base/error.hpp"
#include "input/case_reader.hpp"
#include "input/formula.hpp"
#include "output/result_folder.hpp"
#include "simulation/verify.hpp"

namespace riven::app {

namespace {

template <class Deviation>
void print(const Deviation& deviation, bool json) {
  if (json) {
    fmt::print("{}\n", to_json(deviation).dump(2));
  } else {
    fmt::print("{}", table(deviation));
  }
}

/// kMissed when a tolerance is given and a deviation is above it or not a number.
int judged(double deviation, const std::optional<double>& tolerance) {
  return !tolerance || deviation <= *tolerance ? kDone : kMissed;
}

}  // namespace

int compare(const CompareOptions& options) {
  const ResultFolder folder = ResultFolder::open(options.folder);
  std::optional<double> tolerance;
  if (!options.tolerance.empty())
    tolerance = parse_quantity(options.tolerance, dimension::none, {}, Origin{"--tolerance", {}});

  if (!options.history.empty()) {
    const auto equals = options.history.find('=');
    if (equals == std::string::npos)
      throw InputError(
          fmt::format("--history {}: expected metric=column, as in force_x=Fx_right_N", options.history));
    const HistoryDeviation deviation =
        compare_history(folder.history(), options.reference, options.history.substr(0, equals),
                        options.history.substr(equals + 1));
    print(deviation, options.json);
    return judged(deviation.relative_l2, tolerance);
  }

  const Case input = read_case(folder.resolved());
  double exclude_within = 0;
  if (!options.exclude_within.empty())
    exclude_within =
        parse_quantity(options.exclude_within, dimension::length,
                       {.dx = input.geometry.spacing, .horizon = input.geometry.horizon, .variables = {}},
                       Origin{"--exclude-within", {}});
  const FieldDeviation deviation = compare_fields(options.folder, read_reference_points(options.reference),
                                                  compare_settings(input, exclude_within));
  print(deviation, options.json);
  int code = kDone;
  for (const StateDeviation& state : deviation.states)
    code = std::max(code, judged(state.relative_l2, tolerance));
  return code;
}

}  // namespace riven::app
