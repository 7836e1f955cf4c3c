#pragma once

#include "input/format.hpp"

namespace riven {

/// The keys disc, box and ball of a hole, an inclusion or a set.
std::vector<Key> shape_keys(std::optional<Shape>& shape);

/// A shape as it stands behind such a key.
Format describe_box(std::optional<Shape>& shape);
Format describe_round(std::optional<Shape>& shape, bool ball);

/// Fails for a ball unless the body has three dimensions.
void check_shape(const Shape& shape, const Case& c, const Check& check);

/// [geometry]
Format describe_geometry(Case& c);

}  // namespace riven
