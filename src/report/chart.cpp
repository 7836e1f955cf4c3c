#include "report/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "report/axes.hpp"

namespace riven {

namespace {

// Okabe and Ito: told apart by all eyes.
constexpr std::array<Colour, 7> kColours = {
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}, {0, 0, 0}}};
// Lengths of lines and gaps (canvas units): lines are told apart without colours, too.
const std::array<std::vector<double>, 4> kDashes = {{{}, {7, 3}, {2, 2.5}, {9, 3, 2, 3}}};
constexpr std::size_t kFewPoints = 30;  // that get marks

/// A range with room beyond the values, so that lines do not run along the frame.
Range roomy(Range range) {
  if (range.empty()) return {0, 1};
  if (range.low == 0 && range.high == 0) return {-1, 1};
  const double wider = range.width() > 1e-9 * std::max(std::abs(range.low), std::abs(range.high))
                           ? 0.04 * range.width()
                           : 0.1 * std::abs(range.low);
  return {range.low - wider, range.high + wider};
}

/// The values of all series along one axis, in a readable unit.
struct Direction {
  ReadableUnit in;
  Range range;
};

Direction direction(const Chart& chart, const ChartAxis& axis, std::vector<double> Series::*values) {
  Range range;
  for (const Series& series : chart.series)
    for (const double value : series.*values) range.include(value);
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

/// Numbers of the styles of all series, and which series are the first of theirs.
struct Styles {
  std::vector<std::size_t> number, first;

  explicit Styles(const std::vector<Series>& all) {
    std::map<std::size_t, std::size_t> style_of_group;
    for (std::size_t n = 0; n < all.size(); ++n) {
      const auto known = all[n].group ? style_of_group.find(*all[n].group) : style_of_group.end();
      number.push_back(known != style_of_group.end() ? known->second : first.size());
      if (known != style_of_group.end()) continue;
      if (all[n].group) style_of_group[*all[n].group] = first.size();
      first.push_back(n);
    }
  }
};

constexpr double kSample = 34, kLegendGap = 8, kLine = 1.6 * kTextHeight;  // of the legend (canvas units)

/// Names of the series below the axes, in as many columns as fit.
struct Legend {
  std::vector<std::string> texts;
  std::size_t columns = 1;
  double column_width = 0;  // px

  Legend(Canvas& canvas, const Chart& chart, const Styles& styles, double width) {
    const std::size_t count = styles.first.size();
    if (count < 2) return;
    const double u = canvas.unit();
    for (const std::size_t n : styles.first)
      column_width = std::max(column_width, canvas.text_width(chart.series[n].name, kTextHeight * u));
    column_width = std::min(width, column_width + (kSample + 3 * kLegendGap) * u);
    columns = std::max<std::size_t>(1, static_cast<std::size_t>(width / column_width));
    constexpr std::size_t kMostRows = 8;
    for (const std::size_t n : styles.first) {
      if (texts.size() + 1 == kMostRows * columns && count > texts.size() + 1) {
        texts.push_back(fmt::format("… and {} more", count - texts.size()));
        break;
      }
      texts.push_back(chart.series[n].name);
    }
  }

  [[nodiscard]] double height(double unit) const {
    const std::size_t rows = (texts.size() + columns - 1) / columns;
    return static_cast<double>(rows) * kLine * unit;
  }

  void draw(Canvas& canvas, Pixel corner) const {
    const double u = canvas.unit();
    for (std::size_t n = 0; n < texts.size(); ++n) {
      const std::size_t row = n / columns, column = n % columns;
      const double left = corner.x + static_cast<double>(column) * column_width;
      const double line = corner.y + (static_cast<double>(row) + 0.5) * kLine * u;
      const Style style = style_of(n, u);
      canvas.line(std::array{Pixel{left, line}, Pixel{left + kSample * u, line}}, style.colour, 1.8 * u,
                  style.dashes);
      canvas.fitted_text({left + (kSample + kLegendGap) * u, line + 0.36 * kTextHeight * u}, texts[n],
                         kTextHeight * u, column_width - (kSample + 2 * kLegendGap) * u);
    }
  }
};

}  // namespace

std::string draw_chart(const Chart& chart, PictureSize size, const std::filesystem::path& path) {
  Canvas canvas(size, unit_of(size), path);
  const double u = canvas.unit(), padding = kPadding * u;
  const Direction x = direction(chart, chart.x, &Series::x), y = direction(chart, chart.y, &Series::y);
  const Styles styles(chart.series);
  const Legend legend(canvas, chart, styles, size.width - 2 * padding);
  Axes axes{.corner = {0, title_room(canvas, false)}, .x = x.range, .y = y.range};
  axes.height = size.height - axes.corner.y - room_below(canvas) - padding - legend.height(u);
  axes.corner.x = padding + room_left(canvas, axes.y, axes.height);
  axes.width = size.width - axes.corner.x - 2 * padding;
  axes.x_label = x.in.label(chart.x.name);
  axes.y_label = y.in.label(chart.y.name);
  axes.grid = true;
  axes.draw(canvas);
  draw_title(canvas, chart.title, "");
  canvas.show_only(axes.corner, axes.width, axes.height);
  for (std::size_t n = 0; n < chart.series.size(); ++n)
    draw_series(canvas, axes, chart.series[n], style_of(styles.number[n], u), {x.in.factor, y.in.factor});
  canvas.show_all();
  legend.draw(canvas, {padding, axes.corner.y + axes.height + room_below(canvas)});
  return canvas.finish();
}

}  // namespace riven
