#include "app/sweep_charts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "output/result_folder.hpp"
#include "report/chart.hpp"
#include "report/ticks.hpp"

namespace riven::app {

namespace {

/// Variants in the order of a key's values, without those that have no result.
std::vector<std::size_t> in_order_of(const std::vector<SiValue>& at, const SweepResults& results) {
  std::vector<std::size_t> order(at.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return at[a].value < at[b].value; });
  std::erase_if(order, [&](std::size_t n) { return results.outcomes[n].status != "finished"; });
  return order;
}

/// Metrics of the first probe over the one key.
Chart chart_over_key(const SweepResults& results, const std::vector<SiValue>& at) {
  const SweepPlan& plan = results.plan;
  Chart chart{.title = plan.title, .x = {plan.keys.front(), at.front().unit}};
  chart.y = {plan.first_probe.front().name, plan.first_probe.front().unit};
  for (const HistoryColumn& metric : plan.first_probe) {
    if (metric.unit != chart.y.unit) continue;
    Series series{.name = metric.name};
    for (const std::size_t n : in_order_of(at, results)) {
      series.x.push_back(at[n].value);
      series.y.push_back(metric_of(results.outcomes[n], metric.name));
    }
    chart.series.push_back(std::move(series));
  }
  if (chart.series.size() > 1) chart.y.name = "";
  return chart;
}

/// "number=12, radius=6 mm"
std::string legend_text(const std::vector<std::string>& keys, const std::vector<std::string>& values) {
  const std::vector<std::string> names = short_names(keys);
  std::vector<std::string> parts;
  for (std::size_t n = 0; n < names.size(); ++n) parts.push_back(fmt::format("{}={}", names[n], values[n]));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// The group of keys to which a key belongs.
std::size_t swept_with(const SweepPlan& plan, std::size_t key) {
  std::size_t n = 0;
  for (std::size_t end = plan.swept[0].names.size(); key >= end; end += plan.swept[n].names.size()) ++n;
  return n;
}

/// One metric over a key that was asked for, a line for each combination of the other keys.
Chart chart_of_plot(const SweepResults& results, const SweepPlot& plot, const std::vector<SiValue>& at) {
  const SweepPlan& plan = results.plan;
  Chart chart{
      .title = plan.title, .x = {last_part(plan.keys[*plot.key]), at.front().unit}, .y = {plot.y, ""}};
  std::map<std::vector<std::size_t>, Series> lines;
  for (const std::size_t n : in_order_of(at, results)) {
    const SweepVariant& variant = plan.variants[n];
    const Metrics& metrics = results.outcomes[n].summary->metrics;
    const auto metric = metrics.find(plot.y);
    if (metric == metrics.end()) continue;
    chart.y.unit = metric->second.unit;
    std::vector<std::size_t> others = variant.rows;
    others[swept_with(plan, *plot.key)] = 0;
    Series& line = lines[others];
    if (line.x.empty()) {
      std::vector<std::string> keys, values;
      for (std::size_t k = 0; k < plan.keys.size(); ++k)
        if (swept_with(plan, k) != swept_with(plan, *plot.key)) {
          keys.push_back(plan.keys[k]);
          values.push_back(variant.values[k]);
        }
      line.name = legend_text(keys, values);
    }
    line.x.push_back(at[n].value);
    line.y.push_back(metric->second.value);
  }
  for (auto& [others, line] : lines) chart.series.push_back(std::move(line));
  return chart;
}

/// A column of each history over another one; the first over time or stretch unless something is asked for.
Chart chart_of_histories(const SweepResults& results, const SweepPlot* plot) {
  const SweepPlan& plan = results.plan;
  const std::vector<std::size_t> groups = plan.groups();
  const bool shared = plan.repeats();
  Chart chart{.title = plan.title};
  for (std::size_t n = 0; n < plan.variants.size(); ++n) {
    const auto folder = results.folder / plan.variants[n].name;
    if (!results.outcomes[n].summary) continue;
    const History history = History::read(ResultFolder::open(folder).history());
    const auto [x, x_unit] = name_and_unit(plot ? history.column_name(plot->x) : history.columns()[0]);
    const auto [y, y_unit] = name_and_unit(plot ? history.column_name(plot->y) : history.columns()[1]);
    chart.x = {x, x_unit};
    chart.y = {y, y_unit};
    const auto& values = plan.variants[n].values;
    Series series{.name = shared ? legend_text(without_seeds(plan, plan.keys), without_seeds(plan, values))
                                 : legend_text(plan.keys, values),
                  .x = history.column(x),
                  .y = history.column(y)};
    if (shared) series.group = groups[n];
    chart.series.push_back(std::move(series));
  }
  return chart;
}

Chart default_chart(const SweepResults& results) {
  const auto numbers = results.plan.keys.size() == 1 ? si_values(results.plan, 0) : std::nullopt;
  return numbers ? chart_over_key(results, *numbers) : chart_of_histories(results, nullptr);
}

Chart chart_asked_for(const SweepResults& results, const SweepPlot& plot) {
  if (!plot.key) return chart_of_histories(results, &plot);
  const auto numbers = si_values(results.plan, *plot.key);
  return numbers ? chart_of_plot(results, plot, *numbers) : Chart{};
}

}  // namespace

std::vector<std::string> draw_sweep(const SweepResults& results) {
  const SweepPlan& plan = results.plan;
  std::vector<Chart> charts;
  if (plan.plots.empty() && !plan.first_probe.empty()) charts.push_back(default_chart(results));
  for (const SweepPlot& plot : plan.plots) charts.push_back(chart_asked_for(results, plot));
  std::vector<std::string> files;
  for (std::size_t n = 0; n < charts.size(); ++n) {
    const std::string file = n == 0 ? "sweep.png" : fmt::format("sweep-{}.png", n + 1);
    const std::filesystem::path path = results.folder / file;
    std::filesystem::remove(path);  // of the runs before
    const bool empty = std::all_of(charts[n].series.begin(), charts[n].series.end(),
                                   [](const Series& series) { return series.x.empty(); });
    if (empty) continue;
    write_picture(path, draw_chart(charts[n], PictureSize{}, path));
    files.push_back(file);
  }
  return files;
}

}  // namespace riven::app
