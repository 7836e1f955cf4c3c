#include "input/shape_format.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numeric>

#include "input/element_mesh.hpp"
#include "input/elements_format.hpp"
#include "input/mesh_format.hpp"
#include "input/points_format.hpp"

namespace riven {
namespace {

using kind::Integers;
using kind::Place;
using kind::Quantities;
using kind::Quantity;
using kind::Table;
using kind::Text;

// Half-sizes beyond the body's dimension are infinite; this is how many are not.
std::size_t finite_directions(const Box& box) {
  std::size_t count = 0;
  while (count < 3 && std::isfinite(box.half_size[count])) ++count;
  return count;
}

template <class Wanted>
std::function<bool()> holds(const std::optional<Shape>& shape) {
  return [&shape] { return shape && std::holds_alternative<Wanted>(*shape); };
}

// ---- the body ----

struct LatticeBoxForm {
  std::vector<double> size, from;
  std::optional<double> thickness, area, spacing;
  std::vector<int> points, elements;
};

LatticeBoxForm lattice_box_form(const GeometryInput& geometry) {
  LatticeBoxForm form;
  const Box* box = std::get_if<Box>(&geometry.shape);
  if (box == nullptr || geometry.spacing == 0) return form;
  for (std::size_t i = 0; i < finite_directions(*box); ++i) {
    form.size.push_back(2 * box->half_size[i]);
    form.from.push_back(box->center[i] - box->half_size[i]);
  }
  if (geometry.dimension == 2) form.thickness = geometry.thickness;
  if (geometry.dimension == 1) form.area = geometry.thickness;
  if (geometry.elements)
    form.elements = geometry.elements->along;
  else
    form.spacing = geometry.spacing;
  return form;
}

double spacing_of(const LatticeBoxForm& form, const Check& check) {
  if (form.spacing) return *form.spacing;
  if (form.points.size() != form.size.size())
    check.fail("points", fmt::format("has {} entries; expected {}, one per direction", form.points.size(),
                                     form.size.size()));
  const double spacing = form.size[0] / form.points[0];
  for (std::size_t i = 1; i < form.size.size(); ++i) {
    const double other = form.size[i] / form.points[i];
    if (std::abs(other - spacing) > 1e-9 * spacing)
      check.fail(
          "points",
          fmt::format("gives a spacing of {:.6g} m in one direction and {:.6g} m in another; expected equal "
                      "spacing, such as {} points instead of {}",
                      spacing, other, std::max(1L, std::lround(form.size[i] / spacing)), form.points[i]));
  }
  return spacing;
}

void check_lattice_box(const LatticeBoxForm& form, const Check& check) {
  const std::size_t dimension = form.size.size();
  if (!form.from.empty() && form.from.size() != dimension)
    check.fail("from",
               fmt::format("has {} entries; expected {}, as many as size", form.from.size(), dimension));
  if (dimension == 2 && !form.thickness)
    check.fail("thickness", "missing; a body in two dimensions needs it, such as \"10 mm\"");
  if (dimension == 1 && !form.area)
    check.fail("area", "missing; a body in one dimension needs its cross-section, such as \"1 mm^2\"");
  if (dimension != 2 && form.thickness)
    check.fail("thickness",
               fmt::format("belongs to bodies in two dimensions; size has {} entries", dimension));
  if (dimension != 1 && form.area)
    check.fail("area", fmt::format("belongs to bodies in one dimension; size has {} entries", dimension));
}

void fill_box(const LatticeBoxForm& form, const Check& check, GeometryInput& geometry) {
  check_lattice_box(form, check);
  constexpr double endless = std::numeric_limits<double>::infinity();
  Box box{{}, {endless, endless, endless}};
  for (std::size_t i = 0; i < form.size.size(); ++i) {
    box.half_size[i] = form.size[i] / 2;
    if (!form.from.empty()) box.center[i] = form.from[i] + form.size[i] / 2;
  }
  geometry.shape = box;
  geometry.dimension = static_cast<int>(form.size.size());
  geometry.thickness = form.thickness.value_or(form.area.value_or(1));
  if (!form.elements.empty()) {
    set_elements(geometry, form.elements,
                 std::accumulate(form.size.begin(), form.size.end(), 1.0, std::multiplies{}), check);
    return;
  }
  geometry.spacing = spacing_of(form, check);
  for (const double size : form.size)
    if (geometry.spacing > size)
      check.fail(
          form.spacing ? "spacing" : "points",
          fmt::format("the spacing {:.6g} m is larger than the body ({:.6g} m)", geometry.spacing, size));
}

Format describe_lattice_box(GeometryInput& geometry) {
  const auto form = std::make_shared<LatticeBoxForm>(lattice_box_form(geometry));
  return {
      .doc = "A bar, rectangle or box, centred at the origin unless `from` is given.",
      .keys = {Key{"size", Quantities{&form->size, dimension::length, positive, 3},
                   "Its edges along the axes; as many as the body has dimensions."}
                   .required(),
               Key{"from", Quantities{&form->from, dimension::length, any_number, 3}, "Its lower corner."},
               Key{"thickness", Quantity{&form->thickness, dimension::length, positive},
                   "Two dimensions only: its thickness."},
               Key{"area", Quantity{&form->area, dimension::area, positive},
                   "One dimension only: its cross-section."},
               Key{"spacing", Quantity{&form->spacing, dimension::length, positive},
                   "Distance of the points; known as `dx` from here on."},
               Key{"points", Integers{&form->points, 1},
                   "Number of points along the axes, instead of the spacing."},
               Key{"elements", Integers{&form->elements, 1},
                   "Number of finite elements along the axes, instead of points; `dx` is then the mean size "
                   "of a cell."}},
      .groups = {{{"spacing", "points", "elements"}}},
      .finish = [form, &geometry](const Check& check) { fill_box(*form, check, geometry); }};
}

Format describe_lattice_disc(GeometryInput& geometry) {
  struct Form {
    Disc disc;
    double thickness = 0, spacing = 0;
  };
  const auto form = std::make_shared<Form>();
  if (const Disc* disc = std::get_if<Disc>(&geometry.shape))
    *form = {*disc, geometry.thickness, geometry.spacing};
  return {.doc = "A disc.",
          .keys = {Key{"center", Place{&form->disc.center}, "Its centre; the origin unless given."},
                   Key{"radius", Quantity{&form->disc.radius, dimension::length, positive}, "Its radius."}
                       .required(),
                   Key{"thickness", Quantity{&form->thickness, dimension::length, positive}, "Its thickness."}
                       .required(),
                   Key{"spacing", Quantity{&form->spacing, dimension::length, positive},
                       "Distance of the points; known as `dx` from here on."}
                       .required()},
          .finish = [form, &geometry](const Check& check) {
            if (form->spacing > form->disc.radius) check.fail("spacing", "is larger than the radius");
            geometry.shape = form->disc;
            geometry.dimension = 2;
            geometry.thickness = form->thickness;
            geometry.spacing = form->spacing;
          }};
}

}  // namespace

Format describe_round(std::optional<Shape>& shape, bool ball) {
  struct Form {
    Point center{};
    double radius = 0;
  };
  const auto form = std::make_shared<Form>();
  if (shape && std::holds_alternative<Disc>(*shape))
    *form = {std::get<Disc>(*shape).center, std::get<Disc>(*shape).radius};
  if (shape && std::holds_alternative<Ball>(*shape))
    *form = {std::get<Ball>(*shape).center, std::get<Ball>(*shape).radius};
  return {
      .doc = ball ? "A ball." : "A circle; in three dimensions the endless cylinder over it along z.",
      .keys = {Key{"center", Place{&form->center}, "Its centre; the origin unless given."},
               Key{"radius", Quantity{&form->radius, dimension::length, positive}, "Its radius."}.required()},
      .finish = [form, &shape, ball](const Check&) {
        if (ball)
          shape = Ball{form->center, form->radius};
        else
          shape = Disc{form->center, form->radius};
      }};
}

Format describe_box(std::optional<Shape>& shape) {
  struct Form {
    Point size;
    std::optional<Point> center, from;
  };
  constexpr double endless = std::numeric_limits<double>::infinity();
  const auto form = std::make_shared<Form>(Form{{endless, endless, endless}, {}, {}});
  if (shape && std::holds_alternative<Box>(*shape)) {
    const Box& box = std::get<Box>(*shape);
    form->center = box.center;
    for (std::size_t i = 0; i < 3; ++i)
      if (box.half_size[i] > 0) form->size[i] = 2 * box.half_size[i];  // a shape not read yet has none
  }
  return {.doc = "A rectangle or box parallel to the axes.",
          .keys = {Key{"size", Place{&form->size, positive}, "Its edges along the axes."}.required(),
                   Key{"center", Place{&form->center}, "Its centre; the origin unless given."},
                   Key{"from", Place{&form->from}, "Its lower corner, instead of its centre."}},
          .groups = {{{"center", "from"}, false}},
          .finish = [form, &shape](const Check&) {
            Box box{form->center.value_or(Point{}), {}};
            for (std::size_t i = 0; i < 3; ++i) {
              box.half_size[i] = form->size[i] / 2;
              if (form->from && std::isfinite(form->size[i]))
                box.center[i] = (*form->from)[i] + box.half_size[i];
            }
            shape = box;
          }};
}

void check_shape(const Shape& shape, const Case& c, const Check& check) {
  if (std::holds_alternative<Ball>(shape) && c.geometry.dimension != 3)
    check.fail("ball", "belongs to bodies in three dimensions; expected disc or box");
}

std::vector<Key> shape_keys(std::optional<Shape>& shape) {
  return {
      Key{"disc", Table{[&shape] { return describe_round(shape, false); }, holds<Disc>(shape)}, "A circle."},
      Key{"box", Table{[&shape] { return describe_box(shape); }, holds<Box>(shape)}, "A rectangle or box."},
      Key{"ball", Table{[&shape] { return describe_round(shape, true); }, holds<Ball>(shape)},
          "A ball; three dimensions only."}};
}

Format describe_geometry(Case& c) {
  GeometryInput& geometry = c.geometry;
  const auto is_box = [&geometry] { return std::holds_alternative<Box>(geometry.shape); };
  const auto has_points = [&geometry] { return geometry.points && !geometry.points->is_mesh(); };
  const auto has_mesh = [&geometry] {
    return is_element_mesh(geometry) || (geometry.points && geometry.points->is_mesh());
  };
  const auto is_lattice_box = [&geometry, is_box] {
    return is_box() && !geometry.points && !geometry.surface && !is_arch(geometry) &&
           !is_quadrilateral(geometry) && !is_element_mesh(geometry);
  };
  return {
      .doc =
          "The body: a shape filled with points on a square or cubic lattice, points from a file, or the "
          "elements "
          "of a mesh; and the horizon. Or finite elements.",
      .at = &geometry.at,
      .keys = {Key{"box", Table{[&geometry] { return describe_lattice_box(geometry); }, is_lattice_box},
                   "A bar, rectangle or box."},
               Key{"disc",
                   Table{[&geometry] { return describe_lattice_disc(geometry); }, [=] { return !is_box(); }},
                   "A disc."},
               Key{"points", Table{[&geometry, &c] { return describe_points(geometry, c); }, has_points},
                   "Points from a file."},
               Key{"mesh", Table{[&geometry, &c] { return describe_mesh(geometry, c); }, has_mesh},
                   "A mesh from Gmsh."},
               Key{"surface",
                   Table{[&geometry, &c] { return describe_surface(geometry, c); },
                         [&geometry] { return geometry.surface.has_value(); }},
                   "The inside of a surface from an STL file."},
               Key{"arch",
                   Table{[&geometry] { return describe_arch(geometry); },
                         [&geometry] { return is_arch(geometry); }},
                   "A circular arch of finite elements."},
               Key{"quadrilateral",
                   Table{[&geometry] { return describe_quadrilateral(geometry); },
                         [&geometry] { return is_quadrilateral(geometry); }},
                   "A quadrilateral of finite elements."},
               Key{"element", Text{&geometry.element, {"q4", "q8", "t3", "h8", "t4"}},
                   "Kind of the finite elements: quadrilaterals of four and eight nodes, triangles; in three "
                   "dimensions hexahedra and tetrahedra. `q4` and `h8` unless given."},
               Key{"horizon", Quantity{&geometry.horizon, dimension::length, positive},
                   "Radius within which points interact."}
                   .otherwise("\"3 dx\""),
               Key{"bonds", Text{&geometry.bonds, {"lattice", "listed"}},
                   "How bonds are kept: as bits of the lattice, or in lists, with the same results but "
                   "slower and in more memory. Bonds of points from a file or of a mesh are always listed."}
                   .otherwise("\"lattice\"")},
      .groups = {{{"box", "disc", "points", "mesh", "surface", "arch", "quadrilateral"}}},
      .finish = [&geometry](const Check& check) {
        geometry.horizon_at = check.at("horizon");
        if (geometry.elements) return finish_elements(geometry, check);
        if (check.given("element"))
          check.fail("element",
                     "belongs to finite elements; expected `elements` in the shape, such as box = { ..., "
                     "elements = [20, 10] }, or as = \"elements\" in a mesh");
        if (geometry.points && check.given("bonds") && geometry.bonds != "listed")
          check.fail("bonds", "points from a file are on no lattice; expected \"listed\", or nothing");
        if (geometry.points) geometry.bonds = "listed";
        // Rounding must not refuse "1 dx".
        if (geometry.horizon < geometry.spacing * (1 - 1e-9))
          check.fail(
              "horizon",
              fmt::format(
                  "{:.6g} m is below the spacing of {:.6g} m; expected a few spacings, such as \"3 dx\"",
                  geometry.horizon, geometry.spacing));
      }};
}

}  // namespace riven
