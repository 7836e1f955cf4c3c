#pragma once

#include "body/body.hpp"
#include "geometry/surface.hpp"

namespace riven {

/// What a lattice body is made from; lengths in metres.
struct LatticeBodyInput {
  int dimension = 2;
  Shape shape;
  double thickness = 1;  // m in 2D, cross-section in m^2 in 1D, 1 in 3D
  double spacing = 0;
  double horizon = 0;
  Defects defects;
  Faces mirrored;                    // faces that get layers of ghost points
  const Surface* surface = nullptr;  // what is filled, in three dimensions; the shape is its box
};

/// Points at the centres of a uniform lattice's cells, padded as `Lattice` says. Rules for cut cells, bonds
/// at defects and inclusions: peridynamics theory, 5a. Throws InputError when nothing is left of the body, a
/// face to mirror does not exist or the lattice does not end at it.
Body make_lattice_body(const LatticeBodyInput& input);

}  // namespace riven
