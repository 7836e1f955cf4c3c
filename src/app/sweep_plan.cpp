#include "app/sweep_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>
#include <zlib.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <set>

#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/nearest_name.hpp"
#include "base/text.hpp"
#include "input/case_reader.hpp"
#include "simulation/estimate.hpp"
#include "simulation/preflight.hpp"
#include "simulation/resume.hpp"

namespace riven::app {

namespace {

constexpr std::size_t kMostVariants = 10000;

/// Every combination of one value of each group of keys, the last changing fastest: numbers of the values.
std::vector<std::vector<std::size_t>> combinations(const std::vector<SweptKeys>& swept) {
  std::vector<std::vector<std::size_t>> all(1);
  for (const SweptKeys& keys : swept) {
    std::vector<std::vector<std::size_t>> longer;
    for (const auto& begun : all)
      for (std::size_t row = 0; row < keys.values.size(); ++row) {
        longer.push_back(begun);
        longer.back().push_back(row);
      }
    all = std::move(longer);
    if (all.size() > kMostVariants)
      throw InputError(fmt::format("a sweep of more than {} variants; expected fewer values", kMostVariants));
  }
  return all;
}

/// "geometry.horizon=4 dx" of each key.
std::vector<std::string> assignments(const std::vector<std::string>& keys,
                                     const std::vector<std::string>& values) {
  std::vector<std::string> parts;
  for (std::size_t n = 0; n < keys.size(); ++n) parts.push_back(fmt::format("{}={}", keys[n], values[n]));
  return parts;
}

/// Names of the keys that keep folders and tables narrow.
std::vector<std::string> labels_of(const std::vector<std::string>& keys) {
  constexpr std::size_t kLong = 60;  // characters together
  std::size_t length = 0;
  for (const std::string& key : keys) length += key.size();
  return length > kLong ? short_names(keys) : keys;
}

void make_variants(SweepPlan& plan, const std::vector<std::string>& set) {
  for (const SweptKeys& keys : plan.swept)
    plan.keys.insert(plan.keys.end(), keys.names.begin(), keys.names.end());
  plan.labels = labels_of(plan.keys);
  std::set<std::string> names;
  for (auto& rows : combinations(plan.swept)) {
    SweepVariant variant{.rows = std::move(rows), .set = set};
    for (std::size_t n = 0; n < plan.swept.size(); ++n) {
      const std::vector<std::string>& values = plan.swept[n].values[variant.rows[n]];
      variant.values.insert(variant.values.end(), values.begin(), values.end());
    }
    const std::vector<std::string> parts = assignments(plan.keys, variant.values);
    variant.set.insert(variant.set.end(), parts.begin(), parts.end());
    const std::string name =
        file_word(fmt::format("{}", fmt::join(assignments(plan.labels, variant.values), ",")));
    variant.name = name;
    for (int number = 2; !names.insert(variant.name).second; ++number)
      variant.name = fmt::format("{}-{}", name, number);
    plan.variants.push_back(std::move(variant));
  }
}

/// The case of a variant as `riven run` reads it.
Case case_of(const std::filesystem::path& file, const SweepVariant& variant) {
  Case input = read_case(file, variant.set);
  drop_unreached_expectations(input);
  return input;
}

/// Memory (bytes) of the runs that need most, `jobs` of them at a time.
double memory_of(std::vector<double> needs, std::size_t jobs) {
  const auto end = needs.begin() + static_cast<std::ptrdiff_t>(std::min(jobs, needs.size()));
  std::partial_sort(needs.begin(), end, needs.end(), std::greater<>());
  return std::accumulate(needs.begin(), end, 0.0);
}

/// How many run side by side: as asked, or as many as there are cores and memory for. Small runs gain little
/// from a second core, so that each of them has one.
int side_by_side(const SweepOptions& options, const std::vector<double>& needs) {
  const double available = available_memory();
  auto jobs = static_cast<std::size_t>(options.jobs);
  if (jobs == 0) {
    const int cores = omp_get_num_procs() / std::max(1, options.threads);
    jobs = std::min(static_cast<std::size_t>(std::max(1, cores)), needs.size());
    while (jobs > 1 && memory_of(needs, jobs) > available) --jobs;
  }
  if (jobs > 1 && memory_of(needs, jobs) > available)
    throw InputError(fmt::format(
        "-j {}: {} runs side by side need about {} of memory, and {} are available; "
        "expected fewer",
        jobs, std::min(jobs, needs.size()), bytes_text(memory_of(needs, jobs)), bytes_text(available)));
  return static_cast<int>(jobs);
}

std::vector<HistoryColumn> columns_of_first_probe(Simulation& simulation) {
  if (simulation.input.probes.empty()) return {};
  simulation.input.probes.resize(1);
  return Probes(simulation).columns();
}

/// Runs `check` for each variant; what is wrong is told with its variant.
void for_each_checked(SweepPlan& plan, const std::function<void(SweepVariant&)>& check) {
  for (SweepVariant& variant : plan.variants) {
    try {
      check(variant);
    } catch (const InputError& wrong) {
      throw InputError(fmt::format("variant {}: {}", plan.text(variant), wrong.what()));
    }
  }
}

/// The number of a key by its name or its last part.
std::optional<std::size_t> find_key(const std::string& name, const std::vector<std::string>& keys) {
  for (const auto& names : {keys, short_names(keys)}) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  }
  return std::nullopt;
}

/// `columns`: of the histories.
SweepPlot read_plot(const std::string& text, const SweepPlan& plan, const std::vector<std::string>& columns) {
  const std::vector<std::string> axes = split_at_commas(text);
  if (axes.size() != 2)
    throw InputError(
        fmt::format("--plot {}: expected two names, as in \"strain, stress\": a column over "
                    "another one",
                    text));
  const auto is_column = [&](const std::string& axis) {
    return std::find(columns.begin(), columns.end(), axis) != columns.end();
  };
  SweepPlot plot{axes[0], axes[1], std::nullopt};
  if (!is_column(plot.x)) plot.key = find_key(plot.x, plan.keys);
  const bool x_known = is_column(plot.x) || plot.key;
  if (!x_known || !is_column(plot.y)) {
    const std::string& wrong = x_known ? plot.y : plot.x;
    throw InputError(
        fmt::format("--plot {}: \"{}\" is neither a column of the history{}; the columns are {}{}", text,
                    wrong, x_known ? " nor a swept key, which may stand first" : " nor a swept key",
                    listed(columns), did_you_mean(wrong, columns)));
  }
  if (plot.key && std::any_of(plan.variants.begin(), plan.variants.end(),
                              [&](const SweepVariant& variant) { return !variant.si[*plot.key]; }))
    throw InputError(fmt::format("--plot {}: the values of {} are no numbers", text, plan.keys[*plot.key]));
  return plot;
}

/// What the sweep runs and draws, from the command line or the study of the case.
struct Wanted {
  std::vector<SweptKeys> swept;
  std::vector<std::string> plots;
};

Wanted what_is_wanted(const SweepOptions& options, const Case& input) {
  if (!options.keys.empty()) return {all_swept_keys(options.keys), options.plots};
  if (!input.study)
    throw InputError(
        fmt::format("{}: has no [study], which says what to sweep; expected KEY=a,b,c", input.file.string()));
  try {
    return {all_swept_keys(input.study->keys), options.plots.empty() ? input.study->plots : options.plots};
  } catch (const InputError& wrong) {
    throw InputError(input.study->at, fmt::format("study.keys: {}", wrong.what()));
  }
}

}  // namespace

std::string SweepPlan::text(const SweepVariant& variant) const {
  return fmt::format("{}", fmt::join(assignments(labels, variant.values), ", "));
}

std::vector<std::size_t> SweepPlan::groups() const {
  std::vector<std::vector<std::size_t>> known;
  std::vector<std::size_t> groups;
  for (const SweepVariant& variant : variants) {
    std::vector<std::size_t> rows = variant.rows;
    for (std::size_t n = 0; n < swept.size(); ++n)
      if (swept[n].repeats()) rows[n] = 0;
    const auto found = std::find(known.begin(), known.end(), rows);
    groups.push_back(static_cast<std::size_t>(found - known.begin()));
    if (found == known.end()) known.push_back(std::move(rows));
  }
  return groups;
}

bool SweepPlan::repeats() const {
  const std::vector<std::size_t> all = groups();
  const std::size_t count = 1 + *std::max_element(all.begin(), all.end());
  return count > 1 && count < variants.size();
}

SweepPlan plan_sweep(const SweepOptions& options) {
  const Case input = read_case(find_case(options.target), options.set);
  const Wanted wanted = what_is_wanted(options, input);
  SweepPlan plan{.file = input.file, .title = input.title, .swept = wanted.swept};
  make_variants(plan, options.set);
  std::vector<double> needs;
  for_each_checked(plan, [&](SweepVariant& variant) {
    const Case read = case_of(plan.file, variant);
    for (const std::string& key : plan.keys) variant.si.push_back(value_in_si(read, key));
    needs.push_back(memory_estimate(read));
    for (const auto& [key, value] : decisive_values(read)) {
      const std::string line = key + "=" + value + "\n";
      plan.checksum =
          ::crc32(plan.checksum, reinterpret_cast<const Bytef*>(line.data()), static_cast<uInt>(line.size()));
    }
  });
  plan.jobs = side_by_side(options, needs);
  std::vector<std::string> columns;
  for_each_checked(plan, [&](SweepVariant& variant) {
    Simulation simulation = build_simulation(case_of(plan.file, variant));
    const Probes probes(simulation);
    check_before_run(simulation, probes);
    if (&variant != &plan.variants.front()) return;
    columns.emplace_back(name(simulation.parameter));
    for (const HistoryColumn& column : probes.columns()) columns.push_back(column.name);
    plan.first_probe = columns_of_first_probe(simulation);
  });
  for (const std::string& text : wanted.plots) plan.plots.push_back(read_plot(text, plan, columns));
  return plan;
}

}  // namespace riven::app
