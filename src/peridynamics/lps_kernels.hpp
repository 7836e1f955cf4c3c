#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "body/bond_planes.hpp"

namespace riven {

/// A bond of the stencil, as the kernels read it.
struct LpsBond {
  std::ptrdiff_t shift = 0;    // to the neighbour, in storage entries
  std::array<double, 3> xi{};  // m
  double length = 0;           // m
  double weight = 0;           // omega
  double weight_length = 0;    // omega times length (m)
};

/// What the kernels see of a body on a lattice and of its state: `Lps` has the formulas. Points are taken in
/// blocks of eight.
struct LpsLattice {
  std::vector<LpsBond> stencil;
  std::vector<BlockKind> blocks;
  const std::uint8_t* masks = nullptr;     // of all blocks: a byte per bond of the stencil
  const double* volume = nullptr;          // of a point, for ghosts that of their master (m^3)
  double uniform_volume = 0;               // if it is the same for all points, else 0
  const double* inverse_moment = nullptr;  // c (1/m^5); 0 for points without a family of their own
  const double* kappa = nullptr;           // of a point's material (Pa)
  const double* straight = nullptr;        // c beta (Pa/m^5)
  double* tension = nullptr;               // q = c (kappa theta - beta), of one state
  std::array<const double*, 3> u{};
  // For the bound of the stiffness, with the gradients g of a family's dilatation to its points, G = sum|g|:
  double* grip = nullptr;        // kappa c G where kappa is positive, else 0
  double* own_grip = nullptr;    // kappa G |g| of the point itself
  std::array<double*, 3> out{};  // force (N), or bound of the stiffness (N/m)
};

/// A bond's other end in a list, side by side in one line of the cache.
struct alignas(64) LpsPoint {
  std::array<double, 3> x{};  // undeformed (m)
  double straight = 0;
  std::array<double, 3> u{};  // m
  double tension = 0;
};

/// The same for listed bonds.
struct LpsList {
  std::vector<LpsPoint> points;
  const double* volume = nullptr;
  const double* inverse_moment = nullptr;
  const double* kappa = nullptr;
  double* tension = nullptr;                 // copied into the points between the sweeps
  std::vector<double> weight;                // omega V of the other end, of every bond (m^3)
  std::vector<double> length;                // of every bond (m)
  const std::size_t* begin = nullptr;        // bonds of point i: [begin[i], begin[i + 1])
  const std::uint32_t* neighbour = nullptr;  // readable eight entries beyond the last bond
  const std::uint8_t* masks = nullptr;       // those of point i start at byte begin[i] / 8 + i
  double* grip = nullptr;
  double* own_grip = nullptr;
  std::array<double*, 3> out{};
};

/// What the kernels do with points [begin, end), in whole blocks on a lattice; each writes only its own
/// points.
template <class Bonds>
struct LpsSweeps {
  /// Tensions of the points, from their dilatations.
  void (*respond)(Bonds& on, std::size_t begin, std::size_t end);
  /// Forces, from the tensions at both ends of the bonds.
  void (*pull)(const Bonds& on, std::size_t begin, std::size_t end);
  /// Tensions and grips, then bounds of the rows of the tangent stiffness from both.
  void (*grip)(Bonds& on, std::size_t begin, std::size_t end);
  void (*bound)(const Bonds& on, std::size_t begin, std::size_t end);
  /// Strain energy (J).
  double (*energy)(const Bonds& on, std::size_t begin, std::size_t end);
};

struct LpsKernels {
  LpsSweeps<LpsLattice> lattice;
  LpsSweeps<LpsList> list;
};

/// The kernels of the instruction set in use, for two or three dimensions.
LpsKernels lps_kernels(int dimension);

}  // namespace riven
