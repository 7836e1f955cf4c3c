#pragma once

#include "input/format.hpp"

namespace riven {

/// The format of [table.NAME]; reads the file when the keys have been read. `c` tells where the case is.
Format describe(TableInput& table, const Case& c);

}  // namespace riven
