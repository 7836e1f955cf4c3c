#include "input/point_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>

#include "base/csv.hpp"
#include "geometry/cubes.hpp"
#include "input/column_unit.hpp"
#include "input/table_function.hpp"

namespace riven {
namespace {

constexpr double kSamePlace = 1e-6;  // of the spacing

std::string place_text(const PointList& points, std::size_t n) {
  const Point& x = points.position[n];
  return points.dimension == 3 ? fmt::format("({:.6g}, {:.6g}, {:.6g}) m", x[0], x[1], x[2])
                               : fmt::format("({:.6g}, {:.6g}) m", x[0], x[1]);
}

/// A column of a given dimension in SI; its unit must be there.
std::vector<double> read_column(const CsvTable& csv, std::size_t column, const Dimension& dimension) {
  const std::string& name = csv.columns()[column];
  const Location header{csv.file(), csv.header_line()};
  const auto unit = column_unit(name, header);
  const std::string usual = usual_unit(dimension).empty() ? si_unit(dimension) : usual_unit(dimension);
  if (!unit)
    throw InputError(
        header, fmt::format("column \"{0}\" has no unit; write it in brackets: \"{0} [{1}]\"", name, usual));
  if (unit->dimension != dimension)
    throw InputError(header, fmt::format("column \"{}\" is {}; expected {}, such as [{}]", name,
                                         named(unit->dimension), named(dimension), usual));
  return read_value_column(csv, column).values;
}

void read_volumes(const CsvTable& csv, double thickness, PointList& points) {
  const Location header{csv.file(), csv.header_line()};
  const auto volume = csv.find("volume"), area = csv.find("area");
  if (volume && area) throw InputError(header, "found the columns volume and area; expected one of them");
  if (area && points.dimension == 3)
    throw InputError(header, "the column area belongs to two dimensions; expected volume beside x, y, z");
  if (!volume && !area)
    throw InputError(header,
                     fmt::format("expected a column of what belongs to each point, \"volume [mm^3]\"{}",
                                 points.dimension == 2 ? " or \"area [mm^2]\"" : ""));
  const std::size_t column = volume.value_or(area.value_or(0));
  points.volume = read_column(csv, column, {.metre = volume ? 3 : 2});
  for (std::size_t n = 0; n < points.volume.size(); ++n) {
    if (!(points.volume[n] > 0))
      throw InputError(points.at(n), fmt::format("column \"{}\": found {:g}; expected a value above 0",
                                                 csv.columns()[column], csv.number(n, column)));
    if (area) points.volume[n] *= thickness;
  }
}

}  // namespace

double PointList::spacing(double thickness) const {
  const double sum = std::accumulate(volume.begin(), volume.end(), 0.0);
  return std::pow(sum / static_cast<double>(volume.size()) / thickness, 1.0 / dimension);
}

std::string PointList::label(std::size_t point) const {
  return of_mesh() ? fmt::format("element {}", element[point]) : fmt::format("line {}", line[point]);
}

Location PointList::at(std::size_t point) const {
  return of_mesh() ? Location{fmt::format("{}, {}", file, label(point))} : Location{file, line[point]};
}

PointList read_places(const CsvTable& csv, int dimension) {
  PointList points;
  points.file = csv.file();
  points.dimension = dimension;
  for (std::size_t n = 0; n < csv.rows(); ++n) points.line.push_back(csv.line(n));
  points.position.resize(csv.rows());
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimension); ++axis) {
    const std::string_view name = std::string_view("xyz").substr(axis, 1);
    const std::vector<double> values = read_column(csv, csv.column(name), dimension::length);
    for (std::size_t n = 0; n < values.size(); ++n) points.position[n][axis] = values[n];
  }
  return points;
}

PointList read_points(const std::filesystem::path& file, double thickness) {
  const CsvTable csv = CsvTable::read(file);
  const int dimension = csv.find("z") ? 3 : 2;
  const auto fewest = static_cast<std::size_t>(dimension) + 1;
  if (csv.rows() < fewest)
    throw InputError(Location{csv.file()},
                     fmt::format("found {} points; expected {} at least", csv.rows(), fewest));
  PointList points = read_places(csv, dimension);
  read_volumes(csv, thickness, points);
  return points;
}

void check_volumes(const PointList& points, double thickness) {
  constexpr double kImpossible = 4;  // the fewest points reach 1.8; units differ by 100 and more
  std::array<double, 3> extent{};
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(points.dimension); ++axis) {
    const auto [low, high] =
        std::minmax_element(points.position.begin(), points.position.end(),
                            [&](const Point& a, const Point& b) { return a[axis] < b[axis]; });
    extent[axis] = (*high)[axis] - (*low)[axis];
  }
  // Half a cell stands out on each side.
  const auto count = static_cast<double>(points.position.size());
  const double cell =
      *std::max_element(extent.begin(), extent.end()) / std::pow(count, 1.0 / points.dimension);
  double room = points.dimension == 2 ? thickness : 1;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(points.dimension); ++axis)
    room *= extent[axis] + cell;
  const double sum = std::accumulate(points.volume.begin(), points.volume.end(), 0.0);
  if (sum > kImpossible * room)
    throw InputError(
        Location{points.file},
        fmt::format("the volumes sum to {:.3g} m^3, and the points spread over {:.3g} m^3; is the unit "
                    "of the volumes right?",
                    sum, room));
}

void check_inside(const PointList& points, const Box& box, double spacing) {
  for (std::size_t n = 0; n < points.position.size(); ++n)
    if (signed_distance(box, points.position[n]) > kSamePlace * spacing)
      throw InputError(points.at(n),
                       fmt::format("the point at {} lies outside of the box; expected all points in it",
                                   place_text(points, n)));
}

void check_apart(const PointList& points, double spacing) {
  const Cubes cubes(points.position, points.dimension, spacing);
  for (std::size_t n = 0; n < points.position.size(); ++n) {
    const std::size_t first = cubes.within(points.position[n], kSamePlace * spacing).front();
    if (first != n)
      throw InputError(points.at(n),
                       fmt::format("the point at {} stands in {} already; expected each place once",
                                   place_text(points, n), points.label(first)));
  }
}

}  // namespace riven
