#include "geometry/gmsh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "geometry/file_cursor.hpp"

namespace riven {
namespace {

/// What Gmsh numbers as one of its element types: kind and number of nodes, the corners first.
struct GmshType {
  ElementKind kind;
  std::size_t nodes;
};

const std::map<int, GmshType>& gmsh_types() {
  using enum ElementKind;
  static const std::map<int, GmshType> types = {
      {15, {point, 1}},        {1, {line, 2}},         {2, {triangle, 3}},     {3, {quadrangle, 4}},
      {4, {tetrahedron, 4}},   {5, {hexahedron, 8}},   {6, {prism, 6}},        {7, {pyramid, 5}},
      {8, {line, 3}},          {9, {triangle, 6}},     {10, {quadrangle, 9}},  {16, {quadrangle, 8}},
      {11, {tetrahedron, 10}}, {12, {hexahedron, 27}}, {17, {hexahedron, 20}}, {13, {prism, 18}},
      {18, {prism, 15}},       {14, {pyramid, 14}},    {19, {pyramid, 13}}};
  return types;
}

class GmshReader {
 public:
  explicit GmshReader(const std::filesystem::path& file) : in_(file) {}

  Mesh read() {
    do {
      read_section();
    } while (!in_.at_end());
    in_.enter("");
    for (const char* section : {"MeshFormat", "Nodes", "Elements"})
      if (!seen_.contains(section)) in_.expect_word(fmt::format("${}", section));
    join_groups();
    return std::move(mesh_);
  }

 private:
  using Entity = std::pair<int, std::int64_t>;  // dimension and tag

  void read_section() {
    in_.enter("");
    const std::string_view word = in_.word();
    if (!word.starts_with('$') || (seen_.empty() && word != "$MeshFormat" && word != "$Comments"))
      in_.fail(fmt::format(
          "found {}; expected {}", FileCursor::described(word),
          seen_.empty() ? "$MeshFormat: a mesh in Gmsh's format MSH 4.1" : "a section, such as $Nodes"));
    const std::string name(word.substr(1));
    const bool known = name == "MeshFormat" || name == "PhysicalNames" || name == "Entities" ||
                       name == "Nodes" || name == "Elements";
    if (known && !seen_.insert(name).second) in_.fail(fmt::format("${} stands here a second time", name));
    in_.enter(fmt::format("${}", name));
    if (!known) return in_.skip_behind("$End" + name);
    in_.skip_line();
    if (name == "MeshFormat") read_format();
    if (name == "PhysicalNames") read_names();
    if (name == "Entities") read_entities();
    if (name == "Nodes") read_nodes();
    if (name == "Elements") read_elements();
    in_.expect_word("$End" + name);
  }

  void read_format() {
    const std::string version(in_.word());
    if (version != "4.1")
      in_.fail(fmt::format(
          "found version {} of the format MSH; expected 4.1: \"gmsh old.msh -save -format msh41 -o "
          "new.msh\" writes it",
          FileCursor::described(version)));
    const int type = in_.written<int>("0 (ASCII) or 1 (binary)");
    if (type != 0 && type != 1) in_.fail(fmt::format("found {}; expected 0 (ASCII) or 1 (binary)", type));
    const int bytes = in_.written<int>("8, the bytes of a count");
    if (bytes != 8) in_.fail(fmt::format("found counts of {} bytes; expected 8", bytes));
    if (type == 0) return;
    in_.skip_line();
    in_.set_binary();
    const int one = in_.integer("the number 1");
    if (one == 0x01000000)
      in_.fail("the file is big-endian; expected one of a little-endian machine, or ASCII");
    if (one != 1)
      in_.fail(fmt::format("found {}; expected the number 1, which tells the order of bytes", one));
  }

  // Written out in binary files too.
  void read_names() {
    for (std::size_t n = in_.written_count("the number of physical names"); n > 0; --n) {
      const int dimension = in_.written<int>("a dimension");
      const int tag = in_.written<int>("the number of a physical group");
      names_[{dimension, tag}] = in_.quoted("the name of a physical group");
    }
  }

  void read_entities() {
    std::array<std::size_t, 4> counts{};
    for (std::size_t& n : counts) n = in_.count("a number of entities");
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::size_t n = counts[static_cast<std::size_t>(dimension)]; n > 0; --n) {
        const int tag = in_.integer("the number of an entity");
        for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) in_.real("a bound of an entity");
        std::vector<std::int64_t>& groups = groups_of_[{dimension, tag}];
        for (std::size_t g = in_.count("a number of physical groups"); g > 0; --g)
          groups.push_back(std::abs(
              std::int64_t{in_.integer("the number of a physical group")}));  // a sign tells the direction
        if (dimension == 0) continue;
        for (std::size_t b = in_.count("a number of bounding entities"); b > 0; --b)
          in_.integer("the number of a bounding entity");
      }
  }

  void read_nodes() {
    std::size_t blocks = in_.count("a number of blocks");
    const std::size_t nodes = in_.count("a number of nodes");
    in_.tag("the smallest number of a node");
    in_.tag("the largest number of a node");
    for (; blocks > 0; --blocks) {
      const int dimension = in_.integer("the dimension of an entity");
      if (dimension < 0 || dimension > 3)
        in_.fail(fmt::format("found dimension {}; expected 0 to 3", dimension));
      in_.integer("the number of an entity");
      const int parameters = in_.integer("0 or 1") != 0 ? dimension : 0;
      const std::size_t count = in_.count("a number of nodes");
      for (std::size_t n = 0; n < count; ++n) {
        const std::size_t tag = in_.tag("the number of a node");
        if (!node_.emplace(tag, static_cast<std::uint32_t>(node_.size())).second)
          in_.fail(fmt::format("node {} stands here a second time", tag));
      }
      for (std::size_t n = 0; n < count; ++n) {
        Point& x = mesh_.node.emplace_back();
        for (double& coordinate : x) coordinate = in_.real("a coordinate of a node");
        for (int i = 0; i < parameters; ++i) in_.real("a parameter of a node");
      }
    }
    if (mesh_.node.size() != nodes)
      in_.fail(fmt::format("found {} nodes; expected {}, as the section says", mesh_.node.size(), nodes));
  }

  void read_elements() {
    if (!seen_.contains("Nodes")) in_.fail("found $Elements before $Nodes; expected nodes first");
    std::size_t blocks = in_.count("a number of blocks"), found = 0;
    const std::size_t elements = in_.count("a number of elements");
    in_.tag("the smallest number of an element");
    in_.tag("the largest number of an element");
    for (; blocks > 0; --blocks) {
      const int dimension = in_.integer("the dimension of an entity");
      const int entity = in_.integer("the number of an entity");
      const GmshType type = read_type(dimension);
      ElementBlock block{
          .kind = type.kind, .entity = entity, .groups = {}, .node = {}, .number = {}, .further = {}};
      for (std::size_t n = in_.count("a number of elements"); n > 0; --n) read_element(type, block);
      found += block.size();
      mesh_.blocks.push_back(std::move(block));
    }
    if (found != elements)
      in_.fail(fmt::format("found {} elements; expected {}, as the section says", found, elements));
  }

  GmshType read_type(int dimension) {
    const int number = in_.integer("an element type");
    const auto type = gmsh_types().find(number);
    if (type == gmsh_types().end())
      in_.fail(
          fmt::format("found element type {}; expected points, lines, triangles, quadrangles, tetrahedra, "
                      "hexahedra, prisms or pyramids of first or second order (types 1 to 19)",
                      number));
    if (dimension_of(type->second.kind) != dimension)
      in_.fail(fmt::format("found a {} in an entity of dimension {}", name_of(type->second.kind), dimension));
    return type->second;
  }

  void read_element(const GmshType& type, ElementBlock& block) {
    block.number.push_back(in_.tag("the number of an element"));
    for (std::size_t n = 0; n < type.nodes; ++n) {
      const std::size_t tag = in_.tag("the number of a node");
      const auto node = node_.find(tag);
      if (node == node_.end())
        in_.fail(fmt::format("element {} has node {}, which is not in $Nodes", block.number.back(), tag));
      (n < corners_of(type.kind) ? block.node : block.further).push_back(node->second);
    }
  }

  void join_groups() {
    std::map<Entity, std::size_t> number;  // of the mesh's groups, by dimension and tag
    for (ElementBlock& block : mesh_.blocks) {
      const int dimension = dimension_of(block.kind);
      for (const std::int64_t tag : groups_of_[{dimension, block.entity}]) {
        const auto [group, is_new] = number.emplace(Entity{dimension, tag}, mesh_.groups.size());
        if (is_new) {
          const auto name = names_.find({dimension, tag});
          mesh_.groups.push_back({dimension, name == names_.end() ? std::to_string(tag) : name->second});
        }
        block.groups.push_back(group->second);
      }
    }
  }

  FileCursor in_;
  Mesh mesh_;
  std::set<std::string> seen_;  // sections
  std::map<Entity, std::string> names_;
  std::map<Entity, std::vector<std::int64_t>> groups_of_;  // physical groups of an entity
  std::unordered_map<std::size_t, std::uint32_t> node_;    // by the number in the file
};

}  // namespace

Mesh read_gmsh(const std::filesystem::path& file) {
  return GmshReader(file).read();
}

}  // namespace riven
