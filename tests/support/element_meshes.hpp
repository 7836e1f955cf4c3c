#pragma once

#include <string>

#include "fem/imported_mesh.hpp"
#include "geometry/mesh.hpp"
#include "support/meshes.hpp"

namespace riven::testing {

inline ElementKind kind_of(ElementShape shape) {
  if (shape == ElementShape::t3) return ElementKind::triangle;
  if (shape == ElementShape::t4) return ElementKind::tetrahedron;
  return shape == ElementShape::h8 ? ElementKind::hexahedron : ElementKind::quadrangle;
}

/// A body as the mesh of a file: element n has the number 1000 + n, the group "all" has all, and the faces of
/// its box are groups of lines, triangles or quadrangles.
inline Mesh as_mesh(const MeshBody& body) {
  const int dimension = body.dimension();
  Mesh mesh{.node = body.node, .blocks = {}, .groups = {{dimension, "all"}}};
  ElementBlock block{.kind = kind_of(body.shape), .entity = 1, .groups = {0}, .node = {}, .number = {}};
  for (std::size_t e = 0; e < body.elements(); ++e) {
    const auto nodes = body.nodes(e);
    const auto corners = nodes.first(corners_of(block.kind)), others = nodes.subspan(corners.size());
    block.node.insert(block.node.end(), corners.begin(), corners.end());
    block.further.insert(block.further.end(), others.begin(), others.end());
    block.number.push_back(1000 + e);
  }
  mesh.blocks.push_back(block);
  const ElementKind of_sides = dimension == 2                   ? ElementKind::line
                               : body.shape == ElementShape::t4 ? ElementKind::triangle
                                                                : ElementKind::quadrangle;
  std::size_t number = 1;
  for (std::size_t face = 0; face < 2 * static_cast<std::size_t>(dimension); ++face) {
    ElementBlock sides{.kind = of_sides,
                       .entity = static_cast<int>(face) + 1,
                       .groups = {mesh.groups.size()},
                       .node = {},
                       .number = {}};
    for (const Side& side : body.face[face]) {
      const auto corner = static_cast<std::ptrdiff_t>(corners_of(of_sides));
      sides.node.insert(sides.node.end(), side.node.begin(), side.node.begin() + corner);
      sides.further.insert(sides.further.end(), side.node.begin() + corner, side.node.end());
      sides.number.push_back(number++);
    }
    mesh.groups.push_back({dimension - 1, "face " + std::to_string(face)});
    mesh.blocks.push_back(std::move(sides));
  }
  return mesh;
}

}  // namespace riven::testing
