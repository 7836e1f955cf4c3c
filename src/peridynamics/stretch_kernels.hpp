#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "body/bond_planes.hpp"

namespace riven {

/// A bond of the stencil, as the kernels read it.
struct StretchBond {
  std::ptrdiff_t shift = 0;    // to the neighbour, in storage entries
  std::array<double, 3> xi{};  // m
  double length2 = 0;          // m^2
};

/// What the kernel sees of a body on a lattice and of its state.
struct StretchLattice {
  std::vector<StretchBond> stencil;
  const std::uint8_t* masks = nullptr;  // of all blocks: a byte per bond of the stencil
  const double* least_limit2 =
      nullptr;  // of a block's bonds: least squared ratio of lengths at which one breaks
  std::array<const double*, 3> u{};
  std::uint8_t* beyond = nullptr;  // per block: whether a bond is beyond that
};

/// Looks for long bonds in blocks [begin, end).
using FindLongBonds = void (*)(StretchLattice& on, std::size_t begin, std::size_t end);

/// The kernel of the instruction set in use.
FindLongBonds find_long_bonds(int dimension);

}  // namespace riven
