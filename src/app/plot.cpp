#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "app/commands.hpp"
#include "base/error.hpp"
#include "input/formula.hpp"
#include "report/chart.hpp"
#include "report/picture.hpp"
#include "report/projection.hpp"
#include "report/result.hpp"
#include "report/what_to_show.hpp"

namespace riven::app {

namespace fs = std::filesystem;

namespace {

/// Numbers of the states that are asked for.
std::vector<std::size_t> chosen_states(const std::string& text, std::size_t count) {
  std::vector<std::size_t> chosen;
  if (text == "all")
    for (std::size_t n = 0; n < count; ++n) chosen.push_back(n);
  if (text == "all") return chosen;
  const auto states = static_cast<long>(count);
  long number = text == "first" ? 0 : -1;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  const bool is_word = text == "first" || text == "last";
  if (!is_word && (read.ec != std::errc{} || read.ptr != end))
    throw InputError(fmt::format("--state {}: expected a number, first, last or all", text));
  if (number < -states || number >= states)
    throw InputError(fmt::format("--state {}: the result has {} states; expected 0 to {}, or -{} to -1", text,
                                 states, states - 1, states));
  return {static_cast<std::size_t>(number < 0 ? number + states : number)};
}

/// A value of a range in SI; a plain number is one already.
double range_value(const std::string& text, const Scalar& scalar) {
  const Quantity value = parse_quantity(text, Symbols{}, Origin{"--range", {}});
  const auto unit = match_unit(scalar.unit, 0);
  if (value.dimension != dimension::none && (!unit || unit->unit.dimension != value.dimension))
    throw InputError(fmt::format("--range {}: {} is in {}; found {}", text, scalar.label,
                                 scalar.unit.empty() ? "no unit" : scalar.unit, named(value.dimension)));
  return value.si;
}

Range read_range(const std::string& text, const Scalar& scalar) {
  const std::vector<std::string> ends = split_at_commas(text);
  if (ends.size() != 2)
    throw InputError(fmt::format("--range {}: expected two values, as in 0,1 or \"0, 2 MPa\"", text));
  const Range range{range_value(ends[0], scalar), range_value(ends[1], scalar)};
  if (!(range.low < range.high) || !std::isfinite(range.width()))
    throw InputError(fmt::format("--range {}: expected the lower value first", text));
  return range;
}

/// One of several pictures: "film.png" -> "film-0003.png".
fs::path numbered(const fs::path& path, std::size_t number) {
  fs::path file = path.stem();
  file += fmt::format("-{:04}", number);
  file += path.extension();
  return path.parent_path() / file;
}

PictureSize size_of(const PlotOptions& options) {
  return options.size.empty() ? PictureSize{} : picture_size(options.size);
}

int tell(const fs::path& path, const std::string& picture) {
  write_picture(path, picture);
  fmt::print("{}\n", path.string());
  return kDone;
}

PictureSettings settings_of(const PlotOptions& options, const Result& result) {
  if (!std::isfinite(options.scale)) throw InputError("--scale: expected a finite number");
  return {.size = size_of(options),
          .trimmed = options.size.empty(),
          .map = options.map.empty() ? nullptr : &colour_map(options.map),
          .scale = options.scale,
          .title = result.title.empty() ? result.name() : result.title};
}

/// Pictures that are looked at in turn show the same colours and the same part of the plane.
void unify(PictureSettings& settings, const Result& result, const std::vector<std::size_t>& states,
           const std::string& field) {
  Range values;
  for (const std::size_t n : states) {
    const PointCloud cloud = read_vtu(result.states[n].file);
    const bool is_curve = Projection(cloud.positions).dimension() == 1;
    values.include(colour_range(scalar_of(cloud, field), is_curve));
    settings.frame.include(frame_of(cloud, settings.scale));
  }
  if (settings.values.empty()) settings.values = values;
}

int plot_fields(const PlotOptions& options, const Result& result) {
  if (result.states.empty())
    throw InputError(fmt::format("{}: the result has no field files; expected a run that reached a state",
                                 options.folder.string()));
  const std::vector<std::size_t> states = chosen_states(options.state, result.states.size());
  PictureSettings settings = settings_of(options, result);
  const PointCloud last = read_vtu(result.states[states.back()].file);
  const std::string field =
      options.field.empty() ? telling_field(last, read_vtu(result.states.front().file)) : options.field;
  const Scalar scalar = scalar_of(last, field);
  if (!options.range.empty()) settings.values = read_range(options.range, scalar);
  const bool single = options.state != "all";
  if (!single) unify(settings, result, states, field);
  const fs::path base = options.output.empty() ? options.folder / (field + ".png") : options.output;
  for (const std::size_t n : states) {
    const PointCloud cloud = read_vtu(result.states[n].file);
    settings.state = state_text(result, n);
    const fs::path path = single && !options.output.empty() ? base : numbered(base, n);
    tell(path, draw_field(cloud, scalar_of(cloud, field), settings, path));
  }
  return kDone;
}

int plot_history(const PlotOptions& options, const Result& result) {
  if (!result.history)
    throw InputError(fmt::format("{}: the result has no history.csv", options.folder.string()));
  const History& history = *result.history;
  const auto [abscissa, abscissa_unit] = name_and_unit(history.columns().front());
  Chart chart{.title = result.title, .x = {abscissa, abscissa_unit}};
  std::string file = "history";
  for (const std::string& asked : split_at_commas(options.history)) {
    const auto [column, unit] = name_and_unit(history.column_name(asked));
    if (chart.series.empty()) chart.y = {column, unit};
    if (unit != chart.y.unit)
      throw InputError(fmt::format("--history {}: {} is in {}, {} in {}; expected columns of one unit",
                                   options.history, chart.series.front().name,
                                   chart.y.unit.empty() ? "no unit" : chart.y.unit, column,
                                   unit.empty() ? "no unit" : unit));
    chart.series.push_back({column, history.parameter(), history.column(asked)});
    file.append("-").append(file_word(column));
  }
  if (chart.series.size() > 1) chart.y.name = "";
  const fs::path path = options.output.empty() ? options.folder / (file + ".png") : options.output;
  return tell(path, draw_chart(chart, size_of(options), path));
}

}  // namespace

int plot(const PlotOptions& options) {
  const Result result = Result::open(options.folder);
  return options.history.empty() ? plot_fields(options, result) : plot_history(options, result);
}

}  // namespace riven::app
