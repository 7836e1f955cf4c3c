#include "input/mesh_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/gmsh.hpp"

namespace riven {
namespace {

constexpr double kFlat = 1e-6;  // of the mesh's size, that a plane mesh may leave its plane

Location at_element(const std::string& file, const ElementBlock& block, std::size_t n) {
  return Location{fmt::format("{}, element {}", file, block.number[n])};
}

void check_dimension(const Mesh& mesh, const std::string& file) {
  if (mesh.dimension() == 2 || mesh.dimension() == 3) return;
  throw InputError(
      Location{file},
      fmt::format(
          "the mesh has {}; expected triangles, quadrangles, or elements in space. If there are physical "
          "groups, Gmsh saves their elements only: give the surface or the volume one too",
          mesh.dimension() == 1 ? "lines only" : "no elements"));
}

/// What hangs on no element of the body is a part of another dimension, which a body cannot have. Single
/// points may be left from drawing.
void check_attached(const Mesh& mesh, const std::string& file) {
  std::vector<bool> of_body(mesh.node.size(), false);
  for (const ElementBlock& block : mesh.blocks)
    if (dimension_of(block.kind) == mesh.dimension())
      for (const std::uint32_t node : block.node) of_body[node] = true;
  for (const ElementBlock& block : mesh.blocks)
    for (std::size_t n = 0; n < block.size() && dimension_of(block.kind) > 0; ++n)
      for (const std::uint32_t node : block.corners(n))
        if (!of_body[node])
          throw InputError(at_element(file, block, n),
                           fmt::format("this {} hangs on no element of {} dimensions; expected a body of one "
                                       "dimension, and lower elements on it",
                                       name_of(block.kind), mesh.dimension()));
}

/// Takes a plane mesh into the x-y plane; other planes are refused.
void flatten(Mesh& mesh, const std::string& file) {
  const Box box = box_around(mesh);
  const double size = std::max(box.half_size[0], box.half_size[1]);
  const ElementBlock* first = nullptr;
  for (const ElementBlock& block : mesh.blocks) {
    if (dimension_of(block.kind) != 2) continue;
    if (first == nullptr && block.size() > 0) first = &block;
    for (std::size_t n = 0; n < block.size(); ++n)
      for (const std::uint32_t node : block.corners(n))
        if (const double z = mesh.node[node][2], z0 = mesh.node[first->node[0]][2];
            !(std::abs(z - z0) <= kFlat * size))
          throw InputError(
              at_element(file, block, n),
              fmt::format("the mesh has surface elements only, and they reach from z = {:g} m to {:g} m; "
                          "expected a mesh of volumes, or one in a plane z = const",
                          z0, z));
  }
  for (Point& x : mesh.node) x[2] = 0;
}

/// Signed sizes are checked against the first element of the same surface.
class PointMaker {
 public:
  PointMaker(const Mesh& mesh, const std::string& file, double thickness)
      : mesh_(mesh), thickness_(thickness) {
    list_.file = file;
    list_.dimension = mesh.dimension();
  }

  PointList make() {
    for (const ElementBlock& block : mesh_.blocks)
      if (dimension_of(block.kind) == list_.dimension)
        for (std::size_t n = 0; n < block.size(); ++n) add(block, n);
    make_groups();
    return std::move(list_);
  }

 private:
  void add(const ElementBlock& block, std::size_t n) {
    const ElementMeasure found = measure(mesh_, block, n);
    const auto fail = [&](const char* what) {
      const Point& x = mesh_.node[block.corners(n)[0]];
      throw InputError(
          at_element(list_.file, block, n),
          fmt::format("this {} is {}, at ({:.4g}, {:.4g}, {:.4g}) m; expected one with a positive {}",
                      name_of(block.kind), what, x[0], x[1], x[2], list_.dimension == 2 ? "area" : "volume"));
    };
    if (!std::isfinite(found.size) || found.size == 0) fail("flat");
    if (!found.one_sided) fail("folded");
    if (list_.dimension == 3 && found.size < 0) fail("turned over: its corners are in the wrong order");
    const bool up = turned_up_.emplace(block.entity, found.size > 0).first->second;
    if (list_.dimension == 2 && (found.size > 0) != up) fail("turned over against others of its surface");
    list_.position.push_back(found.centroid);
    list_.volume.push_back(std::abs(found.size) * (list_.dimension == 2 ? thickness_ : 1));
    list_.element.push_back(block.number[n]);
  }

  /// Groups of one name are one, whatever their dimensions.
  void make_groups() {
    std::map<std::string, std::vector<bool>> members;
    for (std::size_t group = 0; group < mesh_.groups.size(); ++group) {
      std::vector<bool>& in = members[mesh_.groups[group].name];
      in.resize(list_.position.size());
      mark(group, in);
    }
    for (const auto& [name, in] : members) {
      PointGroup& group = list_.groups.emplace_back(PointGroup{name, {}});
      for (std::size_t n = 0; n < in.size(); ++n)
        if (in[n]) group.points.push_back(n);
    }
  }

  void mark(std::size_t group, std::vector<bool>& in) const {
    const bool of_body = mesh_.groups[group].dimension == list_.dimension;
    std::vector<bool> touched(mesh_.node.size(), false);  // nodes of a lower group
    const auto belongs = [group](const ElementBlock& block) {
      return std::find(block.groups.begin(), block.groups.end(), group) != block.groups.end();
    };
    for (const ElementBlock& block : mesh_.blocks)
      if (!of_body && belongs(block))
        for (const std::uint32_t node : block.node) touched[node] = true;
    std::size_t point = 0;
    for (const ElementBlock& block : mesh_.blocks) {
      if (dimension_of(block.kind) != list_.dimension) continue;
      for (std::size_t n = 0; n < block.size(); ++n, ++point) {
        const auto corners = block.corners(n);
        if (of_body ? belongs(block) : std::any_of(corners.begin(), corners.end(), [&](std::uint32_t node) {
              return touched[node];
            }))
          in[point] = true;
      }
    }
  }

  const Mesh& mesh_;
  double thickness_;
  PointList list_;
  std::map<int, bool> turned_up_;  // surfaces whose elements go round against the clock
};

}  // namespace

Mesh read_body_mesh(const std::filesystem::path& file, double unit) {
  Mesh mesh = read_gmsh(file);
  for (Point& x : mesh.node)
    for (double& coordinate : x) coordinate *= unit;
  check_dimension(mesh, file.string());
  check_attached(mesh, file.string());
  if (mesh.dimension() == 2) flatten(mesh, file.string());
  return mesh;
}

PointList points_of(const Mesh& mesh, const std::string& file, double thickness) {
  return PointMaker(mesh, file, thickness).make();
}

}  // namespace riven
