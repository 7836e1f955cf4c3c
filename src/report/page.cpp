#include "report/page.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

#include "base/embedded.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "output/atomic_file.hpp"
#include "output/checkpoint.hpp"
#include "output/result_folder.hpp"
#include "report/colour_map.hpp"
#include "report/facts.hpp"
#include "report/packed.hpp"
#include "report/ticks.hpp"
#include "report/view.hpp"

namespace riven {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::json;

constexpr std::string_view kDataBegin = "<script id=\"riven-data\" type=\"application/json\">";
constexpr std::string_view kNoData = "{}</script>";
constexpr const char* kTemplate = "web/dist/report.html";

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The page before and behind its data.
std::pair<std::string_view, std::string_view> halves() {
  for (const EmbeddedFile& file : embedded_files()) {
    if (file.path != kTemplate) continue;
    const std::string marker = std::string(kDataBegin) + std::string(kNoData);
    const std::size_t at = file.text.find(marker);
    if (at == std::string_view::npos || file.text.find(marker, at + 1) != std::string_view::npos) break;
    const std::size_t data = at + kDataBegin.size();
    return {file.text.substr(0, data), file.text.substr(data + 2)};
  }
  throw std::logic_error(fmt::format("{} has no single place for the data", kTemplate));
}

Json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json colour_maps_json() {
  Json maps = Json::array();
  for (const ColourMap& map : colour_maps())
    maps.push_back({{"name", map.name},
                    {"label", map.label},
                    {"anchors", std::vector<Colour>(map.anchors.begin(), map.anchors.end())},
                    {"diverging", map.diverging}});
  return maps;
}

Json facts_json(const Result& result) {
  Json facts = Json::array();
  for (const Fact& fact : facts_of(result)) facts.push_back({{"label", fact.label}, {"value", fact.value}});
  return facts;
}

Json metrics_json(const Result& result) {
  Json metrics = Json::array();
  if (result.summary)
    for (const auto& [name, metric] : result.summary->metrics)
      metrics.push_back({{"name", name}, {"value", number(metric.value)}, {"unit", metric.unit}});
  return metrics;
}

Json verdicts_json(const std::vector<Verdict>& rows) {
  Json verdicts = Json::array();
  for (const Verdict& row : rows)
    verdicts.push_back({{"what", row.what},
                        {"unit", row.unit},
                        {"at", row.at},
                        {"kind", row.published ? "published" : "reference"},
                        {"expected", number(row.expected)},
                        {"ours", number(row.ours)},
                        {"deviation", number(row.deviation)},
                        {"limit", row.limit},
                        {"verdict", outcome(row)},
                        {"source", row.source}});
  return verdicts;
}

/// A column of a CSV file of Riven: "force [N]".
Json column_json(const std::string& column) {
  const auto [name, unit] = name_and_unit(column);
  return {{"name", name}, {"unit", unit}};
}

/// `most`: numbers at most; of a longer history evenly spaced rows are taken, and a note says so.
Json history_json(const std::string& name, const History& history, std::size_t most,
                  std::vector<std::string>& notes) {
  const std::size_t columns = history.columns().size(), all = history.parameter().size();
  const std::size_t rows = std::min(all, std::max<std::size_t>(2, most / columns));
  const std::vector<std::size_t> chosen = evenly_spaced(rows, all);
  Json described = Json::array();
  std::vector<double> values;
  for (const std::string& column : history.columns()) {
    described.push_back(column_json(column));
    const std::vector<double> numbers = history.column(column);
    for (const std::size_t row : chosen) values.push_back(numbers[row]);
  }
  if (rows < all)
    notes.push_back(
        fmt::format("{} of {} rows of {}.csv are shown: the first, the last and evenly spaced ones.",
                    grouped(static_cast<std::int64_t>(rows)), grouped(static_cast<std::int64_t>(all)), name));
  return {{"name", name}, {"columns", described}, {"rows", rows}, {"values", packed(values)}};
}

Json histories_json(ReportItem& item, std::size_t most) {
  Json histories = Json::array();
  for (const auto& [name, history] :
       {std::pair{"history", &item.result.history}, {"energy", &item.result.energy}})
    if (*history && !(*history)->parameter().empty())
      histories.push_back(history_json(name, **history, most, item.notes));
  return histories;
}

std::string last_lines(const std::string& text, int lines) {
  std::size_t at = text.size();
  for (int line = 0; line <= lines && at != std::string::npos; ++line)
    at = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  return at == std::string::npos ? text : text.substr(at + 1);
}

/// All of a result but its fields.
Json result_json(ReportItem& item, const std::string& unique_name, std::size_t most_numbers) {
  constexpr int kLogLines = 200;
  const Result& result = item.result;
  const ResultFolder files = ResultFolder::open(result.folder);
  return {{"name", unique_name},
          {"title", result.title},
          {"status", status_of(result)},
          {"parameter", {{"name", name(result.parameter())}, {"unit", unit(result.parameter())}}},
          {"facts", facts_json(result)},
          {"metrics", metrics_json(result)},
          {"histories", histories_json(item, most_numbers)},
          {"verdicts", verdicts_json(item.verdicts)},
          {"case_text", contents(files.case_file())},
          {"resolved_text", contents(files.resolved())},
          {"log_text", last_lines(contents(files.log()), kLogLines)},
          {"view", nullptr}};
}

/// Names of the cases; where they are equal, folders.
std::vector<std::string> unique_names(const std::vector<ReportItem>& items) {
  std::map<std::string, int> uses;
  for (const ReportItem& item : items) ++uses[item.result.name()];
  std::vector<std::string> names;
  for (const ReportItem& item : items) {
    const std::string name = item.result.name();
    names.push_back(uses[name] == 1 ? name : item.result.folder.string());
  }
  return names;
}

/// What `work` gives, without the states that turn out to be unusable; `none` when no state is left.
template <class Value, class Work>
Value of_usable_states(ReportItem& item, Value none, const Work& work) {
  while (!item.result.states.empty()) {
    try {
      return work();
    } catch (const UnusableState& problem) {
      item.notes.push_back(fmt::format("The state at {:.6g} is left out: {}.",
                                       item.result.states[problem.state].value, problem.what()));
      item.result.states.erase(item.result.states.begin() + static_cast<std::ptrdiff_t>(problem.state));
    }
  }
  return none;
}

/// Puts the fields of all results into what they leave of the page.
void add_views(Json& page, std::vector<ReportItem>& items, double room) {
  constexpr double kMargin = 1.1;  // a need is an estimate
  std::vector<ViewSize> sizes;
  std::vector<double> needs;
  for (ReportItem& item : items) {
    sizes.push_back(of_usable_states(item, ViewSize(), [&] { return measured(item.result); }));
    needs.push_back(kMargin * sizes.back().bytes(sizes.back().all));
  }
  const std::vector<double> parts = shares(needs, room);
  for (std::size_t n = 0; n < items.size(); ++n)
    page["results"][n]["view"] = of_usable_states(items[n], Json(), [&] {
      sizes[n].all.states = items[n].result.states.size();
      return view(items[n].result, sizes[n], parts[n], items[n].notes);
    });
}

Json page_json(std::vector<ReportItem>& items, double largest) {
  constexpr double kHistoryPart = 0.2;                        // of the page, for all histories
  constexpr double kBytesOfNumber = sizeof(double) * 4 / 3.;  // at most
  constexpr double kNotes = 1000;                             // bytes kept for what is said about a result
  const double histories = 2 * static_cast<double>(items.size());
  const auto most = static_cast<std::size_t>(kHistoryPart * largest / kBytesOfNumber / histories);
  Json page = {{"format", 1},
               {"program", "Riven " + this_program()},
               {"written", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
               {"colour_maps", colour_maps_json()},
               {"results", Json::array()}};
  const std::vector<std::string> names = unique_names(items);
  for (std::size_t n = 0; n < items.size(); ++n)
    page["results"].push_back(result_json(items[n], names[n], most));
  const double rest =
      static_cast<double>(json_text(page).size()) + kNotes * static_cast<double>(items.size());
  add_views(page, items, largest - rest);
  for (std::size_t n = 0; n < items.size(); ++n) page["results"][n]["notes"] = items[n].notes;
  return page;
}

}  // namespace

void write_page(const fs::path& file, std::vector<ReportItem>& items, double largest) {
  AtomicFile target(file);  // what cannot be written is found before the work
  const auto [before, behind] = halves();
  const double room = largest - static_cast<double>(before.size() + behind.size());
  const std::string data = json_text(page_json(items, room));
  if (static_cast<double>(data.size()) > room)
    throw InputError(
        fmt::format("{} results do not fit a page of {}; expected fewer", items.size(), bytes_text(largest)));
  target.stream() << before << data << behind;
  target.commit();
}

bool is_page(const fs::path& file) {
  return fs::is_regular_file(file) && contents(file).find(kDataBegin) != std::string::npos;
}

}  // namespace riven
