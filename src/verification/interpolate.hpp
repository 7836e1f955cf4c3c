#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/defects.hpp"
#include "geometry/shape.hpp"

namespace riven {

/// The displacement at any place between the points of a body, by a local linear least-squares fit. Only
/// points that the place can see count: the straight line to them is not cut by a hole or a crack and does
/// not enter an inclusion (from inside an inclusion: does not leave it). A place on an inclusion's edge sees
/// the points outside.
class Interpolation {
 public:
  /// `positions` (m, undeformed) and `displacements` (m) of the live points of one state; `spacing` and
  /// `horizon` in metres. Keeps references to the arrays. Throws std::invalid_argument when their sizes
  /// differ.
  Interpolation(std::span<const Point> positions, std::span<const Point> displacements,
                const Defects& defects, double spacing, double horizon);

  /// Displacement at `place`; nothing where it has no meaning: on a crack (two values), in a hole, farther
  /// than two spacings from every point in sight, or where the points in sight do not span the body's
  /// dimensions.
  [[nodiscard]] std::optional<Point> at(const Point& place) const;

 private:
  struct Neighbour {
    std::size_t point;
    double distance;  // m
  };

  [[nodiscard]] std::vector<Neighbour> in_sight(const Point& place) const;
  [[nodiscard]] bool sees(const Point& place, const Point& point) const;
  [[nodiscard]] std::optional<Point> fit(const Point& place, std::span<const Neighbour> neighbours,
                                         double radius) const;

  std::span<const Point> positions_;
  std::span<const Point> displacements_;
  const Defects& defects_;
  double spacing_;
  double reach_;                   // largest radius of a fit (m)
  double tolerance_;               // m
  std::vector<std::size_t> by_x_;  // points in the order of their x
  std::vector<std::size_t> axes_;  // along which the body extends
};

}  // namespace riven
