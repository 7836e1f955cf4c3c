#include <fmt/format.h>

#include <algorithm>

#include "fem/finite_elements.hpp"
#include "fem/imported_mesh.hpp"
#include "input/material_format.hpp"
#include "simulation/build_parts.hpp"

namespace riven {

namespace {

ElementShape shape_named(const std::string& name) {
  for (const ElementShape shape :
       {ElementShape::t3, ElementShape::q4, ElementShape::q8, ElementShape::t4, ElementShape::h8})
    if (name_of(shape) == name) return shape;
  throw std::logic_error("no element is called " + name);
}

ImportedMesh make_elements(const Case& c) {
  const GeometryInput& geometry = c.geometry;
  const ElementsInput& in = *geometry.elements;
  if (in.mesh) {
    std::array<bool, 6> faces{};
    for (std::size_t face = 0; face < faces.size(); ++face) faces[face] = !geometry.open_faces[face];
    const std::string file = (c.file.parent_path() / in.file).string();
    try {
      return import_mesh(*in.mesh, shape_named(geometry.element), geometry.thickness, faces, file);
    } catch (const InputError& error) {
      throw InputError(geometry.at, fmt::format("geometry.mesh: {}", error.what()));
    }
  }
  const std::vector<Point>& corner = in.corners;
  const auto map = in.arch          ? arch_map({in.arch->span, in.arch->rise, in.arch->depth})
                   : corner.empty() ? box_map(std::get<Box>(geometry.shape), geometry.dimension)
                                    : quadrilateral_map({corner[0], corner[1], corner[2], corner[3]});
  return {make_mesh(shape_named(geometry.element), in.along, geometry.thickness, map), {}};
}

/// The input layer has checked that the group exists.
const MeshPart& part_named(const std::string& group, const std::vector<MeshPart>& parts) {
  return *std::find_if(parts.begin(), parts.end(), [&](const MeshPart& part) { return part.name == group; });
}

PointSet set_of(const MeshPart& part, const std::string& name) {
  return {.name = name, .points = part.nodes, .elements = part.elements};
}

/// Gives the elements the materials of the sets that their centres are in.
void mark_elements(const Case& in, const std::vector<PointSet>& sets, MeshBody& mesh) {
  const auto rest = std::find_if(in.materials.begin(), in.materials.end(),
                                 [](const MaterialInput& material) { return material.on.empty(); });
  const auto others = static_cast<std::uint8_t>(rest - in.materials.begin());
  mesh.material.assign(mesh.elements(), others);
  for (std::size_t m = 0; m < in.materials.size(); ++m)
    for (const Named& on : in.materials[m].on)
      for (const std::size_t element : find_set(sets, on.text).elements) {
        if (mesh.material[element] != others)
          throw InputError(on.at,
                           fmt::format("material.{}: elements of \"{}\" have another material already; "
                                       "expected sets without common elements",
                                       in.materials[m].name, on.text));
        mesh.material[element] = static_cast<std::uint8_t>(m);
      }
}

FiniteElementsSettings settings_of(const Case& in) {
  FiniteElementsSettings settings;
  for (const MaterialInput& material : in.materials) settings.materials.push_back(make_material(material));
  settings.plane = in.model.plane == "strain" ? Plane::strain : Plane::stress;
  if (!in.model.dilatation.empty())
    settings.dilatation = in.model.dilatation == "mean"        ? Dilatation::mean
                          : in.model.dilatation == "linear"    ? Dilatation::linear
                          : in.model.dilatation == "selective" ? Dilatation::selective
                                                               : Dilatation::full;
  return settings;
}

}  // namespace

void build_elements(Simulation& simulation) {
  const Case& in = simulation.input;
  ImportedMesh imported = make_elements(in);
  MeshBody& mesh = imported.body;
  const Body nodes = nodes_as_body(mesh);
  for (const SetInput& set : in.sets)
    simulation.sets.push_back(set.group.empty() ? make_set(set, in, nodes, &mesh)
                                                : set_of(part_named(set.group, imported.parts), set.name));
  for (const MeshPart& part : imported.parts)
    if (part.dimension != mesh.dimension() - 1) simulation.sets.push_back(set_of(part, part.name));
  mark_elements(in, simulation.sets, mesh);
  try {
    auto model = std::make_unique<FiniteElements>(std::move(mesh), settings_of(in));
    simulation.body = &model->body();
    simulation.mesh = &model->mesh();
    simulation.model = std::move(model);
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.starts_with(in.file.string())) throw;
    throw InputError(in.model.at, "model: " + what);
  }
}

}  // namespace riven
