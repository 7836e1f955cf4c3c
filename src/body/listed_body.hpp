#pragma once

#include <vector>

#include "body/body.hpp"

namespace riven {

/// What a listed body is made from; SI units.
struct ListedBodyInput {
  int dimension = 2;
  std::vector<Point> position;  // m
  std::vector<double> volume;   // m^3, one per position
  double thickness = 1;         // m in 2D, m^2 in 1D, 1 in 3D
  double horizon = 0;           // m
  std::array<double, 6> faces;  // coordinates of the outer faces (m)
  Defects defects;
  Faces mirrored;  // faces that get layers of ghost points
};

/// A body of points anywhere, bonded within the horizon. Points within a hole are dropped, points within an
/// inclusion are part of it; volumes stay as given. Stored are the points in the order given, then the
/// ghosts. Throws InputError when nothing is left of the body.
Body make_listed_body(const ListedBodyInput& input);

/// The same body with its bonds listed: its body points and rigid points in storage order, then its ghosts.
Body listed(const Body& lattice_body);

}  // namespace riven
