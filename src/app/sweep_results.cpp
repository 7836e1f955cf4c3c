#include "app/sweep_results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "base/csv.hpp"
#include "base/text.hpp"
#include "output/atomic_file.hpp"
#include "output/result_folder.hpp"
#include "report/chart.hpp"
#include "report/ticks.hpp"

namespace riven::app {

namespace {

constexpr std::size_t kMostMetrics = 4;  // on the screen

using Row = std::vector<std::string>;

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
}

/// Metrics in the order in which they are told: those of the case's first probe, then the others.
std::vector<HistoryColumn> in_order(const Metrics& metrics, const SweepPlan& plan) {
  std::vector<HistoryColumn> columns;
  for (const HistoryColumn& first : plan.first_probe)
    if (metrics.contains(first.name)) columns.push_back(first);
  for (const auto& [name, metric] : metrics)
    if (std::none_of(plan.first_probe.begin(), plan.first_probe.end(),
                     [&, &name = name](const HistoryColumn& first) { return first.name == name; }))
      columns.push_back({name, metric.unit});
  return columns;
}

/// The metrics of all variants.
std::vector<HistoryColumn> metric_columns(const SweepResults& results) {
  Metrics all;
  for (const SweepOutcome& outcome : results.outcomes)
    if (outcome.summary) all.insert(outcome.summary->metrics.begin(), outcome.summary->metrics.end());
  return in_order(all, results.plan);
}

double metric_of(const SweepOutcome& outcome, const std::string& name) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!outcome.summary) return kNone;
  const auto found = outcome.summary->metrics.find(name);
  return found == outcome.summary->metrics.end() ? kNone : found->second.value;
}

double wall_s(const SweepOutcome& outcome) {
  return outcome.summary ? outcome.summary->timing.wall_s : std::numeric_limits<double>::quiet_NaN();
}

/// The SI values of a key, if it is a number in all variants.
std::optional<std::vector<SiValue>> si_values(const SweepPlan& plan, std::size_t key) {
  std::vector<SiValue> values;
  for (const SweepVariant& variant : plan.variants) {
    if (!variant.si[key] || variant.si[key]->unit != plan.variants.front().si[key]->unit) return std::nullopt;
    values.push_back(*variant.si[key]);
  }
  return values;
}

std::string aligned(const std::vector<Row>& rows, std::size_t left_columns) {
  std::vector<std::size_t> width(rows.front().size());
  for (const Row& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  std::string text;
  for (const Row& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c)
      text += c < left_columns ? fmt::format("{}{:<{}}", c == 0 ? "" : "  ", row[c], width[c])
                               : fmt::format("  {:>{}}", row[c], width[c]);
    text += "\n";
  }
  return text;
}

/// Metrics of the first probe over the one key.
Chart chart_over_key(const SweepResults& results, const std::vector<SiValue>& at) {
  const SweepPlan& plan = results.plan;
  Chart chart{.title = plan.title, .x = {plan.keys.front().name, at.front().unit}};
  chart.y = {plan.first_probe.front().name, plan.first_probe.front().unit};
  std::vector<std::size_t> order(at.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return at[a].value < at[b].value; });
  std::erase_if(order, [&](std::size_t n) { return results.outcomes[n].status != "finished"; });
  for (const HistoryColumn& metric : plan.first_probe) {
    if (metric.unit != chart.y.unit) continue;
    Series series{.name = metric.name};
    for (const std::size_t n : order) {
      series.x.push_back(at[n].value);
      series.y.push_back(metric_of(results.outcomes[n], metric.name));
    }
    chart.series.push_back(std::move(series));
  }
  if (chart.series.size() > 1) chart.y.name = "";
  return chart;
}

/// A variant in a legend: only the last parts of the keys' names, if they differ.
std::string short_text(const SweepPlan& plan, const SweepVariant& variant) {
  std::set<std::string> names;
  std::vector<std::string> parts;
  for (std::size_t n = 0; n < plan.keys.size(); ++n) {
    const std::string name = plan.keys[n].name.substr(plan.keys[n].name.rfind('.') + 1);
    names.insert(name);
    parts.push_back(fmt::format("{}={}", name, variant.values[n]));
  }
  return names.size() == parts.size() ? fmt::format("{}", fmt::join(parts, ", ")) : plan.text(variant);
}

/// The first column of each history.
Chart chart_of_histories(const SweepResults& results) {
  const SweepPlan& plan = results.plan;
  Chart chart{.title = plan.title};
  for (std::size_t n = 0; n < plan.variants.size(); ++n) {
    const auto folder = results.folder / plan.variants[n].name;
    if (!results.outcomes[n].summary) continue;
    const History history = History::read(ResultFolder::open(folder).history());
    const auto [x, x_unit] = name_and_unit(history.columns()[0]);
    const auto [y, y_unit] = name_and_unit(history.columns()[1]);
    chart.x = {x, x_unit};
    chart.y = {y, y_unit};
    chart.series.push_back({short_text(plan, plan.variants[n]), history.parameter(), history.column(y)});
  }
  return chart;
}

}  // namespace

std::string metrics_text(const Metrics& metrics, const SweepPlan& plan) {
  std::vector<std::string> parts;
  for (const auto& [name, unit] : in_order(metrics, plan)) {
    if (parts.size() == kMostMetrics) break;
    parts.push_back(fmt::format("{} {}", name, readable(metrics.at(name).value, unit)));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string sweep_table(const SweepResults& results) {
  const SweepPlan& plan = results.plan;
  std::vector<HistoryColumn> metrics = metric_columns(results);
  const std::size_t more = metrics.size() - std::min(metrics.size(), kMostMetrics);
  metrics.resize(metrics.size() - more);
  std::vector<Row> rows(1);
  for (const SweptKey& key : plan.keys) rows[0].push_back(key.name);
  rows[0].emplace_back("status");
  for (const auto& [name, unit] : metrics) rows[0].push_back(with_unit(name, unit));
  rows[0].emplace_back("wall time");
  for (std::size_t n = 0; n < plan.variants.size(); ++n) {
    const SweepOutcome& outcome = results.outcomes[n];
    Row row = plan.variants[n].values;
    row.push_back(outcome.status);
    for (const auto& [name, unit] : metrics)
      row.push_back(std::isnan(metric_of(outcome, name)) ? ""
                                                         : fmt::format("{:.6g}", metric_of(outcome, name)));
    row.push_back(outcome.summary ? duration_text(wall_s(outcome)) : "");
    rows.push_back(std::move(row));
  }
  const std::string left_out =
      more > 0 ? fmt::format("{} in sweep.csv\n", count_text(static_cast<double>(more), "more metric")) : "";
  return aligned(rows, plan.keys.size() + 1) + left_out;
}

void write_sweep_csv(const SweepResults& results) {
  const SweepPlan& plan = results.plan;
  const std::vector<HistoryColumn> metrics = metric_columns(results);
  Row header;
  std::vector<std::optional<std::vector<SiValue>>> si;
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    si.push_back(si_values(plan, k));
    header.push_back(plan.keys[k].name);
    if (si.back()) header.push_back(with_unit(plan.keys[k].name + "_si", si.back()->front().unit));
  }
  header.emplace_back("status");
  for (const auto& [name, unit] : metrics) header.push_back(with_unit(name, unit));
  header.insert(header.end(), {"wall [s]", "folder"});

  AtomicFile file(results.folder / "sweep.csv");
  const auto write = [&](Row row) {
    for (std::string& cell : row) cell = csv_cell(cell);
    file.stream() << fmt::format("{}\n", fmt::join(row, ","));
  };
  write(header);
  for (std::size_t n = 0; n < plan.variants.size(); ++n) {
    Row row;
    for (std::size_t k = 0; k < plan.keys.size(); ++k) {
      row.push_back(plan.variants[n].values[k]);
      if (si[k]) row.push_back(fmt::format("{}", (*si[k])[n].value));
    }
    row.push_back(results.outcomes[n].status);
    for (const auto& [name, unit] : metrics)
      row.push_back(fmt::format("{}", metric_of(results.outcomes[n], name)));
    row.push_back(fmt::format("{}", wall_s(results.outcomes[n])));
    row.push_back(plan.variants[n].name);
    write(row);
  }
  file.commit();
}

bool draw_sweep(const SweepResults& results) {
  const SweepPlan& plan = results.plan;
  if (plan.first_probe.empty()) return false;
  const auto numbers = plan.keys.size() == 1 ? si_values(plan, 0) : std::nullopt;
  const Chart chart = numbers ? chart_over_key(results, *numbers) : chart_of_histories(results);
  if (chart.series.empty() || chart.series.front().x.empty()) return false;
  const std::filesystem::path path = results.folder / "sweep.png";
  write_picture(path, draw_chart(chart, PictureSize{}, path));
  return true;
}

}  // namespace riven::app
