#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/lanes.hpp"
#include "body/stencil.hpp"

namespace riven {

/// Bonds of eight neighbouring points of a row.
enum class BlockKind : std::uint8_t {
  empty,  // no point has a bond
  partial,
  intact,  // all eight have all bonds of the stencil
};

/// Which bonds of a lattice body exist: for each offset of the stencil one bit per point. One byte is the
/// mask of one vector of points; the bytes of all offsets for the same vector lie side by side, so that a
/// kernel reads them as one stream and a row writes only its own.
class BondPlanes {
 public:
  BondPlanes() = default;
  BondPlanes(std::size_t offsets, std::size_t points)
      : offsets_(offsets), bytes_(offsets * (points / kLanes)) {}

  [[nodiscard]] bool exists(std::size_t offset, std::size_t point) const {
    return ((masks(point / kLanes)[offset] >> (point % kLanes)) & 1U) != 0;
  }
  /// For the points [8 block, 8 block + 8), a byte per offset.
  [[nodiscard]] const std::uint8_t* masks(std::size_t block) const {
    return bytes_.data() + offsets_ * block;
  }
  [[nodiscard]] std::uint8_t* masks(std::size_t block) { return bytes_.data() + offsets_ * block; }

  [[nodiscard]] BlockKind kind(std::size_t block) const {
    const std::uint8_t *first = masks(block), *last = first + offsets_;
    if (std::all_of(first, last, [](std::uint8_t mask) { return mask == 0; })) return BlockKind::empty;
    const bool whole = std::all_of(first, last, [](std::uint8_t mask) { return mask == 0xff; });
    return whole ? BlockKind::intact : BlockKind::partial;
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

  /// All bits: what a checkpoint keeps.
  [[nodiscard]] const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  [[nodiscard]] std::vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  void bit(std::size_t offset, std::size_t point, bool value) {
    std::uint8_t& byte = masks(point / kLanes)[offset];
    const auto flag = static_cast<std::uint8_t>(1U << (point % kLanes));
    byte = static_cast<std::uint8_t>(value ? byte | flag : byte & ~flag);
  }

  std::size_t offsets_ = 0;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace riven
