#pragma once

#include <array>
#include <cstring>
#include <map>
#include <sstream>
#include <string>

#include "geometry/mesh.hpp"
#include "support/random.hpp"

namespace riven::testing {

inline constexpr std::array kBodyKinds = {ElementKind::triangle,    ElementKind::quadrangle,
                                          ElementKind::tetrahedron, ElementKind::hexahedron,
                                          ElementKind::prism,       ElementKind::pyramid};

/// One element on corners of the unit cube or square.
inline Mesh unit_element(ElementKind kind) {
  std::vector<Point> node = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                             {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  if (kind == ElementKind::triangle) node = {node[0], node[1], node[3]};
  if (kind == ElementKind::tetrahedron) node = {node[0], node[1], node[3], node[4]};
  if (kind == ElementKind::prism) node = {node[0], node[1], node[3], node[4], node[5], node[7]};
  node.resize(corners_of(kind));
  ElementBlock block{.kind = kind, .entity = 1, .groups = {}, .node = {}, .number = {1}};
  for (std::uint32_t n = 0; n < node.size(); ++n) block.node.push_back(n);
  return {.node = node, .blocks = {block}, .groups = {}};
}

/// A box of cells cut into elements of one kind, its inner nodes moved at random by up to `jitter` cells.
/// Corner (0, 0, 0) at the origin; cells are cubes of edge 1. The group "body" has all elements.
inline Mesh box_mesh(ElementKind kind, std::array<int, 3> cells, double jitter, Random& random) {
  const bool plane = dimension_of(kind) == 2;
  if (plane) cells[2] = 0;
  Mesh mesh;
  mesh.groups = {{dimension_of(kind), "body"}};
  for (int k = 0; k <= cells[2]; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i) {
        Point x{1.0 * i, 1.0 * j, 1.0 * k};
        const std::array<int, 3> at = {i, j, k};
        for (std::size_t a = 0; a < (plane ? 2U : 3U); ++a)
          if (at[a] > 0 && at[a] < cells[a]) x[a] += random.between(-jitter, jitter);
        mesh.node.push_back(x);
      }
  ElementBlock block{.kind = kind, .entity = 1, .groups = {0}, .node = {}, .number = {}};
  const auto node = [&](int i, int j, int k) {
    return static_cast<std::uint32_t>((k * (cells[1] + 1) + j) * (cells[0] + 1) + i);
  };
  const std::map<ElementKind, std::vector<std::vector<std::size_t>>> cuts = {
      {ElementKind::triangle, {{0, 1, 2}, {0, 2, 3}}},
      {ElementKind::quadrangle, {{0, 1, 2, 3}}},
      {ElementKind::tetrahedron,
       {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}}},
      {ElementKind::hexahedron, {{0, 1, 2, 3, 4, 5, 6, 7}}},
      {ElementKind::prism, {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}}},
      {ElementKind::pyramid,  // corner 8 is the middle of the cell
       {{0, 1, 2, 3, 8},
        {7, 6, 5, 4, 8},
        {0, 4, 5, 1, 8},
        {1, 5, 6, 2, 8},
        {2, 6, 7, 3, 8},
        {3, 7, 4, 0, 8}}}};
  for (int k = 0; k < std::max(cells[2], 1); ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i) {
        const int top = plane ? k : k + 1;
        std::vector<std::uint32_t> corner = {
            node(i, j, k),   node(i + 1, j, k),   node(i + 1, j + 1, k),   node(i, j + 1, k),
            node(i, j, top), node(i + 1, j, top), node(i + 1, j + 1, top), node(i, j + 1, top)};
        if (kind == ElementKind::pyramid) {
          Point middle{};
          for (const std::uint32_t c : corner)
            for (std::size_t a = 0; a < 3; ++a) middle[a] += mesh.node[c][a] / 8;
          corner.push_back(static_cast<std::uint32_t>(mesh.node.size()));
          mesh.node.push_back(middle);
        }
        for (const auto& element : cuts.at(kind)) {
          for (const std::size_t c : element) block.node.push_back(corner[c]);
          block.number.push_back(block.number.size() + 1);
        }
      }
  mesh.blocks = {block};
  return mesh;
}

/// Writes numbers as MSH 4.1 has them, in one of its two ways.
class MshNumbers {
 public:
  explicit MshNumbers(bool binary) : binary_(binary) {}
  template <class Number>
  void add(Number value) {
    if (binary_) {
      std::array<char, sizeof value> bytes;
      std::memcpy(bytes.data(), &value, sizeof value);
      text_.append(bytes.begin(), bytes.end());
    } else {
      std::ostringstream out;
      out.precision(17);
      out << value << ' ';
      text_ += out.str();
    }
  }
  void integer(int value) { add<std::int32_t>(value); }
  void count(std::size_t value) { add<std::uint64_t>(value); }
  void line() {
    if (!binary_) text_ += '\n';
  }
  std::string section(const std::string& name) { return "$" + name + "\n" + text_ + "\n$End" + name + "\n"; }

 private:
  bool binary_;
  std::string text_;
};

/// Gmsh's number of a block's elements, of first or second order.
inline int msh_type(const ElementBlock& block) {
  const std::map<ElementKind, int> types = {{ElementKind::point, 15},      {ElementKind::line, 1},
                                            {ElementKind::triangle, 2},    {ElementKind::quadrangle, 3},
                                            {ElementKind::tetrahedron, 4}, {ElementKind::hexahedron, 5},
                                            {ElementKind::prism, 6},       {ElementKind::pyramid, 7}};
  if (block.further.empty()) return types.at(block.kind);
  if (block.kind == ElementKind::line) return 8;
  if (block.kind == ElementKind::triangle) return 9;
  return block.further.size() == 4 * block.size() ? 16 : 10;  // quadrangles of eight and of nine nodes
}

/// A mesh as a file of MSH 4.1: node n has the number 10 n + 7.
inline std::string msh_text(const Mesh& mesh, bool binary) {
  std::string text = binary ? std::string("$MeshFormat\n4.1 1 8\n\1\0\0\0\n$EndMeshFormat\n", 40)
                            : "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  text += "$PhysicalNames\n" + std::to_string(mesh.groups.size()) + "\n";
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    text += std::to_string(mesh.groups[g].dimension) + " " + std::to_string(g + 1) + " \"" +
            mesh.groups[g].name + "\"\n";
  text += "$EndPhysicalNames\n";

  std::map<std::pair<int, int>, std::vector<std::size_t>> entities;
  std::size_t elements = 0;
  for (const ElementBlock& block : mesh.blocks) {
    entities[{dimension_of(block.kind), block.entity}] = block.groups;
    elements += block.size();
  }
  MshNumbers entity(binary), node(binary), element(binary);
  for (int d = 0; d < 4; ++d)
    entity.count(static_cast<std::size_t>(
        std::count_if(entities.begin(), entities.end(), [d](const auto& e) { return e.first.first == d; })));
  entity.line();
  for (const auto& [of, groups] : entities) {
    entity.integer(of.second);
    for (int b = 0; b < (of.first == 0 ? 3 : 6); ++b) entity.add(0.5 * b);
    entity.count(groups.size());
    for (const std::size_t g : groups) entity.integer(static_cast<int>(g + 1));
    if (of.first > 0) entity.count(0);
    entity.line();
  }
  for (const std::size_t n : {std::size_t{1}, mesh.node.size(), std::size_t{7}, 10 * mesh.node.size()})
    node.count(n);
  node.line();
  for (const int n : {mesh.dimension(), 1, 0}) node.integer(n);
  node.count(mesh.node.size());
  for (std::size_t n = 0; n < mesh.node.size(); ++n) node.line(), node.count(10 * n + 7);
  for (const Point& x : mesh.node) {
    node.line();
    for (const double value : x) node.add(value);
  }
  for (const std::size_t n : {mesh.blocks.size(), elements, std::size_t{1}, elements}) element.count(n);
  for (const ElementBlock& block : mesh.blocks) {
    element.line();
    for (const int n : {dimension_of(block.kind), block.entity, msh_type(block)}) element.integer(n);
    element.count(block.size());
    for (std::size_t n = 0; n < block.size(); ++n) {
      element.line();
      element.count(block.number[n]);
      for (const std::uint32_t c : block.corners(n)) element.count(10 * c + 7);
      for (const std::uint32_t c : block.others(n)) element.count(10 * c + 7);
    }
  }
  return text + entity.section("Entities") + node.section("Nodes") + element.section("Elements");
}

}  // namespace riven::testing
