#include "report/view.hpp"
#include "report/outer_sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/error.hpp"
#include "base/text.hpp"
#include "report/packed.hpp"
#include "report/what_to_show.hpp"

namespace riven {

namespace {

using Json = nlohmann::json;

bool same_layout(const PointCloud& a, const PointCloud& b) {
  const auto same = [](const PointField& f, const PointField& g) {
    return f.name == g.name && f.components == g.components;
  };
  return a.positions.size() == b.positions.size() &&
         std::equal(a.fields.begin(), a.fields.end(), b.fields.begin(), b.fields.end(), same);
}

/// States of a result, displacements first. All have the points and fields of the one that was read first.
class States {
 public:
  explicit States(const Result& result) : result_(result) {}

  /// Throws UnusableState.
  PointCloud read(std::size_t state) {
    try {
      return read_one(state);
    } catch (const InputError& problem) {
      throw UnusableState(state, problem.what());
    }
  }

 private:
  PointCloud read_one(std::size_t state) {
    const std::filesystem::path& file = result_.states[state].file;
    PointCloud cloud = read_vtu(file);
    std::stable_partition(cloud.fields.begin(), cloud.fields.end(),
                          [](const PointField& field) { return field.name == "displacement"; });
    for (const PointField& field : cloud.fields)
      if (field.components != 1 && field.components != 3 && field.components != 9)
        throw InputError({file.string()}, fmt::format("field \"{}\" has {} components; expected 1, 3 or 9",
                                                      field.name, field.components));
    if (layout_.positions.empty()) {
      layout_.positions = cloud.positions;
      for (const PointField& field : cloud.fields)
        layout_.fields.push_back({field.name, field.components, {}});
    }
    if (!same_layout(cloud, layout_))
      throw InputError({file.string()}, "has other points or fields than the other states of the result");
    return cloud;
  }

  const Result& result_;
  PointCloud layout_;
};

std::vector<std::size_t> all_of(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return numbers;
}

Json packed_positions(const PointCloud& cloud, const std::vector<std::size_t>& points) {
  std::vector<float> values;
  for (const std::size_t i : points)
    for (const double x : cloud.positions[i]) values.push_back(static_cast<float>(x));
  return packed(values);
}

Json packed_fields(const PointCloud& cloud, const std::vector<std::size_t>& points) {
  std::vector<Json> arrays(cloud.fields.size());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t f = 0; f < arrays.size(); ++f) {
    const PointField& field = cloud.fields[f];
    const auto width = static_cast<std::size_t>(field.components);
    std::vector<float> values;
    values.reserve(points.size() * width);
    for (const std::size_t i : points)
      for (std::size_t c = 0; c < width; ++c)
        values.push_back(static_cast<float>(field.values[i * width + c]));
    arrays[f] = packed(values);
  }
  return arrays;
}

Json packed_cells(const PointCloud& cloud) {
  Json cells = Json::array();
  for (const Cells& one : outer_sides(cloud.cells))
    cells.push_back({{"kind", name(one.kind)}, {"nodes", packed(one.nodes)}});
  return cells;
}

bool is_flat(const PointCloud& cloud) {
  const auto in_plane = [](const auto& position) { return position[2] == 0; };
  if (!std::all_of(cloud.positions.begin(), cloud.positions.end(), in_plane)) return false;
  if (cloud.fields.empty() || cloud.fields.front().name != "displacement") return true;
  const std::vector<double>& u = cloud.fields.front().values;
  for (std::size_t z = 2; z < u.size(); z += 3)
    if (std::abs(u[z]) > 0) return false;  // not so for NaN
  return true;
}

Json described_fields(const PointCloud& cloud) {
  Json fields = Json::array();
  for (const PointField& field : cloud.fields)
    fields.push_back({{"name", field.name}, {"unit", field.unit}, {"components", field.components}});
  return fields;
}

double bytes_of(const Json& json) {
  return static_cast<double>(json_text(json).size());
}

/// A few of the states that speak for all; not the first one, at rest, whose zeros take no room.
std::vector<std::size_t> sample_states(std::size_t all) {
  constexpr std::size_t kMost = 4;
  std::vector<std::size_t> states = evenly_spaced(std::min(kMost, all), all);
  if (states.size() == kMost) states.erase(states.begin());
  return states;
}

/// What a page shows of a result.
struct Choice {
  std::vector<std::size_t> states;
  Selection points;
};

Choice choose(const Result& result, States& states, const ViewSize& size, double budget) {
  const Extent fit = fitting(size, budget);
  if (fit.states == 0 || fit.points == 0)
    throw InputError(
        fmt::format("{}: {} points{} take more than the {} that a page has left for them; expected a "
                    "smaller result, or fewer in one page",
                    result.folder.string(), grouped(static_cast<std::int64_t>(size.all.points)),
                    size.mesh ? " of a mesh" : "", bytes_text(std::max(0.0, budget))));
  Choice choice{evenly_spaced(fit.states, size.all.states), {all_of(size.all.points), result.spacing}};
  if (fit.points < size.all.points)
    choice.points = thinned(states.read(choice.states.front()).positions, result.spacing, fit.points);
  return choice;
}

/// Only what `telling_field` asks of a first state.
PointCloud damage_of(const PointCloud& cloud) {
  PointCloud damage;
  if (const PointField* field = find_field(cloud, "damage")) damage.fields.push_back(*field);
  return damage;
}

Json pack(const Result& result, States& states, const Choice& choice) {
  Json view = {
      {"points", choice.points.points.size()}, {"spacing", choice.points.cell}, {"states", Json::array()}};
  bool flat = true;
  PointCloud first;
  for (const std::size_t state : choice.states) {
    const PointCloud cloud = states.read(state);
    if (view["states"].empty()) {
      view["points_of"] = cloud.positions.size();
      view["positions"] = packed_positions(cloud, choice.points.points);
      view["cells"] = packed_cells(cloud);
      view["fields"] = described_fields(cloud);
      first = damage_of(cloud);
    }
    if (state == choice.states.back() && !cloud.fields.empty()) view["field"] = telling_field(cloud, first);
    flat = flat && is_flat(cloud);
    view["states"].push_back(
        {{"value", result.states[state].value}, {"values", packed_fields(cloud, choice.points.points)}});
  }
  view["dimension"] = flat ? 2 : 3;
  return view;
}

/// "2.5 mm"
std::string length_text(double length) {
  for (const auto& [unit, size] : {std::pair{"m", 1.0}, {"mm", 1e-3}, {"um", 1e-6}})
    if (length >= size) return fmt::format("{:.3g} {}", length / size, unit);
  return fmt::format("{:.3g} nm", length * 1e9);
}

void tell(const Choice& choice, const Extent& all, std::vector<std::string>& notes) {
  const auto number = [](std::size_t count) { return grouped(static_cast<std::int64_t>(count)); };
  if (choice.states.size() < all.states)
    notes.push_back(fmt::format(
        "{} of {} states are shown: {}.", number(choice.states.size()), number(all.states),
        choice.states.size() == 1 ? "the last one" : "the first, the last and evenly spaced ones"));
  if (choice.points.points.size() < all.points)
    notes.push_back(fmt::format("{} of {} points are shown: one per cell of {}.",
                                number(choice.points.points.size()), number(all.points),
                                length_text(choice.points.cell)));
}

}  // namespace

ViewSize measured(const Result& result) {
  constexpr std::size_t kSamplePoints = 100000;
  ViewSize size{.all = {result.states.size(), 0}};
  States states(result);
  const std::vector<std::size_t> sample = sample_states(size.all.states);
  for (const std::size_t state : sample) {
    const PointCloud cloud = states.read(state);
    size.all.points = cloud.positions.size();
    size.mesh = !cloud.cells.empty();
    // Points apart from each other agree in fewer bytes, as those of a thinned cloud do.
    const auto some = evenly_spaced(std::min(kSamplePoints, size.all.points), size.all.points);
    const double points = std::max(1.0, static_cast<double>(some.size()));
    size.fixed = bytes_of(packed_cells(cloud)) + bytes_of(described_fields(cloud));
    size.per_point = bytes_of(packed_positions(cloud, some)) / points;
    size.per_value += bytes_of(packed_fields(cloud, some)) / points / static_cast<double>(sample.size());
  }
  return size;
}

Json view(const Result& result, const ViewSize& size, double budget, std::vector<std::string>& notes) {
  States states(result);
  // Samples may mislead: the next attempt aims as much lower as the last one came out too large.
  for (double aim = budget;;) {
    const Choice choice = choose(result, states, size, aim);
    Json view = pack(result, states, choice);
    const double bytes = bytes_of(view);
    if (bytes <= budget) {
      tell(choice, size.all, notes);
      return view;
    }
    constexpr double kMargin = 0.98;
    aim *= kMargin * budget / bytes;
  }
}

}  // namespace riven
