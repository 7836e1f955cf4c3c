#pragma once

#include "body/listed_body.hpp"
#include "support/bodies.hpp"

namespace riven::testing {

/// A lattice body's sheet as a list of points, each with the volume of its cell.
inline ListedBodyInput points_of(const LatticeBodyInput& in) {
  ListedBodyInput out;
  const Body whole = make_lattice_body({.dimension = in.dimension,
                                        .shape = in.shape,
                                        .thickness = in.thickness,
                                        .spacing = in.spacing,
                                        .horizon = in.horizon,
                                        .defects = {},
                                        .mirrored = {}});
  out.dimension = in.dimension;
  for (const std::size_t i : whole.points) {
    out.position.push_back(whole.position(i));
    out.volume.push_back(whole.volume[i]);
  }
  out.thickness = in.thickness;
  out.horizon = in.horizon;
  out.faces = whole.faces;
  out.defects = in.defects;
  out.mirrored = in.mirrored;
  return out;
}

/// The sheet with every point moved by up to a fifth of the spacing.
inline ListedBodyInput jittered(const LatticeBodyInput& in, Random& random) {
  ListedBodyInput out = points_of(in);
  for (Point& x : out.position)
    for (std::size_t axis = 0; axis < 2; ++axis) x[axis] += 0.2 * in.spacing * random.between(-1, 1);
  for (double& v : out.volume) v *= random.between(0.8, 1.2);
  return out;
}

}  // namespace riven::testing
