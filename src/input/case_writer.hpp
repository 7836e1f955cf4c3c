#pragma once

#include <string>

#include "input/case.hpp"

namespace riven {

/// The case as TOML that reads back to the same values: every key with its default, in SI units.
std::string resolved_case(const Case& of);

}  // namespace riven
