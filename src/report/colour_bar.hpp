#pragma once

#include <string>

#include "report/canvas.hpp"
#include "report/colour_map.hpp"
#include "report/ticks.hpp"

namespace riven {

/// The colours of a picture with the numbers that they stand for.
struct ColourBar {
  const ColourMap& map;
  Range colours;  // in the unit of the label
  Range values;   // that there are; where they go beyond the colours the bar has a point
  std::string label;
  bool upwards = true;  // else to the right

  /// What bar, numbers and label take across the bar, with a gap before it (px).
  [[nodiscard]] double room(Canvas& canvas) const;
  /// `corner`: where the room begins; `length` of the bar (px).
  void draw(Canvas& canvas, Pixel corner, double length) const;

 private:
  void draw_tips(Canvas& canvas, Pixel corner, double width, double height) const;
};

}  // namespace riven
