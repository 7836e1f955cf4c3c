#pragma once

#include "input/format.hpp"

namespace riven {

/// The format of [table.NAME]; reads the file when the keys have been read. `c` tells where the case is.
Format describe(TableInput& table, const Case& c);

/// Fails unless formulas can use the name for a table or a field (`what`).
void check_formula_name(const std::string& name, const char* what, const Check& check);

}  // namespace riven
