#pragma once

#include "input/format.hpp"

namespace riven {

/// The keys disc, box and ball of a hole, an inclusion or a set.
std::vector<Key> shape_keys(std::optional<Shape>& shape);

/// [geometry]
Format describe_geometry(Case& c);

}  // namespace riven
