#pragma once

#include <string>
#include <vector>

#include "input/format.hpp"

namespace riven {

/// Whether the body's elements come from a file.
[[nodiscard]] bool is_element_mesh(const GeometryInput& geometry);

/// Fills a geometry with the finite elements of a Gmsh file. Errors at the key `file`, with what the mesh
/// lacks: another kind of elements, several kinds, elements turned over or flat, parts without common nodes.
void read_element_mesh(GeometryInput& geometry, const ElementsInput& from,
                       const std::optional<double>& thickness, const Case& c, const Check& check);

/// What its elements are called: "q4".
[[nodiscard]] std::string element_name(const Mesh& mesh);

/// Names of the physical groups of such a mesh: of edges (lines in the plane, faces in space), or the others.
[[nodiscard]] std::vector<std::string> edge_groups(const GeometryInput& geometry);
[[nodiscard]] std::vector<std::string> other_groups(const GeometryInput& geometry);

}  // namespace riven
