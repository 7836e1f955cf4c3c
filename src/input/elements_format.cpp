#include "input/elements_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/nearest_name.hpp"
#include "input/element_mesh.hpp"

namespace riven {

using kind::Integers;
using kind::Places;
using kind::Quantity;

namespace {

const std::vector<std::string> kInPlane{"q4", "q8", "t3"};
const std::vector<std::string> kInSpace{"h8", "t4"};

/// The box around points in the plane.
Box box_around(const std::vector<Point>& points) {
  Box box{{}, {0, 0, std::numeric_limits<double>::infinity()}};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto [low, high] = std::minmax_element(
        points.begin(), points.end(), [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; });
    box.center[axis] = 0.5 * ((*low)[axis] + (*high)[axis]);
    box.half_size[axis] = 0.5 * ((*high)[axis] - (*low)[axis]);
  }
  return box;
}

void finish_arch(const ArchInput& arch, const std::vector<int>& along, GeometryInput& geometry,
                 const Check& check) {
  const double half = 2 * std::atan(2 * arch.rise / arch.span);
  const double radius = (0.25 * arch.span * arch.span + arch.rise * arch.rise) / (2 * arch.rise);
  if (arch.depth >= 2 * radius)
    check.fail("depth", fmt::format("{:g} m is more than twice the radius of the middle line, {:g} m",
                                    arch.depth, radius));
  const double inner = radius - 0.5 * arch.depth, outer = radius + 0.5 * arch.depth,
               down = radius - arch.rise;
  const double widest = half > 0.5 * M_PI ? outer : outer * std::sin(half);
  const double lowest = std::min(inner * std::cos(half), outer * std::cos(half)) - down;
  geometry.shape = box_around({{-widest, lowest, 0}, {widest, outer - down, 0}});
  geometry.dimension = 2;
  set_elements(geometry, along, arch.depth * 2 * half * radius, check);
  geometry.elements->arch = arch;
}

/// Twice the area of the triangle of three corners; positive if they go counterclockwise.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

void finish_quadrilateral(const std::vector<Point>& corners, const std::vector<int>& along,
                          GeometryInput& geometry, const Check& check) {
  if (corners.size() != 4)
    check.fail("corners", fmt::format("has {} entries; expected four corners", corners.size()));
  for (std::size_t n = 0; n < 4; ++n)
    if (!(turn(corners[n], corners[(n + 1) % 4], corners[(n + 2) % 4]) > 0))
      check.fail("corners", fmt::format("turn to the right at corner {}; expected the corners of a convex "
                                        "quadrilateral, counterclockwise from the lower left",
                                        (n + 1) % 4 + 1));
  geometry.shape = box_around(corners);
  geometry.dimension = 2;
  set_elements(geometry, along,
               0.5 * (turn(corners[0], corners[1], corners[2]) + turn(corners[0], corners[2], corners[3])),
               check);
  geometry.elements->corners = corners;
}

Key elements_key(std::vector<int>& to) {
  return Key{"elements", Integers{&to, 1}, "Number of elements from left to right and from bottom to top."}
      .required();
}

[[noreturn]] void refuse(const Location& at, const std::string& what) {
  throw InputError(at, fmt::format("the model \"finite-elements\" has no {}", what));
}

void refuse_bonds(const Case& c) {
  if (!c.holes.empty()) refuse(c.holes.front().at, "holes; expected a mesh that leaves them out");
  if (!c.cracks.empty()) refuse(c.cracks.front().at, "cracks; expected a peridynamic model");
  if (!c.inclusions.empty())
    refuse(c.inclusions.front().at, "rigid inclusions; expected a material of its own on a set");
  if (!c.interfaces.empty())
    refuse(c.interfaces.front().at, "bonds that break; expected a peridynamic model");
  if (!c.failure.not_in.empty()) refuse(c.failure.at, "bonds that break; expected a peridynamic model");
  if (c.contact) refuse(c.contact->at, "contact with itself yet; expected a peridynamic model");
  for (const MaterialInput& material : c.materials)
    if (material.breaks() || material.critical_damage)
      refuse(material.at, "bonds that break; expected no critical_stretch and the like");
}

void refuse_results(const Case& c) {
  for (const LoadInput& load : c.loads)
    if (load.layer)
      refuse(load.at, "layers of points; expected no `layer`: a traction acts on the edges of elements");
  const std::vector<std::string> kinds{"reaction", "nominal-stress", "displacement", "stretch",
                                       "strain",   "largest",        "impactor"};
  for (const ProbeInput& probe : c.probes)
    if (std::find(kinds.begin(), kinds.end(), probe.kind) == kinds.end())
      refuse(probe.at, fmt::format("\"{}\" to be followed; expected one of {}", probe.kind, listed(kinds)));
  for (const char* field : {"damage", "fragment"})
    if (std::find(c.output.fields.begin(), c.output.fields.end(), field) != c.output.fields.end())
      refuse(c.output.at, fmt::format("field \"{}\"; expected others in `fields`", field));
}

}  // namespace

bool is_arch(const GeometryInput& geometry) {
  return geometry.elements && geometry.elements->arch;
}

bool is_quadrilateral(const GeometryInput& geometry) {
  return geometry.elements && !geometry.elements->corners.empty();
}

void set_elements(GeometryInput& geometry, const std::vector<int>& along, double size, const Check& check) {
  if (geometry.dimension < 2)
    check.fail("size", "has one entry; expected two or three, as finite elements need");
  if (along.size() != static_cast<std::size_t>(geometry.dimension))
    check.fail("elements", fmt::format("has {} entries; expected {}, one per direction", along.size(),
                                       geometry.dimension));
  double count = 1;
  for (const int n : along) count *= n;
  geometry.elements = ElementsInput{.along = along};
  geometry.spacing = std::pow(size / count, 1.0 / geometry.dimension);
}

Format describe_arch(GeometryInput& geometry) {
  struct Form {
    ArchInput arch;
    double thickness = 0;
    std::vector<int> elements;
  };
  const auto form = std::make_shared<Form>();
  if (is_arch(geometry)) *form = {*geometry.elements->arch, geometry.thickness, geometry.elements->along};
  const auto length = [](double& to) { return Quantity{&to, dimension::length, positive}; };
  return {
      .doc =
          "A circular arch, upright and symmetric to x = 0; the ends of its middle line are at y = 0. Its "
          "edges "
          "are `left` and `right`, its ends, `bottom`, inside, and `top`, outside.",
      .keys = {Key{"span", length(form->arch.span), "Distance of the ends of its middle line."}.required(),
               Key{"rise", length(form->arch.rise), "Height of its middle line."}.required(),
               Key{"depth", length(form->arch.depth), "Its width in the plane, across the middle line."}
                   .required(),
               Key{"thickness", length(form->thickness), "Its thickness, across the plane."}.required(),
               elements_key(form->elements)},
      .finish = [form, &geometry](const Check& check) {
        finish_arch(form->arch, form->elements, geometry, check);
        geometry.thickness = form->thickness;
      }};
}

Format describe_quadrilateral(GeometryInput& geometry) {
  struct Form {
    std::vector<Point> corners;
    double thickness = 0;
    std::vector<int> elements;
  };
  const auto form = std::make_shared<Form>();
  if (is_quadrilateral(geometry))
    *form = {geometry.elements->corners, geometry.thickness, geometry.elements->along};
  return {.doc = "A quadrilateral with straight edges.",
          .keys = {Key{"corners", Places{&form->corners, 4},
                       "Its corners, counterclockwise from the lower left: `bottom` is the edge between the "
                       "first two, "
                       "`right` the next one, then `top` and `left`."}
                       .required(),
                   Key{"thickness", Quantity{&form->thickness, dimension::length, positive}, "Its thickness."}
                       .required(),
                   elements_key(form->elements)},
          .finish = [form, &geometry](const Check& check) {
            finish_quadrilateral(form->corners, form->elements, geometry, check);
            geometry.thickness = form->thickness;
          }};
}

void finish_elements(GeometryInput& geometry, const Check& check) {
  for (const char* key : {"horizon", "bonds"})
    if (check.given(key))
      check.fail(key, "belongs to points with bonds; expected none: the body has elements");
  geometry.horizon = 0;  // the writer leaves out what has no value
  geometry.bonds.clear();
  if (is_element_mesh(geometry)) {
    const std::string found = element_name(*geometry.elements->mesh);
    if (geometry.element != found)
      check.fail("element", fmt::format("found \"{}\", and the mesh has {}; expected \"{}\", or nothing",
                                        geometry.element, found, found));
  }
  const std::vector<std::string>& fitting = geometry.dimension == 2 ? kInPlane : kInSpace;
  if (geometry.element.empty()) geometry.element = fitting.front();
  if (std::find(fitting.begin(), fitting.end(), geometry.element) == fitting.end())
    check.fail("element", fmt::format("found \"{}\"; expected one of {} in {} dimensions", geometry.element,
                                      listed(fitting), geometry.dimension == 2 ? "two" : "three"));
}

void check_elements(const Case& c) {
  const bool wanted = c.model.kind == "finite-elements";
  if (!c.geometry.elements) {
    if (wanted)
      throw InputError(c.geometry.at,
                       "geometry: the model \"finite-elements\" needs a mesh; expected `elements` in "
                       "the shape, such as box = { ..., elements = [20, 10] }, an arch, a "
                       "quadrilateral or mesh = { ..., as = \"elements\" }");
    return;
  }
  if (!wanted)
    throw InputError(c.geometry.at,
                     fmt::format("geometry: the model \"{}\" has points, not elements; expected "
                                 "[model] kind = \"finite-elements\", or `spacing` or `points` "
                                 "instead of `elements`",
                                 c.model.kind));
  refuse_bonds(c);
  refuse_results(c);
}

}  // namespace riven
