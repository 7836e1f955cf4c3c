#pragma once

#include <array>
#include <optional>
#include <variant>

namespace riven {

/// A position in metres; components beyond the body's dimension are 0.
using Point = std::array<double, 3>;

/// A rectangle (2D) or box (3D) parallel to the axes. In fewer than three dimensions the unused half-sizes
/// are infinite.
struct Box {
  Point center{};
  Point half_size{};
};

/// A circle in the x-y plane; in 3D the cylinder over it, endless along z.
struct Disc {
  Point center{};
  double radius = 0;
};

struct Ball {
  Point center{};
  double radius = 0;
};

/// A convex region of space.
using Shape = std::variant<Box, Disc, Ball>;

/// A crack of zero width in 2D, from `a` to `b`.
struct Segment {
  Point a{};
  Point b{};
};

/// Part of a line a + t (b - a) with 0 <= from <= t <= to <= 1.
struct Interval {
  double from = 0;
  double to = 0;
};

/// Distance to the surface of the shape in metres; negative inside.
double signed_distance(const Shape& shape, const Point& p);

/// The part of the segment from `a` to `b` that lies in the shape, made smaller by `tolerance` (metres) on
/// all sides: a segment that only touches the surface or runs along it has no such part.
std::optional<Interval> chord(const Shape& shape, const Point& a, const Point& b, double tolerance);

/// Fraction of the square, cube or interval (`dimension` 2, 3, 1) of edge `spacing` (m) centred at `cell`
/// that the shape covers; exactly 0 or 1 for a cell that only touches the surface. Exact to rounding for
/// boxes and discs, to 1e-4 for balls in 3D.
double covered_fraction(const Shape& shape, const Point& cell, double spacing, int dimension);

/// Whether two shapes share interior points, by more than `tolerance` (m).
bool overlap(const Shape& a, const Shape& b, double tolerance);

/// Distance from a point to a segment (m).
double distance(const Segment& segment, const Point& p);

/// Whether the segment from `a` to `b` crosses the crack, in the x-y plane. Touching the crack from one side
/// is no crossing; a bond through a crack's end counts as crossing.
bool crosses(const Segment& crack, const Point& a, const Point& b, double tolerance);

}  // namespace riven
