#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/shape.hpp"

namespace riven {

enum class ElementKind : std::uint8_t {
  point,
  line,
  triangle,
  quadrangle,
  tetrahedron,
  hexahedron,
  prism,
  pyramid,
};

[[nodiscard]] int dimension_of(ElementKind kind);
[[nodiscard]] std::size_t corners_of(ElementKind kind);
[[nodiscard]] const char* name_of(ElementKind kind);
/// Corners of each side of an element of two or three dimensions, in order round it.
[[nodiscard]] const std::vector<std::vector<std::size_t>>& sides_of(ElementKind kind);

/// Elements of one kind that make one geometrical entity: a curve, a surface, a volume. Their corners stand
/// in the order of Gmsh, which is that of VTK: base, then top.
struct ElementBlock {
  ElementKind kind = ElementKind::point;
  int entity = 0;                        // its number among those of its dimension
  std::vector<std::size_t> groups;       // of the mesh, to which they belong
  std::vector<std::uint32_t> node;       // corners_of(kind) nodes for each element
  std::vector<std::size_t> number;       // of each element in its file
  std::vector<std::uint32_t> further{};  // of second order: the other nodes, as many for each element

  [[nodiscard]] std::size_t size() const { return number.size(); }
  [[nodiscard]] std::span<const std::uint32_t> corners(std::size_t element) const {
    return std::span(node).subspan(element * corners_of(kind), corners_of(kind));
  }
  /// Its nodes besides the corners, in the order of Gmsh: those on its edges come first.
  [[nodiscard]] std::span<const std::uint32_t> others(std::size_t element) const {
    const std::size_t n = size() == 0 ? 0 : further.size() / size();
    return std::span(further).subspan(element * n, n);
  }
};

/// A physical group: elements of one dimension under a name.
struct MeshGroup {
  int dimension = 0;
  std::string name;
};

/// Nodes, elements by kind, groups. Lengths are in the unit of the file until they are scaled.
struct Mesh {
  std::vector<Point> node;
  std::vector<ElementBlock> blocks;
  std::vector<MeshGroup> groups;

  /// The highest of its elements; 0 without elements.
  [[nodiscard]] int dimension() const;
};

/// What an element covers, by its isoparametric map.
struct ElementMeasure {
  double size = 0;        // area (in the x-y plane) or volume; negative for an element that is turned over
  Point centroid{};       // centre of the area or the volume
  bool one_sided = true;  // the map's determinant has one sign: the element is not folded
};

/// Of an element of two or three dimensions; exact to rounding, with any corners.
[[nodiscard]] ElementMeasure measure(const Mesh& mesh, const ElementBlock& block, std::size_t element);

/// For each face of `box`, lower and upper along x, y, z: whether the sides of the elements of the mesh's
/// dimension cover all of it, so that the body ends there.
[[nodiscard]] std::array<bool, 6> filled_faces(const Mesh& mesh, const Box& box);

/// The smallest box around the nodes of the elements of the mesh's dimension; in two dimensions endless along
/// z.
[[nodiscard]] Box box_around(const Mesh& mesh);

}  // namespace riven
