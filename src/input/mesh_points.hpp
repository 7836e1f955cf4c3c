#pragma once

#include <filesystem>

#include "geometry/mesh.hpp"
#include "input/point_list.hpp"

namespace riven {

/// The mesh of a Gmsh file with its coordinates in metres; `unit`: a metre's part that they count in. In two
/// dimensions it lies in the x-y plane. Throws InputError where the file is no such mesh, where it has no
/// elements of two or three dimensions, or where lower ones are attached to none of these.
Mesh read_body_mesh(const std::filesystem::path& file, double unit);

/// A point for each element of the mesh's dimension, at its centroid, with its volume; in two dimensions the
/// area times `thickness` (m). A group of that dimension has the points of its elements; one of a lower
/// dimension those of the elements that touch it: that share a node with it. Throws InputError for an element
/// without volume, turned over or folded; in two dimensions a whole surface may be turned over.
PointList points_of(const Mesh& mesh, const std::string& file, double thickness);

}  // namespace riven
