#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <span>
#include <vector>

#include "body/bond_planes.hpp"
#include "body/stencil.hpp"
#include "geometry/defects.hpp"
#include "geometry/lattice.hpp"

namespace riven {

/// Outer faces of a box, in the order of their names left, right, bottom, top, back, front.
inline constexpr std::array<const char*, 6> kFaceNames = {"left", "right", "bottom", "top", "back", "front"};
using Faces = std::bitset<6>;  // face 2 a is the lower one of axis a, 2 a + 1 the upper one

enum class PointKind : std::uint8_t {
  outside,  // no material
  body,     // material point
  rigid,    // part of a rigid inclusion: carries no energy
  ghost,    // mirror image of a body point behind a face
};

/// A ghost point, the body point it mirrors, and the faces it is mirrored at (at most one per axis).
struct GhostPoint {
  std::size_t point = 0;
  std::size_t master = 0;
  Faces faces;
};

/// A bond that ends on the surface of a rigid inclusion instead of at the lattice point behind it.
struct InterfaceBond {
  std::size_t point = 0;   // body end
  std::size_t offset = 0;  // number of the stencil's bond that was shortened
  std::size_t inclusion = 0;
  Point end{};  // on the surface, undeformed (m)
};

/// What a lattice body is made from; lengths in metres.
struct LatticeBodyInput {
  int dimension = 2;
  Shape shape;
  double thickness = 1;  // m in 2D, cross-section in m^2 in 1D, 1 in 3D
  double spacing = 0;
  double horizon = 0;
  Defects defects;
  Faces mirrored;  // faces that get layers of ghost points
};

/// Points of a uniform lattice with bonds between them. Fields are stored on the padded lattice
/// (`lattice.size()` entries). Rules for cut cells, bonds at defects and inclusions: peridynamics theory, 5a.
struct LatticeBody {
  Lattice lattice;
  Stencil stencil;
  double horizon = 0;
  double thickness = 1;
  Shape shape;
  Defects defects;
  std::vector<PointKind> kind;
  std::vector<double> volume;               // m^3; 0 unless body
  BondPlanes bonds;                         // body-body and body-ghost
  std::vector<std::uint16_t> whole_family;  // bonds of a body point if no crack had cut any
  std::vector<std::size_t> points;          // body points in storage order
  std::vector<GhostPoint> ghosts;
  std::vector<InterfaceBond> interface;                // sorted by point, then offset
  std::vector<std::vector<std::size_t>> rigid_points;  // of each inclusion

  /// Bonds of a point that end on inclusions.
  [[nodiscard]] std::span<const InterfaceBond> interface_of(std::size_t point) const;
  /// Bonds of a point, those to inclusions included.
  [[nodiscard]] std::size_t family_size(std::size_t point) const;
};

/// Throws InputError when nothing is left of the body, a face to mirror does not exist or the lattice does
/// not end at it.
LatticeBody make_lattice_body(const LatticeBodyInput& input);

}  // namespace riven
