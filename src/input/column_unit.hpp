#pragma once

#include <optional>
#include <string>

#include "base/error.hpp"
#include "input/units.hpp"

namespace riven {

/// The unit in the brackets that end the name of a CSV column: "x [mm]", "[1/s]", and plain numbers under
/// "[-]" or
/// "[1]"; nothing without brackets. Throws
/// InputError at `header` for a unit that Riven does not know.
std::optional<Unit> column_unit(const std::string& column, const Location& header);

}  // namespace riven
