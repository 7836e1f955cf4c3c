#pragma once

#include <array>
#include <span>

#include "report/canvas.hpp"

namespace riven {

/// A cell of a plane body on the raster.
struct Tile {
  Pixel centre;                   // px
  std::array<double, 4> inverse;  // from px to widths of the cell, row by row
  std::array<double, 4> sides;    // of a square: where it ends, in its widths: left, right, lower, upper
  Pixel reach;                    // no pixel is farther from the centre than this (px)
  Colour colour{};
};

/// A point of a solid on the raster.
struct Sphere {
  Pixel centre;      // px
  double depth = 0;  // px towards the viewer
  double radius = 0;
  Colour colour{};
};

/// A corner of a facet.
struct Corner {
  Pixel at;          // px
  double depth = 0;  // px towards the viewer
  Colour colour{};
};

/// A triangle of a mesh on the raster, with colours that run from corner to corner; `light`: 1 as they are.
struct Facet {
  std::array<Corner, 3> corner;
  double light = 1;
};

/// How far a cell reaches from its centre, in widths: a square to its half, or farther where a neighbour
/// follows, with which it shares what is between; a disc so far that it covers what lies between points in
/// disorder.
inline constexpr double kFreeSide = 0.5, kJoinedSide = 0.85, kDiscReach = 1.0;

/// Where several cells meet, a pixel belongs to the one whose centre is nearest in its own measure: no cell
/// hides another, whatever their order, and there are no gaps. White where there is none.
Raster raster_of(std::span<const Tile> tiles, bool square, int width, int height);

/// The nearest sphere to the viewer at every pixel, shaded by light from the upper left.
Raster raster_of(std::span<const Sphere> spheres, int width, int height);

/// The facet nearest to the viewer at every pixel.
Raster raster_of(std::span<const Facet> facets, int width, int height);

}  // namespace riven
