#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "body/lattice_body.hpp"
#include "body/listed_body.hpp"
#include "input/set_format.hpp"
#include "simulation/build_parts.hpp"

namespace riven {

namespace {

constexpr std::size_t kFaces = 6;

/// Points of a shape's outline, close enough to tell whether it lies within a convex body.
std::vector<Point> outline(const Shape& shape) {
  std::vector<Point> points;
  if (const auto* box = std::get_if<Box>(&shape)) {
    for (const double x : {-1.0, 1.0})
      for (const double y : {-1.0, 1.0})
        points.push_back(
            {box->center[0] + x * box->half_size[0], box->center[1] + y * box->half_size[1], box->center[2]});
    return points;
  }
  const auto* disc = std::get_if<Disc>(&shape);
  const Point& center = disc != nullptr ? disc->center : std::get<Ball>(shape).center;
  const double radius = disc != nullptr ? disc->radius : std::get<Ball>(shape).radius;
  for (int n = 0; n < 360; ++n) {
    const double angle = n * std::numbers::pi / 180;
    points.push_back({center[0] + radius * std::cos(angle), center[1] + radius * std::sin(angle), center[2]});
  }
  return points;
}

/// A defect that the body does not hold is a slip of a sign or a unit.
void check_places(const Case& in, double touch) {
  const Shape& body = in.geometry.shape;
  for (const HoleInput& hole : in.holes)
    if (!overlap(hole.shape, body, touch))
      throw InputError(hole.at, "hole: lies outside of the body; expected one that cuts it");
  for (const InclusionInput& inclusion : in.inclusions)
    for (const Point& point : outline(inclusion.shape))
      if (signed_distance(body, point) > touch)
        throw InputError(inclusion.at,
                         fmt::format("inclusion: reaches out of the body at ({:.4g}, {:.4g}) m; expected one "
                                     "inside it",
                                     point[0], point[1]));
}

Defects make_defects(const Case& in) {
  struct Placed {
    const Shape& shape;
    const Location& at;
  };
  Defects defects;
  std::vector<Placed> placed;
  for (const HoleInput& hole : in.holes) {
    defects.holes.push_back(hole.shape);
    placed.push_back({hole.shape, hole.at});
  }
  for (const InclusionInput& inclusion : in.inclusions) {
    defects.inclusions.push_back(inclusion.shape);
    placed.push_back({inclusion.shape, inclusion.at});
  }
  for (const CrackInput& crack : in.cracks) add_crack(crack, defects);
  const double touch = 1e-6 * in.geometry.spacing;
  check_places(in, touch);
  for (std::size_t a = 0; a < placed.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (overlap(placed[a].shape, placed[b].shape, touch))
        throw InputError(placed[a].at,
                         fmt::format("this shape overlaps the one at {}; expected holes and inclusions apart "
                                     "from each other",
                                     placed[b].at.text()));
  return defects;
}

/// Faces that some load moves.
Faces loaded_faces(const Case& in) {
  Faces faces;
  for (const LoadInput& load : in.loads)
    for (const Named& name : load.on)
      if (const auto face = Simulation::face(name.text); face && !load.is_force()) faces.set(*face);
  return faces;
}

/// A point on a loaded edge would be its own mirror image.
void check_off_loaded_faces(const PointList& points, double spacing, const ListedBodyInput& body) {
  constexpr double kOnFace = 0.01;  // spacings
  for (std::size_t face = 0; face < kFaces; ++face)
    for (std::size_t n = 0; n < points.position.size() && body.mirrored.test(face); ++n)
      if (std::abs(points.position[n][face / 2] - body.faces[face]) < kOnFace * spacing)
        throw InputError(points.at(n),
                         fmt::format("the point lies on the edge \"{}\", which has a load; expected points "
                                     "inside, such as the centres of cells",
                                     kFaceNames[face]));
}

Body make_points_body(const Case& in) {
  const GeometryInput& geometry = in.geometry;
  const PointList& points = *geometry.points->list;
  const auto& box = std::get<Box>(geometry.shape);
  ListedBodyInput listed{.dimension = geometry.dimension,
                         .position = points.position,
                         .volume = points.volume,
                         .thickness = geometry.thickness,
                         .horizon = geometry.horizon,
                         .faces = {},
                         .defects = make_defects(in),
                         .mirrored = loaded_faces(in)};
  for (std::size_t face = 0; face < 2 * static_cast<std::size_t>(geometry.dimension); ++face)
    listed.faces[face] = box.center[face / 2] + (face % 2 == 0 ? -1 : 1) * box.half_size[face / 2];
  check_off_loaded_faces(points, geometry.spacing, listed);
  return make_listed_body(listed);
}

Body make_grid_body(const Case& in) {
  const GeometryInput& geometry = in.geometry;
  Body body = make_lattice_body({.dimension = geometry.dimension,
                                 .shape = geometry.shape,
                                 .thickness = geometry.thickness,
                                 .spacing = geometry.spacing,
                                 .horizon = geometry.horizon,
                                 .defects = make_defects(in),
                                 .mirrored = loaded_faces(in),
                                 .surface = geometry.surface ? geometry.surface->surface.get() : nullptr});
  return geometry.bonds == "listed" ? listed(body) : body;
}

/// Points of the mesh's list, as a listed body stores them. The input layer has checked that the group
/// exists.
const std::vector<std::size_t>& group_points(const std::string& name, const Case& of) {
  const auto& groups = of.geometry.points->list->groups;
  return std::find_if(groups.begin(), groups.end(), [&](const PointGroup& g) { return g.name == name; })
      ->points;
}

}  // namespace

Body make_body(const Case& in) {
  const GeometryInput& geometry = in.geometry;
  try {
    Body body = geometry.points ? make_points_body(in) : make_grid_body(in);
    check_cracks(in, body);
    return body;
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.starts_with(in.file.string())) throw;
    throw InputError(geometry.at, "geometry: " + what);
  }
}

PointSet make_set(const SetInput& in, const Case& of, const Body& body, const MeshBody* mesh) {
  PointSet set{in.name, {}};
  const double touch = 1e-9 * body.spacing;
  const std::vector<std::size_t>* group = in.group.empty() ? nullptr : &group_points(in.group, of);
  const std::vector<TurnedShape> shapes = shapes_of(in);
  const auto in_a_shape = [&](const Point& x) {
    return std::any_of(shapes.begin(), shapes.end(),
                       [&](const TurnedShape& shape) { return signed_distance(shape, x) <= touch; });
  };
  const auto is_inside = [&](const Point& x) {
    return in.where ? (*in.where)(Variables{.position = x}) != 0 : in_a_shape(x);
  };
  for (std::size_t n = 0; n < body.points.size(); ++n) {
    const std::size_t point = body.points[n];
    if (group != nullptr ? std::binary_search(group->begin(), group->end(), point)
                         : is_inside(body.position(point)))
      set.points.push_back(n);
  }
  for (std::size_t e = 0; mesh != nullptr && e < mesh->elements(); ++e)
    if (is_inside(mesh->centre(e))) set.elements.push_back(e);
  if (set.points.empty())
    throw InputError(
        in.at, fmt::format("set.{}: the set is empty; expected at least one of the body's {} points in it",
                           in.name, body.points.size()));
  return set;
}

}  // namespace riven
