#pragma once

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string_view>

#include "base/csv.hpp"
#include "base/error.hpp"

namespace riven {

/// The column of a reference file that tells its states apart, if it has one.
/// Throws InputError when it has several.
inline std::optional<std::size_t> state_column(const CsvTable& table) {
  constexpr std::array<std::string_view, 5> kNames{"lambda", "stretch", "t_s", "time", "cycle"};
  std::optional<std::size_t> found;
  for (const std::string_view name : kNames) {
    const auto column = table.find(name);
    if (column && found) {
      throw InputError(Location{table.file(), 0, 0},
                       fmt::format("expected one column of states, found \"{}\" and \"{}\"",
                                   table.columns()[*found], table.columns()[*column]));
    }
    if (column) found = column;
  }
  return found;
}

}  // namespace riven
