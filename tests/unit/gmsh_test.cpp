// Files of Gmsh: both ways of writing say the same, files that Gmsh wrote are read, and what is wrong is
// named.

#include "geometry/gmsh.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "base/error.hpp"
#include "support/meshes.hpp"
#include "unit/scratch.hpp"

namespace riven::testing {
namespace {

class Gmsh : public ::testing::Test {
 protected:
  Mesh read(const std::string& bytes) {
    test::write_text(scratch_ / "m.msh", bytes);
    return read_gmsh(scratch_ / "m.msh");
  }
  /// The message, without the folder of the file.
  std::string refusal(const std::string& bytes) {
    const std::string message = test::message_of<InputError>([&] { read(bytes); });
    const std::string file = (scratch_ / "m.msh").string();
    EXPECT_TRUE(message.starts_with(file)) << message;
    return message.substr(std::min(message.size(), file.size()));
  }
  test::Scratch scratch_;
};

/// A mesh of several kinds of elements and dimensions, with groups.
Mesh plate_with_edges(Random& random) {
  Mesh mesh = box_mesh(ElementKind::triangle, {4, 3, 0}, 0.2, random);
  mesh.groups.push_back({1, "left side"});
  ElementBlock line{.kind = ElementKind::line, .entity = 4, .groups = {1}, .node = {}, .number = {}};
  for (std::uint32_t j = 0; j < 3; ++j) {
    line.node.insert(line.node.end(), {5 * j, 5 * (j + 1)});
    line.number.push_back(100 + j);
  }
  mesh.blocks.insert(mesh.blocks.begin(), line);
  return mesh;
}

void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.node, b.node);
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (std::size_t n = 0; n < a.blocks.size(); ++n) {
    EXPECT_EQ(a.blocks[n].kind, b.blocks[n].kind);
    EXPECT_EQ(a.blocks[n].entity, b.blocks[n].entity);
    EXPECT_EQ(a.blocks[n].node, b.blocks[n].node);
    EXPECT_EQ(a.blocks[n].number, b.blocks[n].number);
    std::set<std::string> names, others;  // the order of groups is that of the blocks
    for (const std::size_t g : a.blocks[n].groups) names.insert(a.groups[g].name);
    for (const std::size_t g : b.blocks[n].groups) others.insert(b.groups[g].name);
    EXPECT_EQ(names, others);
  }
}

TEST_F(Gmsh, IsReadFromText) {
  const Mesh mesh = read(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\nanything $Nodes\n$EndComments\n"
      "$PhysicalNames\n1\n2 5 \"rubber sheet\"\n$EndPhysicalNames\n"
      "$Entities\n1 0 2 0\n9 0 0 0 0\n3 0 0 0 1 1 0 1 -5 0\n4 0 0 0 1 1 0 1 6 0\n$EndEntities\n"
      // The second block says where its node lies on the surface.
      "$Nodes\n2 4 1 30\n2 3 0 3\n1\n2\n30\n0 0 0\n1 0 0\n1 1 0\n2 4 1 1\n4\n-0.0 1.0e0 0 0.5 "
      "0.25\n$EndNodes\n"
      "$Elements\n3 3 1 3\n0 9 15 1\n8 1\n2 3 2 1\n7 1 2 30\n2 4 2 1\n6 1 30 4\n$EndElements\n");
  EXPECT_EQ(mesh.node, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  ASSERT_EQ(mesh.blocks.size(), 3U);
  EXPECT_EQ(mesh.blocks[0].kind, ElementKind::point);
  EXPECT_EQ(mesh.blocks[1].node, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh.blocks[1].number, (std::vector<std::size_t>{7}));
  EXPECT_EQ(mesh.blocks[2].node, (std::vector<std::uint32_t>{0, 2, 3}));
  ASSERT_EQ(mesh.groups.size(), 2U);
  EXPECT_EQ(mesh.groups[mesh.blocks[1].groups.at(0)].name, "rubber sheet");
  EXPECT_EQ(mesh.groups[mesh.blocks[2].groups.at(0)].name, "6");  // it has no name
  EXPECT_EQ(mesh.dimension(), 2);
}

TEST_F(Gmsh, SaysTheSameInTextAndBytes) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    std::vector<Mesh> meshes = {plate_with_edges(random)};
    for (const ElementKind kind : kBodyKinds) meshes.push_back(box_mesh(kind, {3, 2, 2}, 0.2, random));
    for (const Mesh& mesh : meshes) {
      expect_same(read(msh_text(mesh, false)), mesh);
      expect_same(read(msh_text(mesh, true)), mesh);
    }
  }
}

TEST_F(Gmsh, ReadsWindowsLineEnds) {
  Random random(3);
  const Mesh mesh = plate_with_edges(random);
  std::string text = msh_text(mesh, false);
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, "\r");
  expect_same(read(text), mesh);
}

TEST_F(Gmsh, OfSecondOrderGivesTheCorners) {
  const Mesh mesh = read(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 6 1 6\n2 1 0 6\n1\n2\n3\n4\n5\n6\n"
      "0 0 0\n2 0 0\n0 2 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n$Elements\n1 1 1 1\n2 1 9 1\n1 1 2 3 4 5 "
      "6\n$EndElements\n");
  EXPECT_EQ(mesh.blocks[0].kind, ElementKind::triangle);
  EXPECT_EQ(mesh.blocks[0].node, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_DOUBLE_EQ(measure(mesh, mesh.blocks[0], 0).size, 2);
}

/// Elements of each kind, and what they cover together by group; tests/data/gmsh has the drawings.
struct Inventory {
  std::map<ElementKind, std::size_t> elements;
  std::map<std::string, double> size;  // of groups of the mesh's dimension

  explicit Inventory(const Mesh& mesh) {
    for (const ElementBlock& block : mesh.blocks) {
      elements[block.kind] += block.size();
      if (dimension_of(block.kind) != mesh.dimension()) continue;
      for (std::size_t n = 0; n < block.size(); ++n)
        for (const std::size_t g : block.groups) size[mesh.groups[g].name] += measure(mesh, block, n).size;
    }
  }
};

TEST_F(Gmsh, ReadsWhatGmshWrote) {
  const std::filesystem::path data = std::filesystem::path(RIVEN_ROOT) / "tests/data/gmsh";
  for (const char* file : {"plate.msh", "plate-binary.msh"}) {
    const Mesh mesh = read_gmsh(data / file);
    const Inventory found(mesh);
    EXPECT_EQ(found.elements,
              (std::map<ElementKind, std::size_t>{
                  {ElementKind::line, 6}, {ElementKind::triangle, 14}, {ElementKind::quadrangle, 11}}));
    EXPECT_NEAR(found.size.at("foot"), 200, 1e-10);  // files have 16 digits
    EXPECT_NEAR(found.size.at("arm"), 100, 1e-10);
    std::set<std::string> names;
    for (const MeshGroup& group : mesh.groups) names.insert(group.name);
    EXPECT_EQ(names, (std::set<std::string>{"foot", "arm", "top edge", "13"}));
  }
  for (const char* file : {"solid.msh", "solid-binary.msh"}) {
    const Inventory found(read_gmsh(data / file));
    EXPECT_EQ(found.elements, (std::map<ElementKind, std::size_t>{{ElementKind::quadrangle, 4},
                                                                  {ElementKind::tetrahedron, 100},
                                                                  {ElementKind::hexahedron, 8},
                                                                  {ElementKind::prism, 28}}));
    EXPECT_NEAR(found.size.at("glass"), 2000, 1e-9);
    EXPECT_NEAR(found.size.at("rubber"), 1000, 1e-9);
  }
}

// The file ends in a line end, which may be missing.
TEST_F(Gmsh, CutShortAtAnyByteIsRefused) {
  Random random(4);
  for (const bool binary : {false, true}) {
    const std::string whole = msh_text(plate_with_edges(random), binary);
    ASSERT_NO_THROW(read(whole.substr(0, whole.size() - 1)));
    for (std::size_t length = 0; length + 1 < whole.size(); ++length)
      ASSERT_THROW(read(whole.substr(0, length)), InputError)
          << length << (binary ? " bytes" : " characters");
  }
}

TEST_F(Gmsh, WithAnyMistakeIsReadOrRefused) {
  Random random(5);
  int refused = 0, accepted = 0;
  for (int n = 0; n < 1000; ++n) {
    std::string bytes = msh_text(plate_with_edges(random), n % 2 == 0);
    for (int count = random.integer(1, 2); count > 0; --count) {
      const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1));
      if (random.chance(0.5))
        bytes[at] = static_cast<char>(random.integer(0, 255));
      else if (random.chance(0.5))
        bytes.erase(at, static_cast<std::size_t>(random.integer(1, 9)));
      else
        bytes.insert(at, bytes.substr(at, static_cast<std::size_t>(random.integer(1, 9))));
    }
    try {
      read(bytes);
      ++accepted;  // a coordinate is another number
    } catch (const InputError& error) {
      EXPECT_STRNE(error.what(), "");
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
  EXPECT_GT(accepted, 50);
}

TEST_F(Gmsh, NamesWhatIsWrongAndWhere) {
  const std::string format = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  const std::string nodes = "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n";
  const std::string elements = "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n";
  ASSERT_NO_THROW(read(format + nodes + elements));
  const auto changed = [](std::string text, const std::string& old, const std::string& by) {
    return text.replace(text.find(old), old.size(), by);
  };
  const std::pair<std::string, std::string> mistakes[] = {
      {"", ":1: found the end of the file; expected $MeshFormat: a mesh in Gmsh's format MSH 4.1"},
      {"solid ball\n", ":1: found \"solid\"; expected $MeshFormat"},
      {changed(format, "4.1", "2.2"),
       ":2: in $MeshFormat: found version \"2.2\" of the format MSH; expected 4.1: \"gmsh "
       "old.msh -save -format msh41 -o new.msh\" writes it"},
      {changed(format, "4.1 0", "4.1 2"), ":2: in $MeshFormat: found 2; expected 0 (ASCII) or 1 (binary)"},
      {changed(format, "0 8", "0 4"), ":2: in $MeshFormat: found counts of 4 bytes; expected 8"},
      {std::string("$MeshFormat\n4.1 1 8\n\0\0\0\1\n$EndMeshFormat\n", 40),
       ": byte 20 in $MeshFormat: the file is big-endian; expected one of a little-endian machine, or ASCII"},
      {format, ":4: found the end of the file; expected $Nodes; is the file cut short?"},
      {format + nodes, ":14: found the end of the file; expected $Elements; is the file cut short?"},
      {format + elements, ":4: in $Elements: found $Elements before $Nodes; expected nodes first"},
      {format + nodes + nodes, ":14: $Nodes stands here a second time"},
      {format + nodes + "Elements\n", ":14: found \"Elements\"; expected a section, such as $Nodes"},
      {format + "$Periodic\n1\n", ":6: in $Periodic: found the end of the file; expected $EndPeriodic"},
      {format + changed(nodes, "1 0 0", "1 0 O") + elements,
       ":11: in $Nodes: found \"O\"; expected a coordinate of a node"},
      {format + changed(nodes, "1 0 0", "1 0 nan") + elements,
       ":11: in $Nodes: found nan; expected a coordinate of a node, a finite number"},
      {format + changed(nodes, "1 0 0\n", "1 0\n") + elements,
       ":13: in $Nodes: found \"$EndNodes\"; expected a coordinate"},
      {format + changed(nodes, "\n3\n", "\n2\n") + elements,
       ":9: in $Nodes: node 2 stands here a second time"},
      {format + changed(nodes, "1 3 1 3", "1 4 1 3") + elements,
       ":12: in $Nodes: found 3 nodes; expected 4, as the section says"},
      {format + changed(nodes, "2 1 0 3", "2 1 0 -3") + elements,
       ":6: in $Nodes: found \"-3\"; expected a number of nodes"},
      {format + changed(nodes, "2 1 0 3", "2 1 0 300000") + elements,
       ":6: in $Nodes: found 300000 as a number of nodes, more than the rest of the file can hold"},
      {format + changed(nodes, "2 1 0 3", "7 1 0 3") + elements,
       ":6: in $Nodes: found dimension 7; expected 0 to 3"},
      {format + nodes + changed(elements, "1 1 2 3", "1 1 2 4"),
       ":17: in $Elements: element 1 has node 4, which is not in $Nodes"},
      {format + nodes + changed(elements, "2 1 2 1", "2 1 21 1"),
       ":16: in $Elements: found element type 21; expected points, lines, triangles"},
      {format + nodes + changed(elements, "2 1 2 1", "3 1 2 1"),
       ":16: in $Elements: found a triangle in an entity of dimension 3"},
      {format + nodes + changed(elements, "1 1 1 1", "1 2 1 1"),
       ":17: in $Elements: found 1 elements; expected 2, as the section says"},
      {format + nodes + changed(elements, "$EndElements", "$EndElement"),
       ":18: in $Elements: found \"$EndElement\"; expected $EndElements"},
      {format + "$PhysicalNames\n1\n2 1 rubber\n$EndPhysicalNames\n",
       ":6: in $PhysicalNames: expected the name of a physical group in double quotes"},
  };
  for (const auto& [text, said] : mistakes) {
    const std::string found = refusal(text);
    EXPECT_TRUE(found.starts_with(said)) << found << "\nexpected: " << said;
  }
  EXPECT_NE(
      test::message_of<InputError>([&] { read_gmsh(scratch_ / "none.msh"); }).find("there is no such file"),
      std::string::npos);
}

}  // namespace
}  // namespace riven::testing
