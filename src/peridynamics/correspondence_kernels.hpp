#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "body/bond_planes.hpp"

namespace riven {

/// A bond of the stencil, as the kernels read it.
struct CorrespondenceBond {
  std::ptrdiff_t shift = 0;    // to the neighbour, in storage entries
  std::array<double, 3> xi{};  // m
  double weight = 0;           // omega
};

/// What the kernels see of a body on a lattice and of its state. A family's part of a bond's force is
/// omega (R xi + s eta) with R = P K^-1 - s H, H = F - 1: `Correspondence` has the formulas. Points are taken
/// in blocks of eight.
struct CorrespondenceLattice {
  std::vector<CorrespondenceBond> stencil;
  std::vector<BlockKind> blocks;         // by bonds
  std::vector<std::uint8_t> families;    // whether some point of a block has a family of its own
  const std::uint8_t* masks = nullptr;   // of all blocks: a byte per bond of the stencil
  const double* volume = nullptr;        // of a point, for ghosts that of their master (m^3)
  double uniform_volume = 0;             // if it is the same for all points, else 0
  std::array<const double*, 6> shape{};  // K^-1, upper half row by row (1/m^5); 0 without a family
  const double* spring = nullptr;        // s (Pa/m^5)
  std::array<double*, 9> reply{};        // R, row by row (Pa/m^5), of one state
  std::array<const double*, 3> u{};
  std::array<double*, 3> out{};  // force (N)
};

/// A bond's other end in a list: its two lines of the cache.
struct alignas(64) CorrespondencePoint {
  std::array<double, 3> x{};  // undeformed (m)
  double spring = 0;
  std::array<double, 3> u{};  // m
  double last_reply = 0;      // R has nine components in space: this is the ninth
  std::array<double, 8> reply{};
};

/// The same for listed bonds.
struct CorrespondenceList {
  std::vector<CorrespondencePoint> points;
  const double* volume = nullptr;
  std::array<const double*, 6> shape{};
  std::array<double*, 9> reply{};            // copied into the points between the sweeps
  std::vector<double> weight;                // omega V of the other end, of every bond (m^3)
  const std::size_t* begin = nullptr;        // bonds of point i: [begin[i], begin[i + 1])
  const std::uint32_t* neighbour = nullptr;  // readable eight entries beyond the last bond
  const std::uint8_t* masks = nullptr;       // those of point i start at byte begin[i] / 8 + i
  const double* spring = nullptr;
  std::array<double*, 3> out{};
};

/// Numbers of some points, a row per component: deformation gradients and stresses.
using GradientRows = std::array<double*, 9>;

/// What the kernels do with points [begin, end), in whole blocks on a lattice; each writes only its own
/// points. Points without a family are left out of rows: on a lattice whole blocks of them, in a list none.
template <class Bonds>
struct CorrespondenceSweeps {
  /// Deformation gradients of the points, one after the other. Returns how many.
  std::size_t (*deform)(const Bonds& on, std::size_t begin, std::size_t end, const GradientRows& f);
  /// The same, and what they do not explain, sum(omega |z|^2 V), into a row of its own.
  std::size_t (*measure)(const Bonds& on, std::size_t begin, std::size_t end, const GradientRows& f,
                         double* rest);
  /// R of the same points from gradients and stresses.
  void (*reply)(Bonds& on, std::size_t begin, std::size_t end, const GradientRows& f, const GradientRows& p);
  /// Forces, from R and s at both ends of the bonds.
  void (*pull)(const Bonds& on, std::size_t begin, std::size_t end);
};

struct CorrespondenceKernels {
  CorrespondenceSweeps<CorrespondenceLattice> lattice;
  CorrespondenceSweeps<CorrespondenceList> list;
};

/// The kernels of the instruction set in use, for two or three dimensions.
CorrespondenceKernels correspondence_kernels(int dimension);

}  // namespace riven
