#pragma once

#include <string>

#include "report/canvas.hpp"
#include "report/ticks.hpp"

namespace riven {

/// Sizes in a picture, in units of the canvas.
inline constexpr double kTextHeight = 13, kTitleHeight = 17, kPadding = 16;

/// A rectangle of a picture with ticks around it; the left and the lower ones have numbers.
struct Axes {
  Pixel corner;  // upper left (px)
  double width = 0, height = 0;
  Range x, y;  // in the units of the labels
  std::string x_label, y_label;
  bool grid = false;

  [[nodiscard]] Pixel at(double x_value, double y_value) const;
  void draw(Canvas& canvas) const;
};

/// What numbers and label take to the left of axes, and below them (px).
double room_left(Canvas& canvas, const Range& y, double height);
double room_below(const Canvas& canvas);

/// About as many ticks as are legible along a length (px).
int ticks_along(const Canvas& canvas, double length);

/// Title of a picture and what stands under it; both are cut where they are too long.
void draw_title(Canvas& canvas, const std::string& title, const std::string& below);
/// How far down they reach (px).
double title_room(const Canvas& canvas, bool has_below);

}  // namespace riven
