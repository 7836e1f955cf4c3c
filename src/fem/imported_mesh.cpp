#include "fem/imported_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace riven {
namespace {

constexpr double kRounding = 1e-6;  // of the box: files keep six digits and more

/// Order of the nodes of an element that goes the other way round.
std::vector<std::size_t> reversed(ElementShape shape) {
  if (shape == ElementShape::t3) return {0, 2, 1};
  if (shape == ElementShape::q4) return {0, 3, 2, 1};
  return {0, 3, 2, 1, 7, 6, 5, 4};
}

using SideKey = std::array<std::uint32_t, 4>;  // corners of a side, ascending

/// A side of an element, found by its corners.
struct SideOfElement {
  SideKey key{};
  std::size_t element = 0, side = 0;
};

class Importer {
 public:
  Importer(const Mesh& mesh, ElementShape shape, double thickness, const std::string& file)
      : mesh_(mesh), file_(file) {
    imported_.body.shape = shape;
    imported_.body.thickness = thickness;
  }

  ImportedMesh run(const std::array<bool, 6>& faces) {
    number_nodes();
    take_elements();
    list_sides();
    make_faces(faces);
    for (std::size_t group = 0; group < mesh_.groups.size(); ++group) add_group(group);
    return std::move(imported_);
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;

  [[nodiscard]] bool of_body(const ElementBlock& block) const {
    return dimension_of(block.kind) == imported_.body.dimension();
  }
  /// Nodes of an element in the mesh, as many as the shape has.
  [[nodiscard]] std::vector<std::uint32_t> nodes_of_element(const ElementBlock& block, std::size_t n) const {
    std::vector<std::uint32_t> nodes(block.corners(n).begin(), block.corners(n).end());
    const auto others = block.others(n).first(nodes_of(imported_.body.shape) - nodes.size());
    nodes.insert(nodes.end(), others.begin(), others.end());
    return nodes;
  }

  void number_nodes() {
    number_.assign(mesh_.node.size(), kNone);
    for (const ElementBlock& block : mesh_.blocks)
      for (std::size_t n = 0; n < block.size() && of_body(block); ++n)
        for (const std::uint32_t node : nodes_of_element(block, n)) number_[node] = 0;
    for (std::size_t node = 0; node < number_.size(); ++node)
      if (number_[node] != kNone) {
        number_[node] = static_cast<std::uint32_t>(imported_.body.node.size());
        imported_.body.node.push_back(mesh_.node[node]);
      }
  }

  void take_elements() {
    MeshBody& body = imported_.body;
    for (const ElementBlock& block : mesh_.blocks)
      for (std::size_t n = 0; n < block.size() && of_body(block); ++n) {
        std::vector<std::uint32_t> nodes = nodes_of_element(block, n);
        if (measure(mesh_, block, n).size < 0) {
          const std::vector<std::uint32_t> from = nodes;
          const std::vector<std::size_t> order = reversed(body.shape);
          for (std::size_t a = 0; a < nodes.size(); ++a) nodes[a] = from[order[a]];
        }
        for (const std::uint32_t node : nodes) body.corner.push_back(number_[node]);
        body.number.push_back(block.number[n]);
      }
  }

  /// Corners of a side: its nodes but for those in the middle of edges.
  [[nodiscard]] std::size_t side_corners() const {
    if (imported_.body.dimension() == 2) return 2;
    return imported_.body.shape == ElementShape::t4 ? 3 : 4;
  }
  template <class Nodes>
  [[nodiscard]] SideKey key_of(const Nodes& nodes) const {
    SideKey key{kNone, kNone, kNone, kNone};
    std::copy_n(nodes.begin(), side_corners(), key.begin());
    std::sort(key.begin(), key.end());
    return key;
  }
  [[nodiscard]] Side side_at(const SideOfElement& at) const {
    return with_element(imported_.body.shape, [&]<class E>(E) {
      Side side;
      for (const int a : E::sides[at.side])
        side.node.push_back(imported_.body.nodes(at.element)[static_cast<std::size_t>(a)]);
      return side;
    });
  }

  void list_sides() {
    const std::size_t count = with_element(imported_.body.shape, []<class E>(E) { return E::sides.size(); });
    for (std::size_t e = 0; e < imported_.body.elements(); ++e)
      for (std::size_t s = 0; s < count; ++s) {
        SideOfElement at{.key = {}, .element = e, .side = s};
        at.key = key_of(side_at(at).node);
        sides_.push_back(at);
      }
    std::stable_sort(sides_.begin(), sides_.end(),
                     [](const SideOfElement& a, const SideOfElement& b) { return a.key < b.key; });
  }

  /// All sides of elements with these corners: two inside the body, one on its boundary.
  [[nodiscard]] std::span<const SideOfElement> with_key(const SideKey& key) const {
    const auto [first, last] =
        std::equal_range(sides_.begin(), sides_.end(), SideOfElement{.key = key},
                         [](const SideOfElement& a, const SideOfElement& b) { return a.key < b.key; });
    return {first, last};
  }

  void make_faces(const std::array<bool, 6>& faces) {
    const Box box = box_around(mesh_);
    for (const SideOfElement& at : sides_) {
      if (with_key(at.key).size() > 1) continue;
      Side side = side_at(at);
      for (std::size_t face = 0; face < 2 * static_cast<std::size_t>(imported_.body.dimension()); ++face) {
        const std::size_t axis = face / 2;
        const double end = box.center[axis] + (face % 2 == 0 ? -1 : 1) * box.half_size[axis];
        const bool on_face = std::all_of(side.node.begin(), side.node.end(), [&](std::uint32_t node) {
          return std::abs(imported_.body.node[node][axis] - end) <= kRounding * box.half_size[axis];
        });
        if (faces[face] && on_face) imported_.body.face[face].push_back(side);
      }
    }
  }

  [[nodiscard]] std::uint32_t used(std::uint32_t node, const std::string& group) const {
    if (number_[node] != kNone) return number_[node];
    const Point& x = mesh_.node[node];
    throw InputError(
        Location{file_},
        fmt::format("the node at ({:.6g}, {:.6g}, {:.6g}) m of the physical group \"{}\" belongs to "
                    "no element; expected nodes of the body",
                    x[0], x[1], x[2], group));
  }

  void add_group(std::size_t group) {
    const MeshGroup& of = mesh_.groups[group];
    MeshPart part{.name = of.name, .dimension = of.dimension, .nodes = {}, .elements = {}};
    const int dimension = imported_.body.dimension();
    std::size_t element = 0;
    for (const ElementBlock& block : mesh_.blocks) {
      const bool in = std::find(block.groups.begin(), block.groups.end(), group) != block.groups.end();
      for (std::size_t n = 0; n < block.size(); ++n) {
        if (in && of_body(block)) part.elements.push_back(element);
        if (in && !of_body(block))
          for (const std::uint32_t node : block.corners(n)) part.nodes.push_back(used(node, part.name));
        element += of_body(block) ? 1 : 0;
      }
    }
    for (const std::size_t e : part.elements)
      part.nodes.insert(part.nodes.end(), imported_.body.nodes(e).begin(), imported_.body.nodes(e).end());
    if (of.dimension == dimension - 1) add_sides(group, part);
    std::sort(part.nodes.begin(), part.nodes.end());
    part.nodes.erase(std::unique(part.nodes.begin(), part.nodes.end()), part.nodes.end());
    imported_.parts.push_back(std::move(part));
  }

  /// A group of sides is an edge; the nodes in the middle of its sides are of it.
  void add_sides(std::size_t group, MeshPart& part) {
    SideGroup edge{.name = part.name, .sides = {}};
    std::vector<SideKey> keys;
    for (const ElementBlock& block : mesh_.blocks) {
      if (std::find(block.groups.begin(), block.groups.end(), group) == block.groups.end()) continue;
      for (std::size_t n = 0; n < block.size(); ++n) {
        std::vector<std::uint32_t> corners;
        for (const std::uint32_t node : block.corners(n)) corners.push_back(number_[node]);
        const auto found =
            corners.size() == side_corners() ? with_key(key_of(corners)) : std::span<const SideOfElement>{};
        if (found.empty())
          throw InputError(Location{fmt::format("{}, element {}", file_, block.number[n])},
                           fmt::format("this {} of the physical group \"{}\" is not the side of an element; "
                                       "expected lines and faces that elements share",
                                       name_of(block.kind), part.name));
        edge.inside = edge.inside || found.size() > 1;
        keys.push_back(found.front().key);
      }
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    for (const SideKey& key : keys) edge.sides.push_back(side_at(with_key(key).front()));
    for (const Side& side : edge.sides)
      part.nodes.insert(part.nodes.end(), side.node.begin(), side.node.end());
    edge.axis = axis_across(edge);
    imported_.body.group.push_back(std::move(edge));
  }

  [[nodiscard]] std::optional<std::size_t> axis_across(const SideGroup& edge) const {
    const std::vector<Point>& node = imported_.body.node;
    const Box box = box_around(mesh_);
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(imported_.body.dimension()); ++axis) {
      const bool flat = std::all_of(edge.sides.begin(), edge.sides.end(), [&](const Side& side) {
        return std::all_of(side.node.begin(), side.node.end(), [&](std::uint32_t n) {
          return std::abs(node[n][axis] - node[side.node.front()][axis]) <= kRounding * box.half_size[axis];
        });
      });
      if (flat) return axis;
    }
    return std::nullopt;
  }

  const Mesh& mesh_;
  const std::string& file_;
  ImportedMesh imported_;
  std::vector<std::uint32_t> number_;  // of the mesh's nodes in the body
  std::vector<SideOfElement> sides_;   // by their keys
};

}  // namespace

ImportedMesh import_mesh(const Mesh& mesh, ElementShape shape, double thickness,
                         const std::array<bool, 6>& faces, const std::string& file) {
  return Importer(mesh, shape, thickness, file).run(faces);
}

}  // namespace riven
