#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "body/bond_planes.hpp"
#include "peridynamics/bond_law.hpp"

namespace riven {

/// A bond of the stencil, as the kernels read it.
struct BondMembraneOffset {
  std::ptrdiff_t shift = 0;  // to the neighbour, in storage entries
  double x = 0, y = 0;       // m
  double inverse2 = 0;       // 1/length^2
  double stiffness = 0;      // 4 c0 delta / length^3 (N/m^7)
  double nx2 = 0, ny2 = 0;   // squared direction cosines
};

/// What the kernels see of a bond-based membrane on a lattice and of its state.
struct BondMembraneLattice {
  std::vector<BondMembraneOffset> stencil;
  std::vector<BlockKind> blocks;
  const std::uint8_t* masks = nullptr;  // of all blocks: a byte per bond of the stencil
  BondLaw law;
  std::array<const double*, 2> correction{};  // factors of the points
  const double* volume = nullptr;             // m^3
  const double* share = nullptr;              // of a bond's force that the point's entry gets
  std::array<const double*, 2> u{};
  std::array<double*, 2> force{};  // N
};

/// Forces on the points [begin, end), in whole blocks.
using BondMembraneKernel = void (*)(const BondMembraneLattice& on, std::size_t begin, std::size_t end);

/// The kernel of the instruction set in use.
BondMembraneKernel bond_membrane_kernel();

}  // namespace riven
