#pragma once

#include "input/format.hpp"

namespace riven {

/// The format of `mesh` in [geometry]; reads the file when the keys have been read. `c` tells where the case
/// is.
Format describe_mesh(GeometryInput& geometry, const Case& c);

/// The same of `surface`.
Format describe_surface(GeometryInput& geometry, const Case& c);

}  // namespace riven
