#pragma once

#include "input/format.hpp"

namespace riven {

/// [set.NAME]. Places of random shapes are found when the keys have been read.
Format describe(SetInput& set, const Case& c);

/// All shapes whose points belong to the set; none for a set by formula or group.
std::vector<TurnedShape> shapes_of(const SetInput& set);

}  // namespace riven
