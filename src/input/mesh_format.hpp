#pragma once

#include "input/format.hpp"

namespace riven {

/// Metres of one unit of a file that has no units; what is none is an error at `unit`.
double length_unit(const std::string& text, const Check& check);

/// In two dimensions a mesh needs a thickness, in three it has none.
void check_thickness(const std::optional<double>& thickness, int dimension, const Check& check);

/// The box around a mesh as shape; those of its sides that the mesh does not cover are no edges.
void fill_box(GeometryInput& geometry, const Mesh& mesh);

/// The format of `mesh` in [geometry]; reads the file when the keys have been read. `c` tells where the case
/// is.
Format describe_mesh(GeometryInput& geometry, const Case& c);

/// The same of `surface`.
Format describe_surface(GeometryInput& geometry, const Case& c);

}  // namespace riven
