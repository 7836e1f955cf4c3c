#pragma once

#include <map>
#include <string>

#include "input/case.hpp"

namespace riven {

/// Every value of the resolved case as TOML, by its path as for --set: "load.0.displacement".
std::map<std::string, std::string> case_values(const Case& of);

}  // namespace riven
