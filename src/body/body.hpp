#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <span>
#include <variant>
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

/// A bond that ends on the surface of a rigid inclusion instead of at the point behind it.
struct InterfaceBond {
  std::size_t point = 0;      // body end
  std::size_t neighbour = 0;  // the point behind the surface
  std::size_t inclusion = 0;
  Point end{};        // on the surface, undeformed (m)
  double volume = 0;  // of the point behind, before it became part of the inclusion (m^3)
};

/// Points of a uniform lattice: neighbour k of point i is i + shift[k], and a bond is one bit.
struct LatticeBonds {
  Lattice lattice;
  Stencil stencil;
  BondPlanes bonds;
};

/// Points anywhere: their positions (m), and the neighbours of point i in [begin[i], begin[i + 1]),
/// ascending. A bond that broke stays in the list; its bit says so.
struct ListedBonds {
  std::vector<Point> position;
  std::vector<std::size_t> begin;
  std::vector<std::uint32_t> neighbour;  // kLanes entries more than bonds, so that a kernel may read on
  std::vector<std::uint8_t> masks;       // a bit per bond; those of point i start at byte begin[i] / 8 + i

  /// Ends the making of the list: all bonds in it exist.
  void close();
  [[nodiscard]] bool exists(std::size_t point, std::size_t bond) const {
    const std::size_t n = bond - begin[point];
    return (masks[begin[point] / 8 + point + n / 8] >> (n % 8) & 1U) != 0;
  }
  /// Takes a bond out, seen from this end.
  void cut(std::size_t point, std::size_t bond) {
    const std::size_t n = bond - begin[point];
    masks[begin[point] / 8 + point + n / 8] &= static_cast<std::uint8_t>(~(1U << (n % 8)));
  }
};

/// Material points with bonds between them, on a lattice or listed. Fields have `size()` entries: one per
/// stored point, ghosts and padding included.
struct Body {
  int dimension = 2;
  double spacing = 0;           // m; of listed points a mean
  double horizon = 0;           // m
  double thickness = 1;         // m in 2D, cross-section in m^2 in 1D, 1 in 3D
  std::array<double, 6> faces;  // coordinate of each outer face along its axis (m)
  Defects defects;
  std::vector<PointKind> kind;
  std::vector<double> volume;               // m^3; 0 unless body
  std::vector<std::uint32_t> whole_family;  // bonds of a body point if no crack had cut any
  std::vector<bool> complete;               // nothing is missing in a body point's family
  // Of stored points, for ghosts that of their master; empty: all points have material 0, all bonds may
  // break.
  std::vector<std::uint8_t> material;
  std::vector<std::uint8_t> unbreakable;  // whether no bond of the point ever breaks
  std::vector<std::size_t> points;        // body points in storage order
  std::vector<GhostPoint> ghosts;
  std::vector<InterfaceBond> interface;                // sorted by point
  std::vector<std::vector<std::size_t>> rigid_points;  // of each inclusion
  std::variant<LatticeBonds, ListedBonds> bonds;       // body-body and body-ghost

  [[nodiscard]] std::size_t size() const { return kind.size(); }
  [[nodiscard]] const LatticeBonds* on_lattice() const { return std::get_if<LatticeBonds>(&bonds); }
  /// The bits of the bonds.
  [[nodiscard]] const std::vector<std::uint8_t>& masks() const {
    const LatticeBonds* on = on_lattice();
    return on != nullptr ? on->bonds.bytes() : std::get<ListedBonds>(bonds).masks;
  }
  [[nodiscard]] std::vector<std::uint8_t>& masks() {
    auto* on = std::get_if<LatticeBonds>(&bonds);
    return on != nullptr ? on->bonds.bytes() : std::get<ListedBonds>(bonds).masks;
  }
  /// Undeformed position (m) of a stored point.
  [[nodiscard]] Point position(std::size_t point) const;
  /// Bonds of a point that end on inclusions.
  [[nodiscard]] std::span<const InterfaceBond> interface_of(std::size_t point) const;
  /// Bonds of a point, those to inclusions included.
  [[nodiscard]] std::size_t family_size(std::size_t point) const;
  [[nodiscard]] std::size_t material_of(std::size_t point) const {
    return material.empty() ? 0 : material[point];
  }
  [[nodiscard]] bool is_unbreakable(std::size_t point) const {
    return !unbreakable.empty() && unbreakable[point] != 0;
  }
  /// Sets a value per stored point of body points, given by their places in `points`, and of their ghosts.
  void mark(std::vector<std::uint8_t>& values, std::span<const std::size_t> numbers,
            std::uint8_t value) const;
  /// Cuts a bond (offset of the stencil, or place in the list) of a stored point, seen from both ends.
  void cut(std::size_t point, std::size_t bond);
  /// Share of a body point's bonds that cracks have cut.
  [[nodiscard]] double damage(std::size_t point) const;
  /// Reference area (m^2) of an outer face.
  [[nodiscard]] double face_area(std::size_t face) const;
  /// Memory of bonds, kinds and volumes (bytes).
  [[nodiscard]] std::size_t bytes() const;

  /// Calls visit(bond, neighbour) for the bonds of a stored point to other stored points; a bond is an offset
  /// of the stencil or a place in the list.
  template <class Visit>
  void for_each_bond(std::size_t point, const Visit& visit) const {
    if (const LatticeBonds* on = on_lattice()) {
      for (std::size_t k = 0; k < on->stencil.size(); ++k)
        if (on->bonds.exists(k, point)) visit(k, BondPlanes::neighbour(on->stencil, k, point));
      return;
    }
    const auto& list = std::get<ListedBonds>(bonds);
    for (std::size_t b = list.begin[point]; b < list.begin[point + 1]; ++b)
      if (list.exists(point, b)) visit(b, std::size_t{list.neighbour[b]});
  }
  /// The same with the neighbour alone.
  template <class Visit>
  void for_each_neighbour(std::size_t point, const Visit& visit) const {
    for_each_bond(point, [&](std::size_t, std::size_t neighbour) { visit(neighbour); });
  }
};

/// x reflected at some of the body's faces.
Point reflected(const Body& body, const Faces& at, const Point& x);

}  // namespace riven
