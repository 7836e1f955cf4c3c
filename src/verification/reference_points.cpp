#include "verification/reference_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/csv.hpp"
#include "base/error.hpp"
#include "verification/state_column.hpp"

namespace riven {
namespace {

struct Axis {
  std::size_t position;      // column
  std::size_t displacement;  // column
};

std::vector<Axis> axes(const CsvTable& table) {
  constexpr std::array<std::pair<const char*, const char*>, 3> kNames{
      {{"X_m", "ux_m"}, {"Y_m", "uy_m"}, {"Z_m", "uz_m"}}};
  std::vector<Axis> found;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& [position, displacement] = kNames[k];
    if (k > 0 && !table.find(position) && !table.find(displacement)) break;
    found.push_back({table.column(position), table.column(displacement)});
  }
  return found;
}

double finite(const CsvTable& table, std::size_t row, std::size_t column) {
  const double value = table.number(row, column);
  if (std::isfinite(value)) return value;
  throw InputError(Location{table.file(), table.line(row), 0},
                   fmt::format("column \"{}\": expected a finite number", table.columns()[column]));
}

ReferenceState& state_of(std::vector<ReferenceState>& states, std::optional<double> value) {
  // Rows of a state mostly stand together: look at the last one first.
  const auto found =
      std::find_if(states.rbegin(), states.rend(), [&](const auto& s) { return s.value == value; });
  if (found != states.rend()) return *found;
  return states.emplace_back(ReferenceState{value, {}});
}

}  // namespace

ReferencePoints read_reference_points(const std::filesystem::path& path) {
  const CsvTable table = CsvTable::read(path);
  const auto columns = axes(table);
  const auto state = state_column(table);
  ReferencePoints reference;
  reference.file = path.string();
  reference.dimension = static_cast<int>(columns.size());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    ReferencePoint point;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      point.position[k] = finite(table, row, columns[k].position);
      point.displacement[k] = finite(table, row, columns[k].displacement);
    }
    const auto value = state ? std::optional(finite(table, row, *state)) : std::nullopt;
    state_of(reference.states, value).points.push_back(point);
  }
  if (reference.states.empty()) {
    throw InputError(Location{reference.file, 0, 0}, "expected reference points, found only column names");
  }
  return reference;
}

}  // namespace riven
