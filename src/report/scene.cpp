#include "report/scene.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "report/outer_sides.hpp"
#include "report/point_raster.hpp"
#include "report/what_to_show.hpp"

namespace riven {

namespace {

std::vector<Point> displaced(const PointCloud& cloud, double scale) {
  std::vector<Point> places = cloud.positions;
  const PointField* u = find_field(cloud, "displacement");
  if (u == nullptr) return places;
  if (u->components != 3)
    throw InputError(fmt::format("field \"displacement\" has {} components; expected 3", u->components));
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) places[i][a] += scale * u->values[3 * i + a];
  return places;
}

/// From metres on the plane of view to pixels of a raster that a frame fills.
struct ToRaster {
  const Frame& frame;
  double scale;  // px per metre

  [[nodiscard]] Pixel operator()(const Point& place) const {
    return {scale * (place[0] - frame.across.low), scale * (frame.up.high - place[1])};
  }
};

}  // namespace

void Frame::include(const Frame& other) {
  across.include(other.across);
  up.include(other.up);
}

Scene::Scene(const PointCloud& cloud, double scale)
    : positions_(cloud.positions), projection_(cloud.positions) {
  const std::vector<Point> deformed = displaced(cloud, scale);
  cells_ = point_shapes(positions_, deformed, projection_.axes());
  for (const Point& place : deformed) places_.push_back(projection_(place));
  for (Cells& cells : outer_sides(cloud.cells))
    if (cells.kind != CellKind::line) mesh_.push_back(std::move(cells));
}

/// The part of the gradient in the plane of view, times the spacing (m). A cell that is turned over or
/// pressed to nothing is shown as it was.
std::array<double, 4> Scene::cell(std::size_t i) const {
  const double spacing = cells_.shapes[i].spacing;
  const auto& f = cells_.shapes[i].gradient;
  const std::size_t a = projection_.axes()[0], b = projection_.axes()[1];
  const double xx = f[3 * a + a], xy = f[3 * a + b], yx = f[3 * b + a], yy = f[3 * b + b];
  constexpr double kFlat = 1e-3;
  if (xx * yy - xy * yx < kFlat) return {spacing, 0, 0, spacing};
  return {spacing * xx, spacing * xy, spacing * yx, spacing * yy};
}

/// Radius of a sphere (m) that leaves no gap to its neighbours.
double Scene::radius(std::size_t i) const {
  constexpr double kOfSpacing = 0.7;
  const auto& f = cells_.shapes[i].gradient;
  const double volume = f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
                        f[2] * (f[3] * f[7] - f[4] * f[6]);
  return kOfSpacing * cells_.shapes[i].spacing * std::cbrt(std::clamp(std::abs(volume), 0.1, 10.0));
}

/// Where a square cell ends, in its widths: beyond its half where a neighbour is joined to it.
std::array<double, 4> Scene::sides(std::size_t i) const {
  std::array<double, 4> sides{};
  for (std::size_t n = 0; n < 4; ++n)
    sides[n] = cells_.shapes[i].joined[2 * projection_.axes()[n / 2] + n % 2] ? kJoinedSide : kFreeSide;
  return sides;
}

/// Whether neighbours hide a point of a solid from all sides.
bool Scene::hidden(std::size_t i) const {
  const auto& joined = cells_.shapes[i].joined;
  return std::all_of(joined.begin(), joined.end(), [](bool is) { return is; });
}

/// How far a point's own cell goes to the right and up, in part of its `widths` to each side (m).
std::array<double, 2> Scene::reach(std::size_t i, double widths) const {
  if (projection_.dimension() == 1) return {0, 0};
  if (projection_.dimension() == 3) return {radius(i), radius(i)};
  const auto [xx, xy, yx, yy] = cell(i);
  if (cells_.on_lattice)
    return {widths * (std::abs(xx) + std::abs(xy)), widths * (std::abs(yx) + std::abs(yy))};
  return {kDiscReach * std::hypot(xx, xy), kDiscReach * std::hypot(yx, yy)};
}

Frame Scene::frame() const {
  Frame frame;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const auto [across, up] = mesh_.empty() ? reach(i, kFreeSide) : std::array<double, 2>{};
    for (const double side : {-1.0, 1.0}) {
      frame.across.include(places_[i][0] + side * across);
      frame.up.include(places_[i][1] + side * up);
    }
  }
  return frame;
}

Point Scene::size() const {
  std::array<Range, 3> extent;
  double spacing = 0;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    if (mesh_.empty()) spacing = std::max(spacing, cells_.shapes[i].spacing);
    for (std::size_t a = 0; a < 3; ++a) extent[a].include(positions_[i][a]);
  }
  return {extent[0].width() + spacing, extent[1].width() + spacing, extent[2].width() + spacing};
}

Raster Scene::drawn(const Frame& frame, int width, int height,
                    const std::function<Colour(std::size_t)>& colour) const {
  // The longer side is rounded to whole pixels by the lesser part.
  const ToRaster to{frame, width > height ? width / frame.across.width() : height / frame.up.width()};
  if (!mesh_.empty()) {
    std::vector<Pixel> places;
    for (const Point& place : places_) places.push_back(to(place));
    return drawn_mesh(places, to.scale, width, height, colour);
  }
  if (projection_.dimension() == 3) {
    std::vector<Sphere> spheres;
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (!hidden(i))
        spheres.push_back({to(places_[i]), to.scale * places_[i][2], to.scale * radius(i), colour(i)});
    return raster_of(spheres, width, height);
  }
  std::vector<Tile> tiles;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const auto [xx, xy, yx, yy] = cell(i);
    const double per_pixel = 1 / (to.scale * (xx * yy - xy * yx));  // pixels count downwards, hence the signs
    const auto [across, up] = reach(i, kJoinedSide);
    tiles.push_back({to(places_[i]),
                     {per_pixel * yy, per_pixel * xy, -per_pixel * yx, -per_pixel * xx},
                     sides(i),
                     {to.scale * across, to.scale * up},
                     colour(i)});
  }
  return raster_of(tiles, cells_.on_lattice, width, height);
}

/// Triangles, and quads as two, their brightness by how they face the viewer.
Raster Scene::drawn_mesh(const std::vector<Pixel>& places, double scale, int width, int height,
                         const std::function<Colour(std::size_t)>& colour) const {
  constexpr double kDark = 0.6;  // seen from the side
  std::vector<Facet> facets;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    Facet facet;
    for (std::size_t n = 0; n < 3; ++n) {
      const std::size_t node = std::array{a, b, c}[n];
      facet.corner[n] = {places[node], scale * places_[node][2], colour(node)};
    }
    const Eigen::Vector3d from(places_[a].data());
    const Eigen::Vector3d normal =
        (Eigen::Vector3d(places_[b].data()) - from).cross(Eigen::Vector3d(places_[c].data()) - from);
    facet.light = kDark + (1 - kDark) * std::abs(normal.z()) / normal.norm();
    if (std::isfinite(facet.light)) facets.push_back(facet);
  };
  for (const Cells& cells : mesh_)
    for (std::size_t n = 0; n < cells.nodes.size(); n += corners(cells.kind)) {
      const auto node = [&](std::size_t corner) { return cells.nodes[n + corner]; };
      add(node(0), node(1), node(2));
      if (cells.kind == CellKind::quad) add(node(0), node(2), node(3));
    }
  return raster_of(facets, width, height);
}

}  // namespace riven
