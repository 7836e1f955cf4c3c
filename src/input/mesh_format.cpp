#include "input/mesh_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "geometry/stl.hpp"
#include "input/element_mesh.hpp"
#include "input/mesh_points.hpp"

namespace riven {

double length_unit(const std::string& text, const Check& check) {
  std::optional<UnitMatch> match;
  if (is_unit(text)) match = match_unit(text, 0);
  if (!match || match->unit.dimension != dimension::length)
    check.fail("unit", fmt::format("found \"{}\"; expected a unit of length, such as \"mm\" or \"m\"", text));
  return match->unit.factor;
}

void check_thickness(const std::optional<double>& thickness, int dimension, const Check& check) {
  if (dimension == 2 && !thickness)
    check.fail("thickness",
               "missing; a body in two dimensions (triangles, quadrangles) needs it, such as \"10 mm\"");
  if (dimension == 3 && thickness)
    check.fail("thickness", "belongs to bodies in two dimensions; the mesh has elements in space");
}

void fill_box(GeometryInput& geometry, const Mesh& mesh) {
  const Box box = box_around(mesh);
  geometry.shape = box;
  const std::array<bool, 6> filled = filled_faces(mesh, box);
  for (std::size_t face = 0; face < filled.size(); ++face) geometry.open_faces[face] = !filled[face];
}

namespace {

void read(GeometryInput& geometry, const std::optional<double>& thickness, const Case& c,
          const Check& check) {
  PointsInput& points = *geometry.points;
  const double unit = length_unit(points.unit, check);
  const std::filesystem::path file = c.file.parent_path() / points.file;
  const auto in_file = [&](const auto& run) {
    try {
      run();
    } catch (const InputError& wrong) {
      check.fail("file", wrong.what());
    }
  };
  Mesh mesh;
  in_file([&] { mesh = read_body_mesh(file, unit); });
  check_thickness(thickness, mesh.dimension(), check);
  geometry.dimension = mesh.dimension();
  geometry.thickness = thickness.value_or(1);
  fill_box(geometry, mesh);
  in_file([&] {
    auto list = std::make_shared<const PointList>(points_of(mesh, file.string(), geometry.thickness));
    geometry.spacing = list->spacing(geometry.thickness);
    check_apart(*list, geometry.spacing);
    points.list = std::move(list);
  });
}

std::shared_ptr<const Surface> surface_of(const std::filesystem::path& file, double unit,
                                          const Check& check) {
  std::shared_ptr<const Surface> surface;
  try {
    Triangles triangles = read_stl(file);
    for (Point& corner : triangles.corner)
      for (double& x : corner) x *= unit;
    surface = std::make_shared<const Surface>(std::move(triangles));
  } catch (const InputError& wrong) {
    const std::string what = wrong.what();
    check.fail("file", what.starts_with(file.string()) ? what : file.string() + ": " + what);
  }
  return surface;
}

void read_surface(GeometryInput& geometry, const Case& c, const Check& check) {
  SurfaceInput& input = *geometry.surface;
  input.surface = surface_of(c.file.parent_path() / input.file, length_unit(input.unit, check), check);
  geometry.dimension = 3;
  geometry.thickness = 1;
  const Box& box = input.surface->box();
  geometry.shape = box;
  const std::array<bool, 6> filled = input.surface->filled_faces();
  for (std::size_t face = 0; face < filled.size(); ++face) geometry.open_faces[face] = !filled[face];
  const double smallest = 2 * *std::min_element(box.half_size.begin(), box.half_size.end());
  if (geometry.spacing > smallest)
    check.fail("spacing", fmt::format("the spacing {:.6g} m is larger than the body ({:.6g} m)",
                                      geometry.spacing, smallest));
}

}  // namespace

Format describe_surface(GeometryInput& geometry, const Case& c) {
  if (!geometry.surface) geometry.surface.emplace();
  SurfaceInput& surface = *geometry.surface;
  return {.doc =
              "The inside of a closed surface of triangles in an STL file (ASCII or binary), in three "
              "dimensions, on a "
              "cubic lattice that fills the box around it. Cells less than half inside are left out; the "
              "others count "
              "with the part that is inside. Where triangles cover a whole side of that box, it is an edge "
              "for loads and "
              "probes.",
          .keys = {Key{"file", kind::Text{&surface.file}, "STL file, relative to the case file."}.required(),
                   Key{"unit", kind::Text{&surface.unit}, "Of its coordinates, such as `\"mm\"`."}.otherwise(
                       "\"m\""),
                   Key{"spacing", kind::Quantity{&geometry.spacing, dimension::length, positive},
                       "Distance of the points; known as `dx` from here on."}
                       .required()},
          .finish = [&geometry, &c](const Check& check) { read_surface(geometry, c, check); }};
}

Format describe_mesh(GeometryInput& geometry, const Case& c) {
  struct Form {
    std::string file, unit, as;
    std::optional<double> thickness;
  };
  const auto form = std::make_shared<Form>();
  if (geometry.points) *form = {geometry.points->file, geometry.points->unit, "points", {}};
  if (is_element_mesh(geometry)) *form = {geometry.elements->file, geometry.elements->unit, "elements", {}};
  if (!form->file.empty() && geometry.dimension == 2) form->thickness = geometry.thickness;
  return {
      .doc =
          "A mesh in Gmsh's format MSH 4.1 (ASCII or binary), in a plane z = const or in space. Where its "
          "boundary covers a whole side of the box around it, that side is an edge for loads and probes.",
      .keys =
          {Key{"file", kind::Text{&form->file}, "MSH file, relative to the case file."}.required(),
           Key{"unit", kind::Text{&form->unit}, "Of its coordinates, such as `\"mm\"`."}.otherwise("\"m\""),
           Key{"as", kind::Text{&form->as, {"points", "elements"}},
               "`points`: each element, of any kind, is a point at its centroid, with its volume; `dx` is "
               "their mean spacing, as of `points`; physical groups become sets by `group` in `[set.NAME]`. "
               "`elements`: finite elements, of one kind: triangles, quadrangles of first or second order, "
               "tetrahedra, hexahedra. Physical groups have their names in loads, probes and materials: "
               "those of "
               "lines (in space: faces) as edges, others as sets."}
               .otherwise("\"points\""),
           Key{"thickness", kind::Quantity{&form->thickness, dimension::length, positive},
               "Two dimensions only: the body's thickness."}},
      .finish = [form, &geometry, &c](const Check& check) {
        if (form->as == "elements")
          return read_element_mesh(geometry, {.file = form->file, .unit = form->unit}, form->thickness, c,
                                   check);
        geometry.points = PointsInput{.file = form->file, .unit = form->unit};
        read(geometry, form->thickness, c, check);
      }};
}

}  // namespace riven
