#pragma once

#include "output/vtu.hpp"

namespace riven {

/// Cells in a plane as they are; of cells in space the sides that no other one shares, which is what can be
/// seen.
[[nodiscard]] std::vector<Cells> outer_sides(const std::vector<Cells>& cells);

}  // namespace riven
