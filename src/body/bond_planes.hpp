#pragma once

#include <cstdint>
#include <vector>

#include "base/lanes.hpp"
#include "body/stencil.hpp"

namespace riven {

/// Which bonds of a lattice body exist: for each offset of the stencil one bit per point, contiguous along a
/// row, so that one byte is the mask of one vector of points.
class BondPlanes {
 public:
  BondPlanes() = default;
  BondPlanes(std::size_t offsets, std::size_t points)
      : planes_(offsets, std::vector<std::uint8_t>(points / kLanes)) {}

  [[nodiscard]] bool exists(std::size_t offset, std::size_t point) const {
    return ((planes_[offset][point / kLanes] >> (point % kLanes)) & 1U) != 0;
  }
  /// Bits of the points [8 block, 8 block + 8).
  [[nodiscard]] std::uint8_t mask(std::size_t offset, std::size_t block) const {
    return planes_[offset][block];
  }

  /// Joins a point and its neighbour, seen from both ends.
  void join(const Stencil& stencil, std::size_t offset, std::size_t point) {
    bit(offset, point, true);
    bit(stencil.opposite[offset], neighbour(stencil, offset, point), true);
  }
  /// Cuts a bond at both ends.
  void cut(const Stencil& stencil, std::size_t offset, std::size_t point) {
    bit(offset, point, false);
    bit(stencil.opposite[offset], neighbour(stencil, offset, point), false);
  }

  static std::size_t neighbour(const Stencil& stencil, std::size_t offset, std::size_t point) {
    return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(point) + stencil.shift[offset]);
  }

 private:
  void bit(std::size_t offset, std::size_t point, bool value) {
    std::uint8_t& byte = planes_[offset][point / kLanes];
    const auto flag = static_cast<std::uint8_t>(1U << (point % kLanes));
    byte = static_cast<std::uint8_t>(value ? byte | flag : byte & ~flag);
  }

  std::vector<std::vector<std::uint8_t>> planes_;
};

}  // namespace riven
