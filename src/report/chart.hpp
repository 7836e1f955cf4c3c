#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/canvas.hpp"

namespace riven {

/// What an axis of a chart shows; the unit is SI, empty if there is none.
struct ChartAxis {
  std::string name;
  std::string unit;
};

struct Series {
  std::string name;  // in the legend
  std::vector<double> x, y;
  std::optional<std::size_t> group{};  // series of one group look the same and share the first one's name
};

struct Chart {
  std::string title;
  ChartAxis x, y;
  std::vector<Series> series;
};

/// Lines through the values, with marks where they are few. Returns the file; its kind is that of `path`'s
/// ending. Values that are not finite leave a gap.
std::string draw_chart(const Chart& chart, PictureSize size, const std::filesystem::path& path);

}  // namespace riven
