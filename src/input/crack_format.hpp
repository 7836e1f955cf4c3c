#pragma once

#include "input/format.hpp"

namespace riven {

/// [[crack]]
Format describe_crack(CrackInput& crack, const Case& c);

}  // namespace riven
