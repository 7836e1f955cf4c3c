#pragma once

#include <array>
#include <variant>
#include <vector>

#include "geometry/box_tree.hpp"
#include "geometry/shape.hpp"

namespace riven {

struct Triangles;

/// A flat crack in space: the inside of a polygon, which may have re-entrant corners.
struct PolygonCrack {
  std::vector<Point> corner;  // m, in their order around it
};

/// A flat round crack in space.
struct PennyCrack {
  Point center{};  // m
  Point normal{};  // of any length but 0
  double radius = 0;
};

/// A crack of zero width in three dimensions: flat faces, which may leave edges open.
class CrackSurface {
 public:
  /// Throws InputError unless there are three corners or more, in one plane to 1e-6 of their extent, around
  /// an area, by edges that do not cross.
  explicit CrackSurface(const PolygonCrack& polygon);
  explicit CrackSurface(const PennyCrack& penny);
  /// Triangles without area are left out. Throws InputError when no others are there.
  explicit CrackSurface(const Triangles& triangles);

  /// Whether the line from `a` to `b` crosses a face. Touching from one side, within `tolerance` (m), is no
  /// crossing; a line through an edge of a face is one. The order of `a` and `b` matters in the last digit.
  [[nodiscard]] bool crosses(const Point& a, const Point& b, double tolerance) const;
  /// Distance (m) from a place to the nearest face.
  [[nodiscard]] double distance(const Point& p) const;

  [[nodiscard]] std::size_t size() const { return faces_.size(); }
  /// Area of all faces (m^2).
  [[nodiscard]] double area() const;

 private:
  using InPlane = std::array<double, 2>;

  /// A flat face with coordinates of its own: polygon corners, or a circle about the origin.
  struct Face {
    Point origin{}, normal{};     // unit length
    std::array<Point, 2> axis{};  // in its plane; unit length
    std::vector<InPlane> corner;  // m; of a circle none
    double radius = 0;            // m

    [[nodiscard]] double height(const Point& p) const;
    [[nodiscard]] InPlane in_plane(const Point& p) const;
    /// Distance to the outline in the plane (m), negative inside.
    [[nodiscard]] double beyond_outline(const InPlane& q) const;
    [[nodiscard]] bool crosses(const Point& a, const Point& b, double tolerance) const;
    [[nodiscard]] double distance(const Point& p) const;
    [[nodiscard]] double area() const;
    [[nodiscard]] Bounds bounds() const;
  };

  static Face flat(const std::vector<Point>& corner);
  static Face round(const PennyCrack& penny);
  static std::vector<Face> faces_of(const Triangles& triangles);
  explicit CrackSurface(std::vector<Face> faces);

  std::vector<Face> faces_;
  BoxTree tree_;
};

}  // namespace riven
