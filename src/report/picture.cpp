#include "report/picture.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/axes.hpp"
#include "report/colour_bar.hpp"
#include "report/what_to_show.hpp"

namespace riven {

namespace {

/// What a picture shows, decided: nothing is left to a default.
struct Shown {
  const Scalar& scalar;
  const ColourMap& map;
  Range values;  // of the colours (SI)
  Frame frame;   // m
  ReadableUnit unit;
  const PictureSettings& settings;
  std::string subtitle;

  [[nodiscard]] Colour colour(std::size_t i) const {
    return map.at((scalar.values[i] - values.low) / values.width());
  }
  [[nodiscard]] Range scaled_values() const { return {unit.factor * values.low, unit.factor * values.high}; }
  [[nodiscard]] std::string label() const { return unit.label(scalar.label); }
  [[nodiscard]] ColourBar bar(bool upwards) const {
    const Range there = range_of(scalar.values);
    return {map, scaled_values(), {unit.factor * there.low, unit.factor * there.high}, label(), upwards};
  }
};

Range widened(const Range& range, double by) {
  return {range.low - by, range.high + by};
}

constexpr double kMargin = 0.04;  // around a body or a curve

std::string size_text(const Point& size) {
  const ReadableUnit in = readable_unit("m", *std::max_element(size.begin(), size.end()));
  return fmt::format("{:.4g} × {:.4g} × {:.4g} {}", in.factor * size[0], in.factor * size[1],
                     in.factor * size[2], in.unit);
}

/// What stands under the title.
std::string subtitle(const Scene& scene, const PictureSettings& settings) {
  std::vector<std::string> parts;
  if (!settings.state.empty()) parts.push_back(settings.state);
  if (settings.scale != 1) parts.push_back(fmt::format("displacements × {:g}", settings.scale));
  if (scene.projection().dimension() == 3) parts.push_back("body of " + size_text(scene.size()));
  return fmt::format("{}", fmt::join(parts, ", "));
}

Shown decide(const Scene& scene, const Scalar& scalar, const PictureSettings& settings) {
  const bool is_curve = scene.projection().dimension() == 1;  // which shows all values
  const Range shown = settings.values.empty() ? colour_range(scalar, is_curve) : settings.values;
  const ColourMap& map = settings.map != nullptr ? *settings.map : natural_map(shown);
  Frame frame = settings.frame.across.empty() ? scene.frame() : settings.frame;
  // A flat body has no height of its own, and one point no size at all.
  constexpr double kLeast = 1e-9;
  const double margin = std::max(kLeast, kMargin * (scene.projection().dimension() == 1
                                                        ? frame.across.width()
                                                        : std::min(frame.across.width(), frame.up.width())));
  frame = {widened(frame.across, margin), widened(frame.up, margin)};
  const double largest = std::max(std::abs(shown.low), std::abs(shown.high));
  return {
      scalar, map, shown, frame, readable_unit(scalar.unit, largest), settings, subtitle(scene, settings)};
}

/// Where things stand in a picture.
struct Layout {
  PictureSize size;
  double unit = 1;
  Axes axes;
  bool bar_upwards = true;
};

/// The largest frame of equal scales that fits, in the middle of the room it has.
Layout arrange(const Shown& shown, bool has_axes, const std::filesystem::path& path) {
  const PictureSettings& settings = shown.settings;
  Layout layout{.size = settings.size, .unit = settings.text * unit_of(settings.size)};
  Canvas canvas(settings.size, layout.unit, path);  // measures texts
  const double padding = kPadding * layout.unit;
  const double aspect = shown.frame.across.width() / shown.frame.up.width();
  constexpr double kWide = 1.6;
  layout.bar_upwards = aspect <= kWide;
  const double bar = shown.bar(layout.bar_upwards).room(canvas);

  Axes& axes = layout.axes;
  const ReadableUnit metres =
      readable_unit("m", std::max({std::abs(shown.frame.across.low), std::abs(shown.frame.across.high),
                                   std::abs(shown.frame.up.low), std::abs(shown.frame.up.high)}));
  axes.x = {metres.factor * shown.frame.across.low, metres.factor * shown.frame.across.high};
  axes.y = {metres.factor * shown.frame.up.low, metres.factor * shown.frame.up.high};
  axes.x_label = axes.y_label = metres.unit;

  const double top = title_room(canvas, !shown.subtitle.empty());
  const double left = padding + (has_axes ? room_left(canvas, axes.y, settings.size.height) : 0);
  const double right = padding + (layout.bar_upwards ? bar : 0);
  const double bottom = padding + (has_axes ? room_below(canvas) : 0) + (layout.bar_upwards ? 0 : bar);
  const double wide = settings.size.width - left - right, high = settings.size.height - top - bottom;
  const double scale = std::min(wide / shown.frame.across.width(), high / shown.frame.up.width());
  axes.width = std::round(scale * shown.frame.across.width());
  axes.height = std::round(scale * shown.frame.up.width());

  double spare_x = wide - axes.width, spare_y = high - axes.height;
  if (settings.trimmed) {
    constexpr double kLeast = 0.55;  // of the size: titles need room
    const auto cut = [](double spare, int length) { return std::clamp(spare, 0.0, (1 - kLeast) * length); };
    const double cut_x = cut(spare_x, layout.size.width), cut_y = cut(spare_y, layout.size.height);
    layout.size.width -= static_cast<int>(cut_x);
    layout.size.height -= static_cast<int>(cut_y);
    spare_x -= cut_x;
    spare_y -= cut_y;
  }
  axes.corner = {std::round(left + spare_x / 2), std::round(top + spare_y / 2)};
  return layout;
}

/// Which way x, y and z go, in the lower left corner.
void draw_triad(Canvas& canvas, const Projection& projection, Pixel corner) {
  constexpr double kLength = 38, kName = 1.3;
  constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
  const double u = canvas.unit();
  const Pixel origin{corner.x + kLength * u, corner.y - kLength * u};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Point direction{};
    direction[axis] = 1;
    const Point seen = projection(direction);
    const auto along = [&](double part) {
      return Pixel{origin.x + part * kLength * u * seen[0], origin.y - part * kLength * u * seen[1]};
    };
    canvas.segment(origin, along(1), kBlack, 1.5 * u);
    const Pixel name = along(kName);
    canvas.text({name.x, name.y + 0.36 * kTextHeight * u}, kNames[axis], kTextHeight * u, Align::centre);
  }
}

/// A body in one dimension: the field over the place.
std::string draw_curve(const PointCloud& cloud, const Scene& scene, const Shown& shown,
                       const std::filesystem::path& path) {
  const PictureSettings& settings = shown.settings;
  Canvas canvas(settings.size, settings.text * unit_of(settings.size), path);
  const double u = canvas.unit(), padding = kPadding * u;
  const Range colours = shown.scaled_values(), values = widened(colours, kMargin * colours.width());
  const ReadableUnit metres =
      readable_unit("m", std::max(std::abs(shown.frame.across.low), std::abs(shown.frame.across.high)));
  Axes axes{.corner = {0, title_room(canvas, !shown.subtitle.empty())},
            .y = values,
            .y_label = shown.label(),
            .grid = true};
  axes.x = {metres.factor * shown.frame.across.low, metres.factor * shown.frame.across.high};
  axes.x_label = metres.label(std::string(1, "xyz"[scene.projection().axes()[0]]));
  axes.height = settings.size.height - axes.corner.y - room_below(canvas) - padding;
  axes.corner.x = padding + room_left(canvas, axes.y, axes.height);
  axes.width = settings.size.width - axes.corner.x - 2 * padding;
  axes.draw(canvas);
  draw_title(canvas, settings.title, shown.subtitle);

  std::vector<std::size_t> order(cloud.positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const std::size_t along = scene.projection().axes()[0];
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return cloud.positions[a][along] < cloud.positions[b][along];
  });
  const auto place = [&](std::size_t i) {
    return axes.at(metres.factor * scene.places()[i][0], shown.unit.factor * shown.scalar.values[i]);
  };
  std::vector<Pixel> line;
  for (const std::size_t i : order) line.push_back(place(i));
  canvas.show_only(axes.corner, axes.width, axes.height);
  canvas.line(line, {150, 150, 150}, u);
  const double apart = axes.width / static_cast<double>(std::max<std::size_t>(order.size(), 1));
  for (const std::size_t i : order)
    canvas.disc(place(i), std::clamp(0.45 * apart, 1.5 * u, 4 * u), shown.colour(i));
  canvas.show_all();
  return canvas.finish();
}

}  // namespace

Frame frame_of(const PointCloud& cloud, double scale) {
  return Scene(cloud, scale).frame();
}

std::string draw_field(const PointCloud& cloud, const Scalar& scalar, const PictureSettings& settings,
                       const std::filesystem::path& path) {
  const Scene scene(cloud, settings.scale);
  const Shown shown = decide(scene, scalar, settings);
  if (scene.projection().dimension() == 1) return draw_curve(cloud, scene, shown, path);
  const bool has_axes = scene.projection().dimension() == 2;
  Layout layout = arrange(shown, has_axes, path);
  Canvas canvas(layout.size, layout.unit, path);
  draw_title(canvas, settings.title, shown.subtitle);
  Axes& axes = layout.axes;
  const Raster points = scene.drawn(shown.frame, static_cast<int>(axes.width), static_cast<int>(axes.height),
                                    [&](std::size_t i) { return shown.colour(i); });
  canvas.image(axes.corner, points.width, points.height, points);
  if (has_axes) {
    axes.x_label = fmt::format("{} [{}]", "xyz"[scene.projection().axes()[0]], axes.x_label);
    axes.y_label = fmt::format("{} [{}]", "xyz"[scene.projection().axes()[1]], axes.y_label);
    axes.draw(canvas);
  } else {
    draw_triad(canvas, scene.projection(), {axes.corner.x, axes.corner.y + axes.height});
  }
  const ColourBar bar = shown.bar(layout.bar_upwards);
  if (layout.bar_upwards) {
    bar.draw(canvas, {axes.corner.x + axes.width, axes.corner.y}, axes.height);
  } else {
    bar.draw(canvas, {axes.corner.x, axes.corner.y + axes.height + (has_axes ? room_below(canvas) : 0)},
             axes.width);
  }
  return canvas.finish();
}

std::string state_text(const Result& result, std::size_t state) {
  const double value = result.states[state].value;
  return result.parameter() == Parameter::time ? "t = " + readable(value, "s")
                                               : fmt::format("{} {:.6g}", name(result.parameter()), value);
}

}  // namespace riven
