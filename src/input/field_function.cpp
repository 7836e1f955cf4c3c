#include "input/field_function.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "base/csv.hpp"
#include "base/error.hpp"
#include "base/nearest_name.hpp"

namespace riven {
namespace {

constexpr std::string_view kAxisNames = "xyz";

// Of the reach: an edge is half a spacing from the points of a lattice, and rows are written with few digits.
constexpr double kSlack = 0.01;

double away_from_zero(const std::vector<double>& values) {
  double size = 0;
  for (const double value : values) size = std::max(size, std::abs(value));
  return size > 0 ? 0.37 * size : 1;
}

void check_axes(const CsvTable& csv, int dimension) {
  for (const char axis : kAxisNames.substr(static_cast<std::size_t>(dimension)))
    if (csv.find(std::string(1, axis)))
      throw InputError(
          {csv.file(), csv.header_line()},
          fmt::format("found a column \"{}\"; the body has {} only", axis, dimension == 2 ? "x and y" : "x"));
}

/// The column of values: the one named, or the only one besides the places.
std::size_t value_column(const CsvTable& csv, const std::string& name) {
  std::vector<std::size_t> values;
  for (std::size_t column = 0; column < csv.columns().size(); ++column) {
    const std::string bare = without_unit(csv.columns()[column]);
    if (bare.size() != 1 || kAxisNames.find(bare) == std::string_view::npos) values.push_back(column);
  }
  if (name.empty() && values.size() == 1) return values.front();
  if (!name.empty()) {
    const std::size_t named = csv.column(name);
    if (std::find(values.begin(), values.end(), named) != values.end()) return named;
  }
  throw InputError(
      {csv.file(), csv.header_line()},
      fmt::format("found the columns {}; expected one of values beside the places, or `value` in the case "
                  "to say which of several",
                  listed(csv.columns())));
}

}  // namespace

FieldFunction::FieldFunction(std::string name, PointList places, TableFunction::Column value, double spacing)
    : name_(std::move(name)),
      places_(std::move(places)),
      value_(std::move(value)),
      reach_(0.5 * spacing),
      stand_in_(away_from_zero(value_.values)),
      cubes_(places_.position, places_.dimension, (1 + kSlack) * reach_) {}

std::optional<double> FieldFunction::at(const Point& x) const {
  std::optional<std::size_t> nearest;
  double least = 0;
  for (const std::size_t n : cubes_.within(x, (1 + kSlack) * reach_)) {
    const Point& place = places_.position[n];
    const double distance = std::hypot(place[0] - x[0], place[1] - x[1], place[2] - x[2]);
    if (nearest && distance >= least) continue;
    nearest = n;
    least = distance;
  }
  if (!nearest) return std::nullopt;
  return value_.values[*nearest];
}

std::shared_ptr<const FieldFunction> read_field(const std::string& name, const std::filesystem::path& file,
                                                const std::string& value, int dimension, double spacing) {
  const CsvTable csv = CsvTable::read(file);
  if (csv.rows() == 0)
    throw InputError({csv.file(), csv.header_line()},
                     "found no row below the column names; expected one at least");
  check_axes(csv, dimension);
  PointList places = read_places(csv, dimension);
  check_apart(places, spacing);
  return std::make_shared<const FieldFunction>(name, std::move(places),
                                               read_value_column(csv, value_column(csv, value)), spacing);
}

}  // namespace riven
