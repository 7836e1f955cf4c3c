#pragma once

#include "input/format.hpp"

namespace riven {

[[nodiscard]] bool is_arch(const GeometryInput& geometry);
[[nodiscard]] bool is_quadrilateral(const GeometryInput& geometry);

/// [geometry] arch = {...}, quadrilateral = {...}
Format describe_arch(GeometryInput& geometry);
Format describe_quadrilateral(GeometryInput& geometry);

/// Numbers of elements along the axes of a body of `size` (m^2 or m^3), checked, with the mean size of a cell
/// as spacing.
void set_elements(GeometryInput& geometry, const std::vector<int>& along, double size, const Check& check);

/// Of a geometry with elements: their kind, and what does not belong to them.
void finish_elements(GeometryInput& geometry, const Check& check);

/// Finite elements need a mesh, and have nothing that makes, breaks or meets bonds. Throws InputError.
void check_elements(const Case& c);

}  // namespace riven
