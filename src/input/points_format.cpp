#include "input/points_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace riven {
namespace {

using kind::Quantities;
using kind::Quantity;

constexpr double endless = std::numeric_limits<double>::infinity();

Format describe_edges(PointsInput& points) {
  return {
      .doc =
          "The rectangle or box that the points fill, centred at the origin unless `from` is given. Only "
          "with "
          "it the body has edges that loads and probes may name.",
      .keys = {Key{"size", Quantities{&points.size, dimension::length, positive, 3},
                   "Its edges along the axes; as many as the body has dimensions."}
                   .required(),
               Key{"from", Quantities{&points.from, dimension::length, any_number, 3}, "Its lower corner."}}};
}

Box given_box(const PointsInput& points, const Check& check) {
  Box box{{}, {endless, endless, endless}};
  const auto dimension = static_cast<std::size_t>(points.list->dimension);
  const auto expect = [&](const char* key, std::size_t found) {
    if (found != dimension)
      check.fail("box", fmt::format("{} has {} entries; expected {}, as the file has columns {}", key, found,
                                    dimension, dimension == 3 ? "x, y, z" : "x, y"));
  };
  expect("size", points.size.size());
  if (!points.from.empty()) expect("from", points.from.size());
  for (std::size_t i = 0; i < dimension; ++i) {
    box.half_size[i] = points.size[i] / 2;
    if (!points.from.empty()) box.center[i] = points.from[i] + box.half_size[i];
  }
  return box;
}

/// Half a spacing beyond the outermost points: where the body ends, as well as points can tell.
Box box_around(const PointList& points, double spacing) {
  Box box{{}, {endless, endless, endless}};
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(points.dimension); ++axis) {
    const auto [low, high] =
        std::minmax_element(points.position.begin(), points.position.end(),
                            [&](const Point& a, const Point& b) { return a[axis] < b[axis]; });
    box.half_size[axis] = ((*high)[axis] - (*low)[axis] + spacing) / 2;
    box.center[axis] = ((*high)[axis] + (*low)[axis]) / 2;
  }
  return box;
}

void check_thickness(const std::optional<double>& thickness, int dimension, const Check& check) {
  if (dimension == 2 && !thickness)
    check.fail("thickness", "missing; a body in two dimensions (columns x, y) needs it, such as \"10 mm\"");
  if (dimension == 3 && thickness)
    check.fail("thickness", "belongs to bodies in two dimensions; the file has columns x, y, z");
}

void read(GeometryInput& geometry, const std::optional<double>& thickness, const Case& c,
          const Check& check) {
  PointsInput& points = *geometry.points;
  const auto in_file = [&](const auto& run) {
    try {
      run();
    } catch (const InputError& wrong) {
      check.fail("file", wrong.what());
    }
  };
  in_file([&] {
    points.list = std::make_shared<const PointList>(
        read_points(c.file.parent_path() / points.file, thickness.value_or(1)));
  });
  check_thickness(thickness, points.list->dimension, check);
  in_file([&] { check_volumes(*points.list, thickness.value_or(1)); });
  geometry.dimension = points.list->dimension;
  geometry.thickness = thickness.value_or(1);
  geometry.spacing = points.list->spacing(geometry.thickness);
  geometry.open_faces.fill(!points.has_edges());
  const Box box = points.has_edges() ? given_box(points, check) : box_around(*points.list, geometry.spacing);
  geometry.shape = box;
  in_file([&] {
    check_inside(*points.list, box, geometry.spacing);
    check_apart(*points.list, geometry.spacing);
  });
}

}  // namespace

Format describe_points(GeometryInput& geometry, const Case& c) {
  if (!geometry.points) geometry.points.emplace();
  PointsInput& points = *geometry.points;
  const auto thickness = std::make_shared<std::optional<double>>();
  if (points.list && geometry.dimension == 2) *thickness = geometry.thickness;
  return {.doc =
              "Points anywhere, from a CSV file with the columns x, y, in three dimensions z, and `volume`, "
              "or in two "
              "dimensions `area`, each with its unit, as in `x [mm], y [mm], volume [mm^3]`; further columns "
              "are ignored. "
              "`dx` is their mean spacing, (mean volume / thickness)^(1/2), or (mean volume)^(1/3). Points "
              "in a hole are "
              "dropped and points in an inclusion, or closer to it than 0.15 dx, are part of it; all others "
              "keep their "
              "volumes.",
          .keys = {Key{"file", kind::Text{&points.file}, "CSV file, relative to the case file."}.required(),
                   Key{"thickness", Quantity{thickness.get(), dimension::length, positive},
                       "Two dimensions only: the body's thickness."},
                   Key{"box",
                       kind::Table{[&points] { return describe_edges(points); },
                                   [&points] { return points.has_edges(); }},
                       "Where the body ends: needed for loads on edges."}},
          .finish = [thickness, &geometry, &c](const Check& check) { read(geometry, *thickness, c, check); }};
}

}  // namespace riven
