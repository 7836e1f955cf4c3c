#pragma once

#include <string>
#include <vector>

#include "geometry/mesh.hpp"

namespace riven {

/// Throws InputError (file, element) where the elements of the mesh's dimension do not make one body: parts
/// that share no node, sides of more than two elements, nodes on the sides of elements that they do not
/// belong to.
void check_conforming(const Mesh& mesh, const std::string& file);

/// What is odd about a mesh and may be meant: surfaces that are turned over, nodes that belong to no element,
/// nodes at one place.
[[nodiscard]] std::vector<std::string> oddities(const Mesh& mesh);

}  // namespace riven
