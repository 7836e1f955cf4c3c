#include "report/picture.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "report/axes.hpp"
#include "report/point_raster.hpp"
#include "report/point_shape.hpp"
#include "report/projection.hpp"

namespace riven {

namespace {

const PointField* find_field(const PointCloud& cloud, const std::string& name) {
  for (const PointField& field : cloud.fields)
    if (field.name == name) return &field;
  return nullptr;
}

std::vector<Point> displaced(const PointCloud& cloud, double scale) {
  std::vector<Point> places = cloud.positions;
  if (const PointField* u = find_field(cloud, "displacement"))
    for (std::size_t i = 0; i < places.size(); ++i)
      for (std::size_t a = 0; a < 3; ++a) places[i][a] += scale * u->values[3 * i + a];
  return places;
}

/// The points of a cloud as the viewer sees them (m).
struct Scene {
  Projection projection;
  PointShapes cells;
  std::vector<Point> places;  // on the plane of view

  Scene(const PointCloud& cloud, double scale) : projection(cloud.positions) {
    const std::vector<Point> deformed = displaced(cloud, scale);
    cells = point_shapes(cloud.positions, deformed, projection.axes());
    for (const Point& place : deformed) places.push_back(projection(place));
  }

  /// The part of the gradient in the plane of view, times the spacing (m). A cell that is turned over or
  /// pressed to nothing is shown as it was.
  [[nodiscard]] std::array<double, 4> cell(std::size_t i) const {
    const double spacing = cells.shapes[i].spacing;
    const auto& f = cells.shapes[i].gradient;
    const std::size_t a = projection.axes()[0], b = projection.axes()[1];
    const double xx = f[3 * a + a], xy = f[3 * a + b], yx = f[3 * b + a], yy = f[3 * b + b];
    constexpr double kFlat = 1e-3;
    if (xx * yy - xy * yx < kFlat) return {spacing, 0, 0, spacing};
    return {spacing * xx, spacing * xy, spacing * yx, spacing * yy};
  }

  /// Radius of a sphere (m) that leaves no gap to its neighbours.
  [[nodiscard]] double radius(std::size_t i) const {
    constexpr double kOfSpacing = 0.7;
    const auto& f = cells.shapes[i].gradient;
    const double volume = f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
                          f[2] * (f[3] * f[7] - f[4] * f[6]);
    return kOfSpacing * cells.shapes[i].spacing * std::cbrt(std::clamp(std::abs(volume), 0.1, 10.0));
  }

  /// Where a square cell ends, in its widths: beyond its half where a neighbour is joined to it.
  [[nodiscard]] std::array<double, 4> sides(std::size_t i) const {
    std::array<double, 4> sides{};
    for (std::size_t n = 0; n < 4; ++n)
      sides[n] = cells.shapes[i].joined[2 * projection.axes()[n / 2] + n % 2] ? kJoinedSide : kFreeSide;
    return sides;
  }

  /// Whether neighbours hide a point of a solid from all sides.
  [[nodiscard]] bool hidden(std::size_t i) const {
    const auto& joined = cells.shapes[i].joined;
    return std::all_of(joined.begin(), joined.end(), [](bool is) { return is; });
  }

  /// How far a point's own cell goes to the right and up, in part of its `widths` to each side (m).
  [[nodiscard]] std::array<double, 2> reach(std::size_t i, double widths) const {
    if (projection.dimension() == 1) return {0, 0};
    if (projection.dimension() == 3) return {radius(i), radius(i)};
    const auto [xx, xy, yx, yy] = cell(i);
    if (cells.on_lattice)
      return {widths * (std::abs(xx) + std::abs(xy)), widths * (std::abs(yx) + std::abs(yy))};
    return {kDiscReach * std::hypot(xx, xy), kDiscReach * std::hypot(yx, yy)};
  }

  [[nodiscard]] Frame frame() const {
    Frame frame;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto [across, up] = reach(i, kFreeSide);
      for (const double side : {-1.0, 1.0}) {
        frame.across.include(places[i][0] + side * across);
        frame.up.include(places[i][1] + side * up);
      }
    }
    return frame;
  }
};

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
};

Range range_of(const std::vector<double>& values) {
  Range range;
  for (const double value : values) range.include(value);
  return range;
}

/// Beyond zero by more than rounding, to both sides.
bool of_both_signs(const Range& range) {
  constexpr double kPart = 0.01;
  return range.low < -kPart * range.high && range.high > -kPart * range.low;
}

Range widened(const Range& range, double by) {
  return {range.low - by, range.high + by};
}

constexpr double kMargin = 0.04;  // around a body or a curve

/// What all but the outermost points have, if a few of them have far more: the field elsewhere would show in
/// one colour. Numbers without a unit, such as damage, keep their range.
Range typical_range(const Scalar& scalar) {
  const Range whole = range_of(scalar.values);
  constexpr double kOutermost = 0.002, kFar = 0.6;
  std::vector<double> values = scalar.values;
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (!scalar.unit.empty() && !values.empty()) {
    const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
    const auto cut = static_cast<std::ptrdiff_t>(kOutermost * static_cast<double>(last));
    const auto at = [&](std::ptrdiff_t place) {
      std::nth_element(values.begin(), values.begin() + place, values.end());
      return values[static_cast<std::size_t>(place)];
    };
    const Range most{at(cut), at(last - cut)};
    if (most.width() > 0 && most.width() < kFar * whole.width()) return most;
  }
  return whole;
}

/// "40 x 40 x 20 mm": the undeformed body with its outermost cells.
std::string size_text(const PointCloud& cloud, const Scene& scene) {
  std::array<Range, 3> extent;
  double spacing = 0;
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    spacing = std::max(spacing, scene.cells.shapes[i].spacing);
    for (std::size_t a = 0; a < 3; ++a) extent[a].include(cloud.positions[i][a]);
  }
  std::array<double, 3> size{};
  for (std::size_t a = 0; a < 3; ++a) size[a] = extent[a].width() + spacing;
  const ReadableUnit in = readable_unit("m", *std::max_element(size.begin(), size.end()));
  return fmt::format("{:.4g} × {:.4g} × {:.4g} {}", in.factor * size[0], in.factor * size[1],
                     in.factor * size[2], in.unit);
}

/// What stands under the title.
std::string subtitle(const PointCloud& cloud, const Scene& scene, const PictureSettings& settings) {
  std::vector<std::string> parts;
  if (!settings.state.empty()) parts.push_back(settings.state);
  if (settings.scale != 1) parts.push_back(fmt::format("displacements × {:g}", settings.scale));
  if (scene.projection.dimension() == 3) parts.push_back("body of " + size_text(cloud, scene));
  return fmt::format("{}", fmt::join(parts, ", "));
}

Shown decide(const PointCloud& cloud, const Scene& scene, const Scalar& scalar,
             const PictureSettings& settings) {
  const Range shown = settings.values.empty() ? colour_range(scalar) : settings.values;
  const ColourMap& map = settings.map != nullptr ? *settings.map
                         : of_both_signs(shown)  ? colour_map("purple-orange")
                                                 : colour_maps().front();
  Frame frame = settings.frame.across.empty() ? scene.frame() : settings.frame;
  // A flat body has no height of its own.
  const double margin =
      kMargin * (scene.projection.dimension() == 1 ? frame.across.width()
                                                   : std::min(frame.across.width(), frame.up.width()));
  frame = {widened(frame.across, margin), widened(frame.up, margin)};
  const double largest = std::max(std::abs(shown.low), std::abs(shown.high));
  return {scalar,
          map,
          shown,
          frame,
          readable_unit(scalar.unit, largest),
          settings,
          subtitle(cloud, scene, settings)};
}

// The colour bar (canvas units): its thickness, its gap to the axes, and to its numbers.
constexpr double kBar = 16, kBarGap = 22, kNumberGap = 7, kTickLength = 4;

/// Where things stand in a picture.
struct Layout {
  PictureSize size;
  double unit = 1;
  Axes axes;
  bool bar_below = false;
};

/// The room that the colour bar and its numbers take (px).
double bar_room(Canvas& canvas, const Shown& shown, bool below) {
  const double u = canvas.unit();
  if (below) return (kBarGap + kBar + kNumberGap + 2.6 * kTextHeight) * u;
  double widest = 0;
  for (const std::string& text :
       tick_texts(ticks(shown.scaled_values(), ticks_along(canvas, canvas.size().height))))
    widest = std::max(widest, canvas.text_width(text, kTextHeight * u));
  return widest + (kBarGap + kBar + 2 * kNumberGap + 1.3 * kTextHeight) * u;
}

/// The largest frame of equal scales that fits, in the middle of the room it has.
Layout arrange(const Shown& shown, bool has_axes, const std::filesystem::path& path) {
  const PictureSettings& settings = shown.settings;
  Layout layout{.size = settings.size, .unit = settings.text * unit_of(settings.size)};
  Canvas canvas(settings.size, layout.unit, path);  // measures texts
  const double padding = kPadding * layout.unit;
  const double aspect = shown.frame.across.width() / shown.frame.up.width();
  constexpr double kWide = 1.6;
  layout.bar_below = aspect > kWide;

  Axes& axes = layout.axes;
  const ReadableUnit metres =
      readable_unit("m", std::max({std::abs(shown.frame.across.low), std::abs(shown.frame.across.high),
                                   std::abs(shown.frame.up.low), std::abs(shown.frame.up.high)}));
  axes.x = {metres.factor * shown.frame.across.low, metres.factor * shown.frame.across.high};
  axes.y = {metres.factor * shown.frame.up.low, metres.factor * shown.frame.up.high};
  axes.x_label = axes.y_label = metres.unit;

  const double top = title_room(canvas, !shown.subtitle.empty());
  const double left = padding + (has_axes ? room_left(canvas, axes.y, settings.size.height) : 0);
  const double right = padding + (layout.bar_below ? 0 : bar_room(canvas, shown, false));
  const double bottom =
      padding + (has_axes ? room_below(canvas) : 0) + (layout.bar_below ? bar_room(canvas, shown, true) : 0);
  const double wide = settings.size.width - left - right, high = settings.size.height - top - bottom;
  const double scale = std::min(wide / shown.frame.across.width(), high / shown.frame.up.width());
  axes.width = scale * shown.frame.across.width();
  axes.height = scale * shown.frame.up.width();

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

/// Points at the ends of the bar where values lie beyond them.
void draw_bar_ends(Canvas& canvas, Pixel corner, double width, double height, bool upwards,
                   const Shown& shown) {
  const Range values = range_of(shown.scalar.values);
  const double tip = 0.55 * kBar * canvas.unit(), bottom = corner.y + height, right = corner.x + width;
  const Pixel upper_left = corner, upper_right{right, corner.y}, lower_left{corner.x, bottom},
              lower_right{right, bottom};
  const Colour low = shown.map.at(0), high = shown.map.at(1);
  const double middle_x = corner.x + width / 2, middle_y = corner.y + height / 2;
  if (values.low < shown.values.low) {
    const Pixel end = upwards ? Pixel{middle_x, bottom + tip} : Pixel{corner.x - tip, middle_y};
    canvas.triangle(lower_left, upwards ? lower_right : upper_left, end, low, canvas.unit());
  }
  if (values.high > shown.values.high) {
    const Pixel end = upwards ? Pixel{middle_x, corner.y - tip} : Pixel{right + tip, middle_y};
    canvas.triangle(upper_right, upwards ? upper_left : lower_right, end, high, canvas.unit());
  }
}

/// The colours from one end to the other, upwards or to the right.
Raster bar_colours(const ColourMap& map, bool upwards) {
  constexpr int kSteps = 256;
  Raster raster{upwards ? 1 : kSteps, upwards ? kSteps : 1, {}};
  for (int n = 0; n < kSteps; ++n) {
    const int step = upwards ? kSteps - 1 - n : n;
    raster.pixels.push_back(map.at(step / (kSteps - 1.0)));
  }
  return raster;
}

void draw_bar_beside(Canvas& canvas, const Layout& layout, const Shown& shown) {
  const double u = canvas.unit();
  const Axes& axes = layout.axes;
  const Pixel corner{axes.corner.x + axes.width + kBarGap * u, axes.corner.y};
  draw_bar_ends(canvas, corner, kBar * u, axes.height, true, shown);
  canvas.image(corner, kBar * u, axes.height, bar_colours(shown.map, true));
  canvas.frame(corner, kBar * u, axes.height, kBlack, u);
  const Range values = shown.scaled_values();
  const std::vector<double> at = ticks(values, ticks_along(canvas, axes.height));
  const std::vector<std::string> texts = tick_texts(at);
  const double right = corner.x + kBar * u;
  double widest = 0;
  for (std::size_t n = 0; n < at.size(); ++n) {
    const double y = corner.y + axes.height * (values.high - at[n]) / values.width();
    canvas.segment({right, y}, {right + kTickLength * u, y}, kBlack, u);
    canvas.text({right + kNumberGap * u, y + 0.36 * kTextHeight * u}, texts[n], kTextHeight * u);
    widest = std::max(widest, canvas.text_width(texts[n], kTextHeight * u));
  }
  canvas.text_upwards({right + widest + (2 * kNumberGap + 0.8 * kTextHeight) * u, corner.y + axes.height / 2},
                      shown.label(), kTextHeight * u);
}

void draw_bar_below(Canvas& canvas, const Layout& layout, const Shown& shown, double room_of_axes) {
  const double u = canvas.unit();
  const Axes& axes = layout.axes;
  const Pixel corner{axes.corner.x, axes.corner.y + axes.height + room_of_axes + kBarGap * u};
  draw_bar_ends(canvas, corner, axes.width, kBar * u, false, shown);
  canvas.image(corner, axes.width, kBar * u, bar_colours(shown.map, false));
  canvas.frame(corner, axes.width, kBar * u, kBlack, u);
  const Range values = shown.scaled_values();
  const std::vector<double> at = ticks(values, ticks_along(canvas, axes.width));
  const std::vector<std::string> texts = tick_texts(at);
  const double bottom = corner.y + kBar * u;
  for (std::size_t n = 0; n < at.size(); ++n) {
    const double x = corner.x + axes.width * (at[n] - values.low) / values.width();
    canvas.segment({x, bottom}, {x, bottom + kTickLength * u}, kBlack, u);
    canvas.text({x, bottom + (kNumberGap + 0.75 * kTextHeight) * u}, texts[n], kTextHeight * u,
                Align::centre);
  }
  canvas.text({corner.x + axes.width / 2, bottom + (kNumberGap + 2.3 * kTextHeight) * u}, shown.label(),
              kTextHeight * u, Align::centre);
}

/// From metres on the plane of view to pixels of the raster that fills the axes.
class ToRaster {
 public:
  ToRaster(const Shown& shown, const Layout& layout)
      : frame_(shown.frame), scale_(layout.axes.width / shown.frame.across.width()) {}

  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] Pixel operator()(const Point& place) const {
    return {scale_ * (place[0] - frame_.across.low), scale_ * (frame_.up.high - place[1])};
  }

 private:
  const Frame& frame_;
  double scale_;
};

Tile tile_of(const Scene& scene, std::size_t i, const ToRaster& to, Colour colour) {
  const auto [xx, xy, yx, yy] = scene.cell(i);
  const double per_pixel = 1 / (to.scale() * (xx * yy - xy * yx));  // pixels count downwards, hence the signs
  const auto [across, up] = scene.reach(i, kJoinedSide);
  return {to(scene.places[i]),
          {per_pixel * yy, per_pixel * xy, -per_pixel * yx, -per_pixel * xx},
          scene.sides(i),
          {to.scale() * across, to.scale() * up},
          colour};
}

Raster draw_points(const Scene& scene, const Shown& shown, const Layout& layout) {
  const ToRaster to(shown, layout);
  const int width = static_cast<int>(std::lround(layout.axes.width)),
            height = static_cast<int>(std::lround(layout.axes.height));
  if (scene.projection.dimension() == 3) {
    std::vector<Sphere> spheres;
    for (std::size_t i = 0; i < scene.places.size(); ++i)
      if (!scene.hidden(i))
        spheres.push_back({to(scene.places[i]), to.scale() * scene.places[i][2], to.scale() * scene.radius(i),
                           shown.colour(i)});
    return raster_of(spheres, width, height);
  }
  std::vector<Tile> tiles;
  for (std::size_t i = 0; i < scene.places.size(); ++i)
    tiles.push_back(tile_of(scene, i, to, shown.colour(i)));
  return raster_of(tiles, scene.cells.on_lattice, width, height);
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
  axes.x_label = metres.label(std::string(1, "xyz"[scene.projection.axes()[0]]));
  axes.height = settings.size.height - axes.corner.y - room_below(canvas) - padding;
  axes.corner.x = padding + room_left(canvas, axes.y, axes.height);
  axes.width = settings.size.width - axes.corner.x - 2 * padding;
  axes.draw(canvas);
  draw_title(canvas, settings.title, shown.subtitle);

  std::vector<std::size_t> order(cloud.positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const std::size_t along = scene.projection.axes()[0];
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return cloud.positions[a][along] < cloud.positions[b][along];
  });
  const auto place = [&](std::size_t i) {
    return axes.at(metres.factor * scene.places[i][0], shown.unit.factor * shown.scalar.values[i]);
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

void Frame::include(const Frame& other) {
  across.include(other.across);
  up.include(other.up);
}

Frame frame_of(const PointCloud& cloud, double scale) {
  return Scene(cloud, scale).frame();
}

Range colour_range(const Scalar& scalar) {
  const Range values = typical_range(scalar);
  const double largest = values.empty() ? 0 : std::max(std::abs(values.low), std::abs(values.high));
  if (largest == 0) return {0, 1};
  if (of_both_signs(values)) return {-largest, largest};
  constexpr double kConstant = 1e-6;  // of the value: what is less is rounding
  if (values.width() > kConstant * largest) return values;
  return values.high > 0 ? Range{0, values.high} : Range{values.low, 0};
}

std::string draw_field(const PointCloud& cloud, const Scalar& scalar, const PictureSettings& settings,
                       const std::filesystem::path& path) {
  const Scene scene(cloud, settings.scale);
  const Shown shown = decide(cloud, scene, scalar, settings);
  if (scene.projection.dimension() == 1) return draw_curve(cloud, scene, shown, path);
  const bool has_axes = scene.projection.dimension() == 2;
  Layout layout = arrange(shown, has_axes, path);
  Canvas canvas(layout.size, layout.unit, path);
  draw_title(canvas, settings.title, shown.subtitle);
  Axes& axes = layout.axes;
  canvas.image(axes.corner, std::round(axes.width), std::round(axes.height),
               draw_points(scene, shown, layout));
  if (has_axes) {
    axes.x_label = fmt::format("{} [{}]", "xyz"[scene.projection.axes()[0]], axes.x_label);
    axes.y_label = fmt::format("{} [{}]", "xyz"[scene.projection.axes()[1]], axes.y_label);
    axes.draw(canvas);
  } else {
    draw_triad(canvas, scene.projection, {axes.corner.x, axes.corner.y + axes.height});
  }
  if (layout.bar_below) {
    draw_bar_below(canvas, layout, shown, has_axes ? room_below(canvas) : 0);
  } else {
    draw_bar_beside(canvas, layout, shown);
  }
  return canvas.finish();
}

std::string state_text(const Result& result, std::size_t state) {
  const double value = result.states[state].value;
  return result.parameter() == Parameter::time ? "t = " + readable(value, "s")
                                               : fmt::format("{} {:.6g}", name(result.parameter()), value);
}

std::string telling_field(const PointCloud& state, const PointCloud& first) {
  constexpr double kGrown = 0.01;  // of a point's bonds
  const PointField *now = find_field(state, "damage"), *before = find_field(first, "damage");
  if (now != nullptr && before != nullptr)
    for (std::size_t i = 0; i < std::min(now->values.size(), before->values.size()); ++i)
      if (now->values[i] > before->values[i] + kGrown) return "damage";
  for (const char* name : {"strain_energy_density", "nominal_stress", "displacement"})
    if (find_field(state, name) != nullptr) return name;
  if (state.fields.empty())
    throw InputError("the result has no fields to show; expected some in output.fields of its case");
  return state.fields.front().name;
}

}  // namespace riven
