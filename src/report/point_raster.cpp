#include "report/point_raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace riven {

namespace {

/// Finer than the picture by this factor in both directions; averaged afterwards, which smooths edges.
constexpr int kFiner = 2;

/// Pixels with what decides which colour they take: the smallest wins.
class Layers {
 public:
  Layers(int width, int height)
      : width_(kFiner * width),
        height_(kFiner * height),
        order_(size(), std::numeric_limits<float>::infinity()),
        colours_(size(), kWhite) {}

  /// Calls `cover(dx, dy)` for the pixels within `reach` of a centre (px of the picture), which gives the
  /// order and the colour of what covers the pixel; an infinite order: nothing.
  template <class Cover>
  void paint(Pixel centre, Pixel reach, const Cover& cover) {
    if (!std::isfinite(centre.x + centre.y)) return;  // of a run that went wrong
    const auto range = [](double at, double half, int limit) {
      const double low = std::floor(kFiner * (at - half)), high = std::ceil(kFiner * (at + half));
      return std::pair(static_cast<int>(std::clamp(low, 0.0, double(limit))),
                       static_cast<int>(std::clamp(high, 0.0, double(limit))));
    };
    const auto [left, right] = range(centre.x, reach.x, width_);
    const auto [top, bottom] = range(centre.y, reach.y, height_);
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) {
        const auto [order, colour] = cover((x + 0.5) / kFiner - centre.x, (y + 0.5) / kFiner - centre.y);
        const std::size_t at =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
        if (order >= order_[at]) continue;
        order_[at] = order;
        colours_[at] = colour;
      }
  }

  [[nodiscard]] Raster averaged() const {
    Raster raster{width_ / kFiner, height_ / kFiner, {}};
    raster.pixels.reserve(size() / kFiner / kFiner);
    for (int y = 0; y < raster.height; ++y)
      for (int x = 0; x < raster.width; ++x) raster.pixels.push_back(mean(kFiner * x, kFiner * y));
    return raster;
  }

 private:
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }

  [[nodiscard]] Colour mean(int left, int top) const {
    std::array<int, 3> sum{};
    for (int y = top; y < top + kFiner; ++y)
      for (int x = left; x < left + kFiner; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          sum[c] += colours_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                             static_cast<std::size_t>(x)][c];
    constexpr int kPixels = kFiner * kFiner;
    Colour mean{};
    for (std::size_t c = 0; c < 3; ++c) mean[c] = static_cast<std::uint8_t>((sum[c] + kPixels / 2) / kPixels);
    return mean;
  }

  int width_, height_;
  std::vector<float> order_;
  std::vector<Colour> colours_;
};

constexpr std::pair<float, Colour> kNothing = {std::numeric_limits<float>::infinity(), kWhite};

// Pixels on the edge that two facets share belong to one of them, whatever rounding says.
constexpr double kOnEdge = 1e-9;

Colour shaded(Colour colour, double light) {
  for (auto& part : colour) part = static_cast<std::uint8_t>(std::lround(light * part));
  return colour;
}

}  // namespace

Raster raster_of(std::span<const Tile> tiles, bool square, int width, int height) {
  Layers layers(width, height);
  for (const Tile& tile : tiles) {
    layers.paint(tile.centre, tile.reach, [&](double dx, double dy) {
      const auto& [xx, xy, yx, yy] = tile.inverse;
      const double x = xx * dx + xy * dy, y = yx * dx + yy * dy;
      const auto& [left, right, lower, upper] = tile.sides;
      const bool inside = square ? -left <= x && x <= right && -lower <= y && y <= upper
                                 : x * x + y * y <= kDiscReach * kDiscReach;
      return inside ? std::pair(static_cast<float>(x * x + y * y), tile.colour) : kNothing;
    });
  }
  return layers.averaged();
}

Raster raster_of(std::span<const Sphere> spheres, int width, int height) {
  // Light from the upper left and front, of length 1; what it does not reach is not black.
  constexpr double kLightX = -0.45, kLightY = -0.55, kLightZ = 0.7036, kDark = 0.72;
  Layers layers(width, height);
  for (const Sphere& sphere : spheres)
    layers.paint(sphere.centre, {sphere.radius, sphere.radius}, [&](double dx, double dy) {
      const double x = dx / sphere.radius, y = dy / sphere.radius, across = 1 - x * x - y * y;
      if (across < 0) return kNothing;
      const double z = std::sqrt(across), light = std::max(0.0, kLightX * x + kLightY * y + kLightZ * z);
      return std::pair(static_cast<float>(-(sphere.depth + z * sphere.radius)),
                       shaded(sphere.colour, kDark + (1 - kDark) * light));
    });
  return layers.averaged();
}

Raster raster_of(std::span<const Facet> facets, int width, int height) {
  Layers layers(width, height);
  for (const Facet& facet : facets) {
    const auto& [a, b, c] = facet.corner;
    const auto [left, right] = std::minmax({a.at.x, b.at.x, c.at.x});
    const auto [top, bottom] = std::minmax({a.at.y, b.at.y, c.at.y});
    const Pixel centre{0.5 * (left + right), 0.5 * (top + bottom)};
    const double whole = (b.at.x - a.at.x) * (c.at.y - a.at.y) - (b.at.y - a.at.y) * (c.at.x - a.at.x);
    if (whole == 0) continue;
    layers.paint(centre, {0.5 * (right - left), 0.5 * (bottom - top)}, [&](double dx, double dy) {
      const double x = centre.x + dx - a.at.x, y = centre.y + dy - a.at.y;
      const double at_b = (x * (c.at.y - a.at.y) - y * (c.at.x - a.at.x)) / whole,
                   at_c = (y * (b.at.x - a.at.x) - x * (b.at.y - a.at.y)) / whole, at_a = 1 - at_b - at_c;
      if (std::min({at_a, at_b, at_c}) < -kOnEdge) return kNothing;
      Colour colour{};
      for (std::size_t n = 0; n < colour.size(); ++n)
        colour[n] = static_cast<std::uint8_t>(std::clamp(
            std::lround(facet.light * (at_a * a.colour[n] + at_b * b.colour[n] + at_c * c.colour[n])), 0L,
            255L));
      return std::pair(static_cast<float>(-(at_a * a.depth + at_b * b.depth + at_c * c.depth)), colour);
    });
  }
  return layers.averaged();
}

}  // namespace riven
