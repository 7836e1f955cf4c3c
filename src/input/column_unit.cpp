#include "input/column_unit.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "base/nearest_name.hpp"

namespace riven {

std::optional<Unit> column_unit(const std::string& column, const Location& header) {
  const std::size_t bracket = column.ends_with(']') ? column.rfind('[') : std::string::npos;
  if (bracket == std::string::npos) return std::nullopt;
  const std::string text = column.substr(bracket + 1, column.size() - bracket - 2);
  try {
    const auto match = match_unit(text, 0);
    if (match && match->length == text.size()) return match->unit;
  } catch (const std::invalid_argument& wrong) {
    throw InputError(header, fmt::format("column \"{}\": {}", column, wrong.what()));
  }
  throw InputError(header, fmt::format("column \"{}\": unknown unit \"{}\"; units are {}, and compounds such "
                                       "as mm^3{}",
                                       column, text, listed(unit_names()), did_you_mean(text, unit_names())));
}

}  // namespace riven
