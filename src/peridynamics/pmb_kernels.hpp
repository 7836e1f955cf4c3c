#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "body/bond_planes.hpp"

namespace riven {

/// A bond of the stencil, as the kernels read it.
struct PmbBond {
  std::ptrdiff_t shift = 0;    // to the neighbour, in storage entries
  std::array<double, 3> xi{};  // m
  double length = 0;           // m
  double inverse_length = 0;   // 1/m
  double length2 = 0;          // m^2
};

/// What the kernels see of a body on a lattice and of its state. Points are taken in blocks of eight.
struct PmbLattice {
  std::vector<PmbBond> stencil;
  std::vector<BlockKind> blocks;
  const std::uint8_t* masks = nullptr;  // of all blocks: a byte per bond of the stencil
  const double* weight = nullptr;       // volume of a point, half of it for ghosts (m^3)
  double uniform_weight = 0;            // if it is the same for all points, else 0
  double stiffness = 0;                 // micromodulus c (N/m^6)
  // 1 / (2 c) of a point's material (m^6/N) where the body has several, else null: a bond's c is the harmonic
  // mean.
  const double* half_compliance = nullptr;
  const double* least_limit2 = nullptr;  // of a block: squared ratio of lengths that marks it; null: none
  std::uint8_t* beyond = nullptr;        // marks of the blocks
  std::array<const double*, 3> u{};
  std::array<double*, 3> out{};  // force (N), or bound of the stiffness (N/m)
};

/// A bond's other end in a list, side by side in one line of the cache.
struct alignas(64) PmbPoint {
  std::array<double, 3> x{};  // undeformed (m)
  double weight = 0;          // m^3
  std::array<double, 3> u{};  // m
  double half_compliance = 0;
};

/// The same for listed bonds.
struct PmbList {
  std::vector<PmbPoint> points;
  std::vector<double> inverse_length;        // of every bond (1/m)
  const std::size_t* begin = nullptr;        // bonds of point i: [begin[i], begin[i + 1])
  const std::uint32_t* neighbour = nullptr;  // readable eight entries beyond the last bond
  const std::uint8_t* masks = nullptr;       // those of point i start at byte begin[i] / 8 + i
  double stiffness = 0;
  bool mixed = false;  // bonds have the harmonic mean of their ends' c, else all have `stiffness`
  const double* least_limit2 = nullptr;
  std::uint8_t* beyond = nullptr;
  std::array<double*, 3> out{};
};

/// What the kernels do with points [begin, end), in whole blocks on a lattice. Each writes only its own
/// points; a bond gives the same to both of its ends, with the other sign, to the last bit.
struct PmbKernels {
  /// Forces; marks blocks or points of a list with long bonds.
  void (*lattice_force)(PmbLattice& on, std::size_t begin, std::size_t end);
  void (*listed_force)(PmbList& list, std::size_t begin, std::size_t end);
  /// Strain energy (J).
  double (*lattice_energy)(const PmbLattice& on, std::size_t begin, std::size_t end);
  double (*listed_energy)(const PmbList& list, std::size_t begin, std::size_t end);
  /// Bounds of the rows of the tangent stiffness.
  void (*lattice_bound)(const PmbLattice& on, std::size_t begin, std::size_t end);
  void (*listed_bound)(const PmbList& list, std::size_t begin, std::size_t end);
};

/// The kernels of the instruction set in use.
PmbKernels pmb_kernels(int dimension);

}  // namespace riven
