#pragma once

#include <filesystem>

#include "geometry/surface.hpp"

namespace riven {

/// Reads an STL file, ASCII or binary, in the unit of the file. Corners at the same place become one;
/// triangles that have two corners at one place are left out; normals are not read, since the order of
/// corners says the same. Throws InputError for what is no such file, with its line (ASCII) or byte (binary).
Triangles read_stl(const std::filesystem::path& file);

}  // namespace riven
