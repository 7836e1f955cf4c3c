#pragma once

#include "input/format.hpp"

namespace riven {

/// The format of [field.NAME]; reads the file when the keys have been read. `c` has the geometry by then.
Format describe(FieldInput& field, const Case& c);

}  // namespace riven
