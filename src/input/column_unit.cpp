#include "input/column_unit.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "base/nearest_name.hpp"

namespace riven {

std::optional<Unit> column_unit(const std::string& column, const Location& header) {
  const std::size_t bracket = column.ends_with(']') ? column.rfind('[') : std::string::npos;
  if (bracket == std::string::npos) return std::nullopt;
  const std::string written = column.substr(bracket + 1, column.size() - bracket - 2);
  if (written.empty() || written == "-" || written == "1") return Unit{};
  const std::string text = written.starts_with("1/") ? written.substr(1) : written;
  try {
    const auto match = match_unit(text, 0);
    if (match && match->length == text.size()) return match->unit;
  } catch (const std::invalid_argument& wrong) {
    throw InputError(header, fmt::format("column \"{}\": {}", column, wrong.what()));
  }
  throw InputError(header,
                   fmt::format("column \"{}\": unknown unit \"{}\"; units are {}, and compounds such "
                               "as kg/m^3{}",
                               column, written, listed(unit_names()), did_you_mean(written, unit_names())));
}

}  // namespace riven
