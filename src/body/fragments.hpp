#pragma once

#include <cstdint>
#include <vector>

#include "body/body.hpp"

namespace riven {

/// The parts into which a body has come apart: points that existing bonds connect, directly or by way of
/// others, a rigid inclusion and all that is bonded to it among them. A bond to a ghost connects nothing:
/// what is behind a mirrored face is the same part seen twice.
struct Fragments {
  std::vector<std::uint32_t> number;  // of the body's points in their order, then of each inclusion; from 1
  std::vector<std::size_t> points;    // of fragment 1, 2, ...: never more than the one before

  /// Fragments that have so many points or more.
  [[nodiscard]] int count(std::size_t least) const;
};

/// Numbers fragments by their size, the largest first, and equal ones by their first point.
Fragments find_fragments(const Body& body);

}  // namespace riven
