#pragma once

#include "simulation/simulation.hpp"

namespace riven {

/// Rigid motions of the whole body that the loads of a static run leave free, in words; nothing if it is
/// held.
[[nodiscard]] std::optional<std::string> free_motion(const Simulation& simulation);

}  // namespace riven
