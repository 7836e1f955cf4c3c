#pragma once

#include <filesystem>

#include "geometry/mesh.hpp"

namespace riven {

/// Reads a mesh in Gmsh's format MSH 4.1, ASCII or binary (little-endian). Physical groups without a name are
/// called by their number. Sections besides $PhysicalNames, $Entities, $Nodes and $Elements are skipped.
///
/// Throws InputError for what is no such file, with its line (ASCII) or byte (binary), what was found and
/// what was expected.
Mesh read_gmsh(const std::filesystem::path& file);

}  // namespace riven
