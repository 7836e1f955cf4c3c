#include "report/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/axes.hpp"

namespace riven {

namespace {

// Okabe and Ito: told apart by all eyes.
constexpr std::array<Colour, 7> kColours = {
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}, {0, 0, 0}}};
// Lengths of lines and gaps (canvas units): lines are told apart without colours, too.
const std::array<std::vector<double>, 4> kDashes = {{{}, {7, 3}, {2, 2.5}, {9, 3, 2, 3}}};
constexpr std::size_t kMostNamed = 20;  // in the legend
constexpr std::size_t kFewPoints = 30;  // that get marks

/// A range with room beyond the values, so that lines do not run along the frame.
Range roomy(Range range) {
  if (range.empty()) return {0, 1};
  const double wider = range.width() > 1e-9 * std::max(std::abs(range.low), std::abs(range.high))
                           ? 0.04 * range.width()
                           : std::max(0.1 * std::abs(range.low), 1e-300);
  return {range.low - wider, range.high + wider};
}

/// The values of all series along one axis, in a readable unit.
struct Direction {
  ReadableUnit in;
  Range range;
};

template <class Values>
Direction direction(const Chart& chart, const ChartAxis& axis, const Values& values) {
  Range range;
  for (const Series& series : chart.series)
    for (const double value : values(series)) range.include(value);
  const double largest = range.empty() ? 0 : std::max(std::abs(range.low), std::abs(range.high));
  const ReadableUnit in = readable_unit(axis.unit, largest);
  range = roomy(range);
  return {in, {in.factor * range.low, in.factor * range.high}};
}

struct Style {
  Colour colour;
  std::vector<double> dashes;
};

Style style_of(std::size_t number, double unit) {
  Style style{kColours[number % kColours.size()], kDashes[number % kDashes.size()]};
  for (double& dash : style.dashes) dash *= unit;
  return style;
}

void draw_series(Canvas& canvas, const Axes& axes, const Series& series, const Style& style,
                 std::array<double, 2> factors) {
  std::vector<Pixel> points;
  const auto draw = [&] {
    if (points.size() > 1) canvas.line(points, style.colour, 1.8 * canvas.unit(), style.dashes);
    if (series.x.size() <= kFewPoints || points.size() == 1)
      for (const Pixel& point : points) canvas.disc(point, 3.2 * canvas.unit(), style.colour);
    points.clear();
  };
  for (std::size_t n = 0; n < series.x.size(); ++n) {
    if (std::isfinite(series.x[n]) && std::isfinite(series.y[n])) {
      points.push_back(axes.at(factors[0] * series.x[n], factors[1] * series.y[n]));
    } else {
      draw();
    }
  }
  draw();
}

std::vector<std::string> legend_texts(const Chart& chart) {
  std::vector<std::string> texts;
  if (chart.series.size() < 2) return texts;
  for (const Series& series : chart.series) {
    if (texts.size() == kMostNamed) {
      texts.push_back(fmt::format("… and {} more", chart.series.size() - kMostNamed));
      break;
    }
    texts.push_back(series.name);
  }
  return texts;
}

constexpr double kSample = 34, kLegendGap = 8;  // of the legend (canvas units)

double legend_room(Canvas& canvas, const std::vector<std::string>& texts) {
  if (texts.empty()) return 0;
  double widest = 0;
  for (const std::string& text : texts)
    widest = std::max(widest, canvas.text_width(text, kTextHeight * canvas.unit()));
  return widest + (kSample + 3 * kLegendGap) * canvas.unit();
}

void draw_legend(Canvas& canvas, const Axes& axes, const std::vector<std::string>& texts) {
  const double u = canvas.unit(), left = axes.corner.x + axes.width + 2 * kLegendGap * u;
  for (std::size_t n = 0; n < texts.size(); ++n) {
    const double line = axes.corner.y + (0.8 + 1.6 * static_cast<double>(n)) * kTextHeight * u;
    const Style style = style_of(n, u);
    if (n < kMostNamed)
      canvas.line(std::array{Pixel{left, line}, Pixel{left + kSample * u, line}}, style.colour, 1.8 * u,
                  style.dashes);
    canvas.text({left + (kSample + kLegendGap) * u, line + 0.36 * kTextHeight * u}, texts[n],
                kTextHeight * u);
  }
}

}  // namespace

std::string draw_chart(const Chart& chart, PictureSize size, const std::filesystem::path& path) {
  Canvas canvas(size, unit_of(size), path);
  const double u = canvas.unit(), padding = kPadding * u;
  const Direction x = direction(
                      chart, chart.x, [](const Series&s) -> auto& { return s.x; }),
                  y = direction(
                      chart, chart.y, [](const Series&s) -> auto& { return s.y; });
  const std::vector<std::string> legend = legend_texts(chart);
  Axes axes{.corner = {0, title_room(canvas, false)}, .x = x.range, .y = y.range};
  axes.height = size.height - axes.corner.y - room_below(canvas) - padding;
  axes.corner.x = padding + room_left(canvas, axes.y, axes.height);
  axes.width = size.width - axes.corner.x - 2 * padding - legend_room(canvas, legend);
  axes.x_label = x.in.label(chart.x.name);
  axes.y_label = y.in.label(chart.y.name);
  axes.grid = true;
  axes.draw(canvas);
  draw_title(canvas, chart.title, "");
  canvas.show_only(axes.corner, axes.width, axes.height);
  for (std::size_t n = 0; n < chart.series.size(); ++n)
    draw_series(canvas, axes, chart.series[n], style_of(n, u), {x.in.factor, y.in.factor});
  canvas.show_all();
  draw_legend(canvas, axes, legend);
  return canvas.finish();
}

}  // namespace riven
