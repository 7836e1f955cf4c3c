#include "input/element_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "geometry/mesh_faults.hpp"
#include "input/mesh_format.hpp"
#include "input/mesh_points.hpp"

namespace riven {
namespace {

/// The element of a block, or nothing: its kind, and how many nodes of second order it has besides.
std::string element_of(const ElementBlock& block) {
  const std::size_t further = block.size() == 0 ? 0 : block.further.size() / block.size();
  switch (block.kind) {
    case ElementKind::triangle:
      return further == 0 ? "t3" : "";
    case ElementKind::quadrangle:  // of nine nodes the one in the middle is left out
      return further == 0 ? "q4" : "q8";
    case ElementKind::tetrahedron:
      return further == 0 ? "t4" : "";
    case ElementKind::hexahedron:
      return further == 0 ? "h8" : "";
    default:
      return "";
  }
}

void check_kinds(const Mesh& mesh, const std::string& file) {
  std::map<std::string, std::size_t> kinds;  // numbers of elements
  for (const ElementBlock& block : mesh.blocks) {
    if (block.size() == 0 || dimension_of(block.kind) != mesh.dimension()) continue;
    const bool second = !block.further.empty();
    if (element_of(block).empty())
      throw InputError(
          Location{file},
          fmt::format(
              "the mesh has {}s of {} order; expected triangles, tetrahedra or hexahedra of first order "
              "(in Gmsh Mesh.ElementOrder = 1), or quadrangles of first or second order",
              name_of(block.kind), second ? "second" : "first"));
    kinds[fmt::format("{}s{}", name_of(block.kind), second ? " of second order" : "")] += block.size();
  }
  if (kinds.size() == 1) return;
  std::string found;
  for (const auto& [kind, count] : kinds)
    found += fmt::format("{}{} {}", found.empty() ? "" : " and ", count, kind);
  throw InputError(
      Location{file},
      fmt::format("the mesh has {}; expected elements of one kind (in Gmsh Mesh.RecombineAll = 1 "
                  "with Mesh.SubdivisionAlgorithm = 1 makes quadrangles alone, Mesh.RecombineAll "
                  "= 0 triangles)",
                  found));
}

void check_groups(const Mesh& mesh, const std::string& file) {
  for (const MeshGroup& a : mesh.groups)
    for (const MeshGroup& b : mesh.groups)
      if (a.name == b.name && a.dimension < b.dimension)
        throw InputError(
            Location{file},
            fmt::format("two physical groups, of dimensions {} and {}, are called \"{}\"; expected "
                        "names of their own",
                        a.dimension, b.dimension, a.name));
}

std::vector<std::string> groups(const GeometryInput& geometry, bool of_edges) {
  std::vector<std::string> names;
  if (!is_element_mesh(geometry)) return names;
  const Mesh& mesh = *geometry.elements->mesh;
  for (const MeshGroup& group : mesh.groups)
    if ((group.dimension == mesh.dimension() - 1) == of_edges) names.push_back(group.name);
  return names;
}

}  // namespace

bool is_element_mesh(const GeometryInput& geometry) {
  return geometry.elements && geometry.elements->mesh;
}

std::string element_name(const Mesh& mesh) {
  for (const ElementBlock& block : mesh.blocks)
    if (block.size() > 0 && dimension_of(block.kind) == mesh.dimension()) return element_of(block);
  return "";
}

std::vector<std::string> edge_groups(const GeometryInput& geometry) {
  return groups(geometry, true);
}

std::vector<std::string> other_groups(const GeometryInput& geometry) {
  return groups(geometry, false);
}

void read_element_mesh(GeometryInput& geometry, const ElementsInput& from,
                       const std::optional<double>& thickness, const Case& c, const Check& check) {
  const double unit = length_unit(from.unit, check);
  const std::string file = (c.file.parent_path() / from.file).string();
  auto mesh = std::make_shared<Mesh>();
  try {
    *mesh = read_body_mesh(file, unit);
    check_kinds(*mesh, file);
    check_groups(*mesh, file);
    geometry.spacing = points_of(*mesh, file, 1).spacing(1);
    check_conforming(*mesh, file);
  } catch (const InputError& wrong) {
    check.fail("file", wrong.what());
  }
  check_thickness(thickness, mesh->dimension(), check);
  geometry.dimension = mesh->dimension();
  geometry.thickness = thickness.value_or(1);
  fill_box(geometry, *mesh);
  geometry.element = element_name(*mesh);
  geometry.elements = from;
  geometry.elements->mesh = std::move(mesh);
}

}  // namespace riven
