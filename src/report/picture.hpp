#pragma once

#include <filesystem>
#include <string>

#include "report/canvas.hpp"
#include "report/colour_map.hpp"
#include "report/result.hpp"
#include "report/scene.hpp"
#include "report/ticks.hpp"

namespace riven {

struct PictureSettings {
  PictureSize size;
  bool trimmed = true;             // cut off what a long or tall body leaves empty
  const ColourMap* map = nullptr;  // none: by the values
  Range values;                    // of the colours; empty: `colour_range`
  Frame frame;                     // empty: as large as the body
  double scale = 1;                // of the displacements that are shown
  double text = 1;                 // of the usual size of text
  std::string title, state;        // "Sheet with a hole", "stretch 3"
};

/// Where the points of a cloud are seen with their displacements times `scale`.
Frame frame_of(const PointCloud& cloud, double scale);

/// Points at their displaced places, coloured by a number each: in two dimensions with axes, in three from
/// above a corner, in one as a curve over the place. Returns the file; its kind is that of `path`'s ending.
std::string draw_field(const PointCloud& cloud, const Scalar& scalar, const PictureSettings& settings,
                       const std::filesystem::path& path);

/// "stretch 3", "t = 1.2 ms"
std::string state_text(const Result& result, std::size_t state);

}  // namespace riven
