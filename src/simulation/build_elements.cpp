#include <fmt/format.h>

#include <algorithm>

#include "fem/finite_elements.hpp"
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

MeshBody make_elements(const GeometryInput& geometry) {
  const ElementsInput& in = *geometry.elements;
  const std::vector<Point>& corner = in.corners;
  const auto map = in.arch          ? arch_map({in.arch->span, in.arch->rise, in.arch->depth})
                   : corner.empty() ? box_map(std::get<Box>(geometry.shape), geometry.dimension)
                                    : quadrilateral_map({corner[0], corner[1], corner[2], corner[3]});
  return make_mesh(shape_named(geometry.element), in.along, geometry.thickness, map);
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
    settings.dilatation = in.model.dilatation == "mean" ? Dilatation::mean : Dilatation::full;
  return settings;
}

}  // namespace

void build_elements(Simulation& simulation) {
  const Case& in = simulation.input;
  MeshBody mesh = make_elements(in.geometry);
  const Body nodes = nodes_as_body(mesh);
  for (const SetInput& set : in.sets) simulation.sets.push_back(make_set(set, in, nodes, &mesh));
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
