#include "app/sweep_results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/csv.hpp"
#include "base/text.hpp"
#include "output/atomic_file.hpp"
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

double wall_s(const SweepOutcome& outcome) {
  return outcome.summary ? outcome.summary->timing.wall_s : std::numeric_limits<double>::quiet_NaN();
}

/// A CSV file that is written whole or not at all.
class CsvFile {
 public:
  explicit CsvFile(const std::filesystem::path& path) : file_(path) {}
  void write(Row row) {
    for (std::string& cell : row) cell = csv_cell(cell);
    file_.stream() << fmt::format("{}\n", fmt::join(row, ","));
  }
  void commit() { file_.commit(); }

 private:
  AtomicFile file_;
};

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

/// Of the variants that differ in their seeds only.
struct Spread {
  std::size_t count = 0;
  double mean = 0, deviation = 0;  // nan without values; the deviation of one value, too
};

Spread spread_of(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {values.size(), mean, std::sqrt(squares / (count - 1))};
}

/// Finished variants of a group that have the metric.
Spread spread_of(const SweepResults& results, std::size_t group, const std::string& metric) {
  const std::vector<std::size_t> groups = results.plan.groups();
  std::vector<double> values;
  for (std::size_t n = 0; n < groups.size(); ++n)
    if (groups[n] == group && results.outcomes[n].status == "finished" &&
        !std::isnan(metric_of(results.outcomes[n], metric)))
      values.push_back(metric_of(results.outcomes[n], metric));
  return spread_of(values);
}

/// Calls `visit(group, values)` for each group with the values of the keys that are no seeds.
template <class Visit>
void each_group(const SweepPlan& plan, const Visit& visit) {
  const std::vector<std::size_t> groups = plan.groups();
  std::size_t next = 0;
  for (std::size_t n = 0; n < groups.size(); ++n)
    if (groups[n] == next) visit(next++, without_seeds(plan, plan.variants[n].values));
}

std::size_t finished_in(const SweepResults& results, std::size_t group) {
  const std::vector<std::size_t> groups = results.plan.groups();
  std::size_t count = 0;
  for (std::size_t n = 0; n < groups.size(); ++n)
    count += groups[n] == group && results.outcomes[n].status == "finished" ? 1 : 0;
  return count;
}

/// Means over the seeds, for the screen.
std::string means_table(const SweepResults& results, const std::vector<HistoryColumn>& metrics) {
  std::vector<Row> rows{without_seeds(results.plan, results.plan.labels)};
  const std::size_t keys = rows[0].size();
  rows[0].emplace_back("runs");
  for (const auto& [name, unit] : metrics) rows[0].push_back(with_unit(name, unit));
  each_group(results.plan, [&](std::size_t group, Row row) {
    row.push_back(fmt::format("{}", finished_in(results, group)));
    for (const auto& [name, unit] : metrics) {
      const Spread spread = spread_of(results, group, name);
      row.push_back(spread.count == 0   ? ""
                    : spread.count == 1 ? fmt::format("{:.6g}", spread.mean)
                                        : fmt::format("{:.6g} ± {:.2g}", spread.mean, spread.deviation));
    }
    rows.push_back(std::move(row));
  });
  return "mean over the seeds ± standard deviation\n" + aligned(rows, keys);
}

/// `sweep-means.csv`: the same with all digits.
void write_means(const SweepResults& results, const std::vector<HistoryColumn>& metrics) {
  CsvFile file(results.folder / "sweep-means.csv");
  Row header = without_seeds(results.plan, results.plan.keys);
  header.emplace_back("runs");
  for (const auto& [name, unit] : metrics)
    header.insert(header.end(), {with_unit(name + " mean", unit), with_unit(name + " deviation", unit)});
  file.write(header);
  each_group(results.plan, [&](std::size_t group, Row row) {
    row.push_back(fmt::format("{}", finished_in(results, group)));
    for (const auto& metric : metrics) {
      const Spread spread = spread_of(results, group, metric.name);
      row.push_back(fmt::format("{}", spread.mean));
      row.push_back(fmt::format("{}", spread.deviation));
    }
    file.write(row);
  });
  file.commit();
}

}  // namespace

double metric_of(const SweepOutcome& outcome, const std::string& name) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!outcome.summary) return kNone;
  const auto found = outcome.summary->metrics.find(name);
  return found == outcome.summary->metrics.end() ? kNone : found->second.value;
}

std::optional<std::vector<SiValue>> si_values(const SweepPlan& plan, std::size_t key) {
  std::vector<SiValue> values;
  for (const SweepVariant& variant : plan.variants) {
    if (!variant.si[key] || variant.si[key]->unit != plan.variants.front().si[key]->unit) return std::nullopt;
    values.push_back(*variant.si[key]);
  }
  return values;
}

std::vector<std::string> without_seeds(const SweepPlan& plan, const std::vector<std::string>& of_keys) {
  std::vector<std::string> kept;
  std::size_t key = 0;
  for (const SweptKeys& swept : plan.swept)
    for (std::size_t n = 0; n < swept.names.size(); ++n, ++key)
      if (!swept.repeats()) kept.push_back(of_keys[key]);
  return kept;
}

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
  rows[0] = plan.labels;
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
  const std::string means = plan.repeats() ? means_table(results, metrics) : "";
  return aligned(rows, plan.keys.size() + 1) + left_out + means;
}

std::vector<std::string> write_sweep_tables(const SweepResults& results) {
  const SweepPlan& plan = results.plan;
  const std::vector<HistoryColumn> metrics = metric_columns(results);
  Row header;
  std::vector<std::optional<std::vector<SiValue>>> si;
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    si.push_back(si_values(plan, k));
    header.push_back(plan.keys[k]);
    if (si.back()) header.push_back(with_unit(plan.keys[k] + "_si", si.back()->front().unit));
  }
  header.emplace_back("status");
  for (const auto& [name, unit] : metrics) header.push_back(with_unit(name, unit));
  header.insert(header.end(), {"wall [s]", "folder"});

  CsvFile file(results.folder / "sweep.csv");
  file.write(header);
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
    file.write(row);
  }
  file.commit();
  if (!plan.repeats()) return {"sweep.csv"};
  write_means(results, metrics);
  return {"sweep.csv", "sweep-means.csv"};
}

}  // namespace riven::app
