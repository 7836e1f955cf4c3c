#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/csv.hpp"
#include "base/error.hpp"
#include "input/column_unit.hpp"
#include "output/history.hpp"
#include "verification/compare.hpp"
#include "verification/deviation.hpp"
#include "verification/state_column.hpp"

namespace riven {
namespace {

struct Curve {
  std::string x_name, y_name;  // with their units
  std::vector<double> x;       // ascending
  std::vector<double> y;
};

/// What a number in a column of the reference is multiplied with to be in the unit of the history's column. A
/// column without a unit in brackets is taken as it is.
double factor_to(const std::string& ours, const CsvTable& reference, std::size_t column) {
  const Location header{reference.file(), reference.header_line()};
  const std::string& theirs = reference.columns()[column];
  const auto unit = column_unit(theirs, header);
  if (!unit) return 1;
  const Unit wanted = column_unit(ours, header).value_or(Unit{});  // SI
  if (unit->dimension != wanted.dimension)
    throw InputError(header, fmt::format("column \"{}\" is {}; expected {}, as \"{}\" of the history is",
                                         theirs, named(unit->dimension), named(wanted.dimension), ours));
  return unit->factor;
}

Curve read_curve(const std::filesystem::path& path, std::string_view metric) {
  const History history = History::read(path);
  Curve curve{history.columns().front(), history.column_name(metric), history.parameter(),
              history.column(metric)};
  if (std::is_sorted(curve.x.begin(), curve.x.end(), std::greater<>())) {
    std::reverse(curve.x.begin(), curve.x.end());
    std::reverse(curve.y.begin(), curve.y.end());
  }
  if (!std::is_sorted(curve.x.begin(), curve.x.end())) {
    throw InputError(
        Location{path.string(), 0, 0},
        fmt::format("expected a first column ({}) that only rises or only falls", history.columns()[0]));
  }
  return curve;
}

/// Linear between the rows; nothing beyond the ends, where rounding (1e-6 relative) is forgiven.
std::optional<double> value_at(const Curve& curve, double x) {
  if (curve.x.empty()) return std::nullopt;
  const double slack = 1e-6 * std::abs(x);
  if (x < curve.x.front() - slack || x > curve.x.back() + slack) return std::nullopt;
  const auto above = std::upper_bound(curve.x.begin(), curve.x.end(), x);
  if (above == curve.x.begin()) return curve.y.front();
  if (above == curve.x.end()) return curve.y.back();
  const auto i = static_cast<std::size_t>(above - curve.x.begin());
  const double part = (x - curve.x[i - 1]) / (curve.x[i] - curve.x[i - 1]);
  // At a row itself its neighbour must not count, not even as 0 * NaN.
  return part == 0 ? curve.y[i - 1] : curve.y[i - 1] + part * (curve.y[i] - curve.y[i - 1]);
}

}  // namespace

HistoryDeviation compare_history(const std::filesystem::path& history, const std::filesystem::path& reference,
                                 std::string_view metric, std::string_view column) {
  const Curve curve = read_curve(history, metric);
  const CsvTable table = CsvTable::read(reference);
  const std::size_t state = state_column(table).value_or(0);
  const std::size_t wanted = table.column(column);
  const double state_unit = factor_to(curve.x_name, table, state),
               unit = factor_to(curve.y_name, table, wanted);
  HistoryDeviation result;
  DeviationSum sum;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double x = state_unit * table.number(row, state);
    const double expected = unit * table.number(row, wanted);
    const auto found = value_at(curve, x);
    if (!found) {
      ++result.outside;
      continue;
    }
    ++result.used;
    if (sum.add(std::abs(*found - expected), std::abs(expected))) result.maximum_at = x;
  }
  if (result.used == 0) {
    throw InputError(Location{table.file(), 0, 0},
                     fmt::format("none of its {} rows lies within {}", table.rows(), history.string()));
  }
  result.relative_l2 = sum.relative_l2();
  result.maximum = sum.maximum();
  return result;
}

}  // namespace riven
