#include "geometry/mesh_faults.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/disjoint_sets.hpp"
#include "base/error.hpp"

namespace riven {
namespace {

constexpr double kRounding = 1e-6;  // of a side: files keep six digits and more

using Vector = Eigen::Vector3d;
using SideKey = std::array<std::uint32_t, 4>;  // corners, ascending, and what no node is called

/// A side of an element, its nodes in their order round it.
struct ElementSide {
  const ElementBlock* block = nullptr;
  std::size_t element = 0;
  std::vector<std::uint32_t> node;  // corners
  std::vector<std::uint32_t> all;   // and, of second order in the plane, the node between
};

std::string text(const Point& x) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", x[0], x[1], x[2]);
}

class MeshSides {
 public:
  explicit MeshSides(const Mesh& mesh) : mesh_(mesh), dimension_(mesh.dimension()) {
    for (const ElementBlock& block : mesh.blocks)
      for (std::size_t n = 0; n < block.size() && of_body(block); ++n) {
        const auto others = block.others(n);
        std::size_t number = 0;
        for (const std::vector<std::size_t>& corners : sides_of(block.kind)) {
          ElementSide side{.block = &block, .element = n, .node = {}, .all = {}};
          for (const std::size_t c : corners) side.node.push_back(block.corners(n)[c]);
          side.all = side.node;
          if (dimension_ == 2 && number < others.size()) side.all.push_back(others[number]);
          SideKey key{};
          key.fill(std::numeric_limits<std::uint32_t>::max());
          std::copy(side.node.begin(), side.node.end(), key.begin());
          std::sort(key.begin(), key.end());
          found_[key].push_back(std::move(side));
          ++number;
        }
      }
  }

  [[nodiscard]] bool of_body(const ElementBlock& block) const {
    return dimension_of(block.kind) == dimension_;
  }
  [[nodiscard]] const std::map<SideKey, std::vector<ElementSide>>& found() const { return found_; }

  /// Nodes of the boundary by their x.
  [[nodiscard]] std::vector<std::uint32_t> boundary_nodes() const {
    std::vector<std::uint32_t> nodes;
    for (const auto& [key, sides] : found_)
      if (sides.size() == 1) nodes.insert(nodes.end(), sides[0].all.begin(), sides[0].all.end());
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::stable_sort(nodes.begin(), nodes.end(), [this](std::uint32_t a, std::uint32_t b) {
      return mesh_.node[a][0] < mesh_.node[b][0];
    });
    return nodes;
  }

  /// Nodes of such a list whose x is within a range.
  [[nodiscard]] std::span<const std::uint32_t> between(const std::vector<std::uint32_t>& nodes, double low,
                                                       double high) const {
    const auto x = [this](std::uint32_t node) { return mesh_.node[node][0]; };
    const auto first = std::partition_point(nodes.begin(), nodes.end(), [&](auto n) { return x(n) < low; });
    const auto last = std::partition_point(first, nodes.end(), [&](auto n) { return x(n) <= high; });
    return {first, last};
  }

 private:
  const Mesh& mesh_;
  int dimension_;
  std::map<SideKey, std::vector<ElementSide>> found_;
};

/// Distance below which two nodes lie at one place (m).
double touch(const Mesh& mesh) {
  const Box box = box_around(mesh);
  return 1e-9 * std::max(box.half_size[0], box.half_size[1]);
}

/// For each node of the boundary one at its place, if there is another: of the lower number.
std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_at_one_place(const Mesh& mesh,
                                                                        const MeshSides& sides) {
  const double near = touch(mesh);
  const std::vector<std::uint32_t> nodes = sides.boundary_nodes();
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const std::uint32_t a : nodes)
    for (const std::uint32_t b : sides.between(nodes, mesh.node[a][0] - near, mesh.node[a][0] + near))
      if (a < b && (Vector(mesh.node[a].data()) - Vector(mesh.node[b].data())).norm() <= near)
        pairs.emplace_back(a, b);
  return pairs;
}

[[noreturn]] void fail(const std::string& file, const ElementBlock& block, std::size_t n,
                       const std::string& what) {
  throw InputError(Location{fmt::format("{}, element {}", file, block.number[n])}, what);
}

void check_parts(const Mesh& mesh, const MeshSides& sides, const std::string& file) {
  DisjointSets sets(mesh.node.size());
  std::map<std::uint32_t, std::size_t> elements;  // of each part, by its root
  const auto each = [&](const auto& visit) {
    for (const ElementBlock& block : mesh.blocks)
      for (std::size_t n = 0; n < block.size() && sides.of_body(block); ++n) visit(block, n);
  };
  each([&](const ElementBlock& block, std::size_t n) {
    for (const std::uint32_t node : block.corners(n)) sets.join(block.corners(n)[0], node);
  });
  each([&](const ElementBlock& block, std::size_t n) { ++elements[sets.root(block.corners(n)[0])]; });
  if (elements.size() == 1) return;
  const auto least = std::min_element(elements.begin(), elements.end(),
                                      [](const auto& a, const auto& b) { return a.second < b.second; });
  const auto pairs = pairs_at_one_place(mesh, sides);
  const auto torn = std::count_if(pairs.begin(), pairs.end(), [&](const auto& pair) {
    return sets.root(pair.first) != sets.root(pair.second);
  });
  each([&](const ElementBlock& block, std::size_t n) {
    if (sets.root(block.corners(n)[0]) != least->first) return;
    fail(
        file, block, n,
        fmt::format("the mesh falls into {} parts that share no node; the least of {} element{} holds this "
                    "one, at {}{}; expected one body",
                    elements.size(), least->second, least->second == 1 ? "" : "s",
                    text(mesh.node[block.corners(n)[0]]),
                    torn == 0 ? std::string()
                              : fmt::format(". {} pairs of nodes of different parts lie at one place: "
                                            "\"Coherence;\" in Gmsh's drawing, or \"Coherence Mesh;\", makes "
                                            "them one",
                                            torn)));
  });
}

void check_shared_sides(const MeshSides& sides, const Mesh& mesh, const std::string& file) {
  for (const auto& [key, shared] : sides.found())
    if (shared.size() > 2)
      fail(file, *shared[2].block, shared[2].element,
           fmt::format("the side at {} belongs to {} elements; expected two at most: elements that do not "
                       "overlap",
                       text(mesh.node[shared[0].node[0]]), shared.size()));
}

/// Whether a place lies on a straight side and at none of its corners.
bool lies_within(const Mesh& mesh, const ElementSide& side, const Vector& place) {
  const auto x = [&](std::size_t c) { return Vector(mesh.node[side.node[c % side.node.size()]].data()); };
  const double size = (x(1) - x(0)).norm(), near = kRounding * size;
  for (std::size_t c = 0; c < side.node.size(); ++c)
    if ((place - x(c)).norm() <= near) return false;
  if (side.node.size() == 2) {
    const Vector along = (x(1) - x(0)) / size;
    const double at = along.dot(place - x(0));
    return at > 0 && at < size && (place - x(0) - at * along).norm() <= near;
  }
  const Vector normal = (x(1) - x(0)).cross(x(2) - x(0)).normalized();
  if (std::abs(normal.dot(place - x(0))) > near) return false;
  for (std::size_t c = 0; c < side.node.size(); ++c)
    if ((x(c + 1) - x(c)).cross(place - x(c)).dot(normal) < -near * (x(c + 1) - x(c)).norm()) return false;
  return true;
}

void check_hanging(const Mesh& mesh, const MeshSides& sides, const std::string& file) {
  const std::vector<std::uint32_t> nodes = sides.boundary_nodes();
  for (const auto& [key, shared] : sides.found()) {
    if (shared.size() != 1) continue;
    const ElementSide& side = shared[0];
    double low = mesh.node[side.node[0]][0], high = low;
    for (const std::uint32_t node : side.node) {
      low = std::min(low, mesh.node[node][0]);
      high = std::max(high, mesh.node[node][0]);
    }
    const double margin = kRounding * (high - low) + touch(mesh);
    for (const std::uint32_t node : sides.between(nodes, low - margin, high + margin))
      if (std::find(side.all.begin(), side.all.end(), node) == side.all.end() &&
          lies_within(mesh, side, Vector(mesh.node[node].data())))
        fail(file, *side.block, side.element,
             fmt::format("a node at {} hangs on a side of this {} without being one of its nodes; expected "
                         "elements that share whole sides",
                         text(mesh.node[node]), name_of(side.block->kind)));
  }
}

}  // namespace

void check_conforming(const Mesh& mesh, const std::string& file) {
  const MeshSides sides(mesh);
  check_shared_sides(sides, mesh, file);
  check_hanging(mesh, sides, file);
  check_parts(mesh, sides, file);
}

std::vector<std::string> oddities(const Mesh& mesh) {
  const MeshSides sides(mesh);
  std::vector<std::string> list;
  std::size_t turned = 0;
  std::vector<bool> used(mesh.node.size(), false);
  for (const ElementBlock& block : mesh.blocks)
    for (std::size_t n = 0; n < block.size() && sides.of_body(block); ++n) {
      turned += measure(mesh, block, n).size < 0 ? 1 : 0;
      for (const std::uint32_t node : block.corners(n)) used[node] = true;
      for (const std::uint32_t node : block.others(n)) used[node] = true;
    }
  if (turned > 0)
    list.push_back(
        fmt::format("{} elements of the mesh go clockwise, whole surfaces of them, and are turned "
                    "over",
                    turned));
  if (const auto unused = std::count(used.begin(), used.end(), false); unused > 0)
    list.push_back(fmt::format(
        "{} nodes of the mesh belong to no element and are left out, the first at {}", unused,
        text(
            mesh.node[static_cast<std::size_t>(std::find(used.begin(), used.end(), false) - used.begin())])));
  if (const auto pairs = pairs_at_one_place(mesh, sides); !pairs.empty())
    list.push_back(
        fmt::format("{} pairs of nodes lie at one place, the first at {}: the body has a slit there",
                    pairs.size(), text(mesh.node[pairs[0].first])));
  return list;
}

}  // namespace riven
