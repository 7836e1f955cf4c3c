#pragma once

#include <array>
#include <string>
#include <vector>

#include "fem/mesh_body.hpp"
#include "geometry/mesh.hpp"

namespace riven {

/// Nodes and elements of a physical group: of one of lower dimension than the body the nodes alone.
struct MeshPart {
  std::string name;
  int dimension = 0;
  std::vector<std::size_t> nodes, elements;  // ascending
};

/// A mesh from a file as finite elements. Groups of sides are edges of `body`, by their names.
struct ImportedMesh {
  MeshBody body;
  std::vector<MeshPart> parts;  // all groups
};

/// The elements of the mesh's dimension, all of the kind of `shape`, with the nodes that they use in their
/// order; elements that go clockwise are turned over. `faces`: the sides of the box around the mesh that are
/// edges. Throws InputError (file, element) where an element of a group of sides is the side of no element.
[[nodiscard]] ImportedMesh import_mesh(const Mesh& mesh, ElementShape shape, double thickness,
                                       const std::array<bool, 6>& faces, const std::string& file);

}  // namespace riven
