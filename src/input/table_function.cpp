#include "input/table_function.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/csv.hpp"
#include "base/error.hpp"
#include "base/nearest_name.hpp"
#include "input/column_unit.hpp"

namespace riven {
namespace {

double largest(const std::vector<double>& values) {
  double size = 0;
  for (const double value : values) size = std::max(size, std::abs(value));
  return size > 0 ? size : 1;
}

// Where the unit of a column begins, with the blanks before its bracket; its length if it has none.
std::size_t unit_begin(const std::string& column) {
  const std::size_t bracket = column.ends_with(']') ? column.rfind('[') : std::string::npos;
  if (bracket == std::string::npos) return column.size();
  const std::size_t last = column.find_last_not_of(" \t", bracket == 0 ? 0 : bracket - 1);
  return last == std::string::npos || bracket == 0 ? 0 : last + 1;
}

void check_rising(const CsvTable& csv, std::size_t argument) {
  for (std::size_t row = 1; row < csv.rows(); ++row)
    if (!(csv.number(row, argument) > csv.number(row - 1, argument)))
      throw InputError(
          {csv.file(), csv.line(row)},
          fmt::format("column \"{}\": {:g} comes after {:g}; expected an argument that rises "
                      "from row to row",
                      csv.columns()[argument], csv.number(row, argument), csv.number(row - 1, argument)));
}

}  // namespace

TableFunction::TableFunction(std::string name, std::filesystem::path file, Column argument, Column value,
                             bool hold)
    : name_(std::move(name)),
      file_(std::move(file)),
      argument_(std::move(argument)),
      value_(std::move(value)),
      hold_(hold),
      argument_size_(largest(argument_.values)),
      value_size_(largest(value_.values)) {}

bool TableFunction::covers(double argument) const {
  const double first = argument_.values.front(), last = argument_.values.back();
  const double slack = 1e-9 * (last - first);
  return argument >= first - slack && argument <= last + slack;
}

double TableFunction::value(double argument, std::size_t& interval) const {
  const std::vector<double>&x = argument_.values, &y = value_.values;
  if (argument <= x.front()) return y.front();
  if (argument >= x.back()) return y.back();
  if (std::isnan(argument)) return argument;
  if (argument < x[interval] || argument >= x[interval + 1])
    interval = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), argument) - x.begin()) - 1;
  const double part = (argument - x[interval]) / (x[interval + 1] - x[interval]);
  return y[interval] + part * (y[interval + 1] - y[interval]);
}

double TableFunction::stand_in(double argument) const {
  return value_size_ * (0.3 + 0.1 * std::log1p(std::abs(argument) / argument_size_));
}

TableFunction::Column read_value_column(const CsvTable& csv, std::size_t index) {
  TableFunction::Column column{csv.columns()[index], {}, {}};
  const Unit unit = column_unit(column.name, {csv.file(), csv.header_line()}).value_or(Unit{});
  column.dimension = unit.dimension;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const double number = csv.number(row, index);
    if (!std::isfinite(number))
      throw InputError({csv.file(), csv.line(row)},
                       fmt::format("column \"{}\": found {}; expected a finite number", column.name, number));
    column.values.push_back(to_si(number, unit));
  }
  return column;
}

TableFunction read_table(const std::string& name, const std::filesystem::path& file,
                         const std::string& argument, const std::string& value, bool hold) {
  const CsvTable csv = CsvTable::read(file);
  const Location header{csv.file(), csv.header_line()};
  if (csv.columns().size() < 2)
    throw InputError(header, fmt::format("found one column, \"{}\"; expected an argument and a value, with "
                                         "a comma between them",
                                         csv.columns().front()));
  const std::size_t from = argument.empty() ? 0 : csv.column(argument);
  const std::size_t to = value.empty() ? 1 : csv.column(value);
  if (from == to)
    throw InputError(header,
                     fmt::format("column \"{}\" is both argument and value; expected two columns of {}",
                                 csv.columns()[from], listed(csv.columns())));
  if (csv.rows() < 2)
    throw InputError(header, fmt::format("found {} below the column names; expected two rows at least",
                                         csv.rows() == 0 ? "no row" : "one row"));
  TableFunction table(name, file, read_value_column(csv, from), read_value_column(csv, to), hold);
  check_rising(csv, from);
  return table;
}

std::string without_unit(const std::string& column) {
  return column.substr(0, unit_begin(column));
}

}  // namespace riven
