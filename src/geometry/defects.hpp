#pragma once

#include <memory>
#include <vector>

#include "geometry/crack_surface.hpp"
#include "geometry/shape.hpp"

namespace riven {

/// What interrupts a body: holes and slots (shapes without material), cracks of zero width, rigid inclusions.
struct Defects {
  std::vector<Shape> holes;
  std::vector<Segment> cracks;  // in two dimensions
  std::vector<Shape> inclusions;
  std::vector<std::shared_ptr<const CrackSurface>> crack_surfaces;  // in three dimensions

  /// Whether the straight line from `a` to `b` is interrupted by a hole or a crack: its open segment enters a
  /// hole's interior, not counting a part that starts at an end point inside (a kept point of a cut cell).
  /// `tolerance` is a length (m) far below the spacing.
  [[nodiscard]] bool cuts(const Point& a, const Point& b, double tolerance) const;

  /// Distance (m) to the nearest edge of a hole, crack or inclusion; infinite without defects.
  [[nodiscard]] double distance_to_edge(const Point& p) const;
};

}  // namespace riven
