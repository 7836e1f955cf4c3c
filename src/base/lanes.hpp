#pragma once

#include <cstddef>

namespace riven {

/// Points, or bonds, that kernels take at a time: a byte is their mask.
inline constexpr std::size_t kLanes = 8;

}  // namespace riven
