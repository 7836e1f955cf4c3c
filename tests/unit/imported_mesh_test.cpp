// Meshes of files as finite elements: the same body as the generator's, and what is refused.

#include "fem/imported_mesh.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "geometry/gmsh.hpp"
#include "geometry/mesh_faults.hpp"
#include "support/element_meshes.hpp"
#include "support/finite_element_bodies.hpp"
#include "unit/scratch.hpp"

namespace riven::testing {
namespace {

constexpr std::array<bool, 6> kAllFaces{true, true, true, true, true, true};

MeshBody grid(ElementShape shape) {
  return make_mesh(shape, dimension_of(shape) == 3 ? std::vector{3, 2, 2} : std::vector{3, 2}, 0.7,
                   [](const Point& x) { return x; });
}

ImportedMesh imported(const Mesh& mesh, ElementShape shape, double thickness = 0.7) {
  return import_mesh(mesh, shape, dimension_of(shape) == 3 ? 1 : thickness, kAllFaces, "m.msh");
}

std::string refusal(const Mesh& mesh, ElementShape shape) {
  return test::message_of<InputError>([&] { static_cast<void>(imported(mesh, shape)); });
}

TEST(ImportedMesh, IsTheBodyThatWasWritten) {
  const test::Scratch scratch;
  for (const ElementShape shape : element_shapes())
    for (const bool binary : {false, true}) {
      Random random(1);
      MeshBody body = distorted(shape, random, false);  // keeps the box
      if (body.dimension() == 3) body.thickness = 1;
      test::write_text(scratch / "m.msh", msh_text(as_mesh(body), binary));
      const ImportedMesh found = imported(read_gmsh(scratch / "m.msh"), shape);
      EXPECT_EQ(found.body.node, body.node);
      EXPECT_EQ(found.body.corner, body.corner);
      EXPECT_EQ(found.body.label(2), 1002U);
      const auto faces = 2 * static_cast<std::size_t>(body.dimension());
      ASSERT_EQ(found.body.edges(), 6 + faces);
      for (std::size_t face = 0; face < faces; ++face)
        for (const std::size_t edge : {face, 6 + face}) {
          EXPECT_EQ(found.body.nodes_on(edge), body.nodes_on(face)) << name_of(shape);
          EXPECT_NEAR(found.body.face_area(edge), body.face_area(face), 1e-15);
          EXPECT_EQ(found.body.axis_across(edge), face / 2);
        }
      ASSERT_EQ(found.parts.size(), 1 + faces);
      EXPECT_EQ(found.parts[0].elements.size(), body.elements());
      EXPECT_EQ(found.parts[0].nodes.size(), body.node.size());
      EXPECT_EQ(found.parts[2].nodes.size(), body.nodes_on(1).size());
      EXPECT_TRUE(found.parts[2].elements.empty());
    }
}

// Sides are seen from outside: their normals times areas sum up to nothing, and point away from the middle.
TEST(ImportedMesh, HasSidesThatFaceOutwards) {
  for (const ElementShape shape : element_shapes()) {
    const ImportedMesh found = imported(as_mesh(grid(shape)), shape);
    for (std::size_t edge = 6; edge < found.body.edges(); ++edge)
      for (const Side& side : found.body.sides(edge)) {
        const auto x = [&](std::size_t a) -> Eigen::Vector3d {
          return Eigen::Vector3d(found.body.node[side.node[a]].data()) - Eigen::Vector3d(0.5, 0.5, 0.5);
        };
        const Eigen::Vector3d along = x(1) - x(0);
        const Eigen::Vector3d normal = found.body.dimension() == 2
                                           ? Eigen::Vector3d(along.cross(Eigen::Vector3d::UnitZ()))
                                           : Eigen::Vector3d(along.cross(Eigen::Vector3d(x(2) - x(1))));
        EXPECT_GT(normal.dot(x(0)), 0);
      }
  }
}

TEST(ImportedMesh, TurnsClockwiseElementsOver) {
  for (const ElementShape shape : {ElementShape::t3, ElementShape::q4, ElementShape::q8}) {
    Random random(2);
    const MeshBody body = distorted(shape, random);
    Mesh mesh = as_mesh(body);
    for (Point& x : mesh.node) x[0] = -x[0];
    const ImportedMesh found = imported(mesh, shape);
    check_elements(found.body);
    for (std::size_t face = 0; face < 4; ++face)
      EXPECT_NEAR(found.body.face_area(6 + face), body.face_area(face), 1e-14);
    const double volume = [&] {
      double sum = 0;
      for (const double v : body.lumped_volumes()) sum += v;
      return sum;
    }();
    double sum = 0;
    for (const double v : found.body.lumped_volumes()) sum += v;
    EXPECT_NEAR(sum, volume, 1e-14);
    ASSERT_EQ(oddities(mesh).size(), 1U);
    EXPECT_TRUE(oddities(mesh)[0].starts_with(std::to_string(body.elements()) +
                                              " elements of the mesh go clockwise"));
  }
}

TEST(ImportedMesh, LeavesOutTheMiddleOfNineNodesAndWhatIsInNoElement) {
  const MeshBody body = grid(ElementShape::q8);
  Mesh mesh = as_mesh(body);
  std::vector<std::uint32_t> further;
  for (std::size_t e = 0; e < body.elements(); ++e) {
    const auto others = mesh.blocks[0].others(e);
    further.insert(further.end(), others.begin(), others.end());
    further.push_back(static_cast<std::uint32_t>(mesh.node.size()));
    mesh.node.push_back(body.centre(e));
  }
  mesh.blocks[0].further = further;
  EXPECT_TRUE(oddities(mesh).empty());
  mesh.node.insert(mesh.node.begin(), Point{9, 9, 0});  // the centre of an arc
  for (ElementBlock& block : mesh.blocks)
    for (auto* list : {&block.node, &block.further})
      for (std::uint32_t& node : *list) ++node;
  const ImportedMesh found = imported(mesh, ElementShape::q8);
  EXPECT_EQ(found.body.node, body.node);
  EXPECT_EQ(found.body.corner, body.corner);
  EXPECT_EQ(oddities(mesh),
            (std::vector<std::string>{"1 nodes of the mesh belong to no element and are left out, the "
                                      "first at (9, 9, 0) m"}));
}

TEST(ImportedMesh, KnowsPointsAndLinesOfGroups) {
  Mesh mesh = as_mesh(grid(ElementShape::h8));
  mesh.groups.push_back({0, "tip"});
  mesh.groups.push_back({1, "rim"});
  mesh.blocks.push_back({.kind = ElementKind::point,
                         .entity = 1,
                         .groups = {mesh.groups.size() - 2},
                         .node = {5},
                         .number = {7}});
  mesh.blocks.push_back({.kind = ElementKind::line,
                         .entity = 1,
                         .groups = {mesh.groups.size() - 1},
                         .node = {4, 5},
                         .number = {8}});
  const ImportedMesh found = imported(mesh, ElementShape::h8);
  const MeshPart& tip = found.parts[found.parts.size() - 2];
  EXPECT_EQ(tip.name, "tip");
  EXPECT_EQ(tip.nodes, (std::vector<std::size_t>{5}));
  EXPECT_EQ(found.parts.back().nodes, (std::vector<std::size_t>{4, 5}));
}

TEST(ImportedMesh, KnowsSidesInsideTheBody) {
  Mesh mesh = as_mesh(grid(ElementShape::q4));
  const std::uint32_t a = mesh.blocks[0].node[1],
                      b = mesh.blocks[0].node[2];  // right side of the first element
  mesh.groups.push_back({1, "seam"});
  mesh.blocks.push_back({.kind = ElementKind::line,
                         .entity = 9,
                         .groups = {mesh.groups.size() - 1},
                         .node = {b, a},
                         .number = {7}});
  const ImportedMesh found = imported(mesh, ElementShape::q4);
  EXPECT_TRUE(found.body.group.back().inside);
  EXPECT_FALSE(found.body.group.front().inside);
  EXPECT_EQ(found.body.group.back().sides.size(), 1U);
}

TEST(ImportedMesh, RefusesGroupsOffItsSides) {
  Mesh mesh = as_mesh(grid(ElementShape::q4));
  mesh.groups.push_back({1, "cut"});
  mesh.blocks.push_back({.kind = ElementKind::line,
                         .entity = 9,
                         .groups = {mesh.groups.size() - 1},
                         .node = {mesh.blocks[0].node[0], mesh.blocks[0].node[2]},
                         .number = {77}});
  EXPECT_EQ(refusal(mesh, ElementShape::q4),
            "m.msh, element 77: this line of the physical group \"cut\" is not the side of an element; "
            "expected lines and "
            "faces that elements share");
  mesh = as_mesh(grid(ElementShape::q4));
  mesh.node.push_back({2, 3, 0});
  mesh.groups.push_back({0, "far"});
  mesh.blocks.push_back({.kind = ElementKind::point,
                         .entity = 9,
                         .groups = {mesh.groups.size() - 1},
                         .node = {static_cast<std::uint32_t>(mesh.node.size() - 1)},
                         .number = {78}});
  EXPECT_EQ(refusal(mesh, ElementShape::q4),
            "m.msh: the node at (2, 3, 0) m of the physical group \"far\" belongs to no element; expected "
            "nodes of the "
            "body");
}

// ---- faults ----

std::string fault(const Mesh& mesh) {
  return test::message_of<InputError>([&] { check_conforming(mesh, "m.msh"); });
}

/// The mesh, with a copy of node `node` in the elements of the body whose centre is right of it.
Mesh torn_at(Mesh mesh, const std::vector<std::uint32_t>& nodes) {
  for (const std::uint32_t node : nodes) {
    const auto copy = static_cast<std::uint32_t>(mesh.node.size());
    mesh.node.push_back(mesh.node[node]);
    for (std::size_t n = 0; n < mesh.blocks[0].size(); ++n)
      if (measure(mesh, mesh.blocks[0], n).centroid[0] > mesh.node[node][0])
        for (std::uint32_t& corner : mesh.blocks[0].node)
          if (corner == node && static_cast<std::size_t>(&corner - mesh.blocks[0].node.data()) /
                                        corners_of(mesh.blocks[0].kind) ==
                                    n)
            corner = copy;
  }
  return mesh;
}

std::vector<std::uint32_t> nodes_at(const Mesh& mesh, double x) {
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t n = 0; n < mesh.node.size(); ++n)
    if (std::abs(mesh.node[n][0] - x) < 1e-9) nodes.push_back(n);
  return nodes;
}

TEST(MeshFaults, AreNotInSoundMeshes) {
  for (const ElementShape shape : element_shapes()) {
    Random random(3);
    const Mesh mesh = as_mesh(distorted(shape, random));
    check_conforming(mesh, "m.msh");
    EXPECT_TRUE(oddities(mesh).empty()) << name_of(shape);
  }
}

TEST(MeshFaults, AreNamed) {
  for (const ElementShape shape : {ElementShape::t3, ElementShape::q4, ElementShape::t4, ElementShape::h8}) {
    const Mesh mesh = as_mesh(grid(shape));
    const auto seam = nodes_at(mesh, 2.0 / 3);
    const std::string said = fault(torn_at(mesh, seam));
    EXPECT_NE(said.find("the mesh falls into 2 parts that share no node; the least of"), std::string::npos)
        << said;
    EXPECT_NE(said.find(std::to_string(seam.size()) + " pairs of nodes of different parts lie at one place"),
              std::string::npos)
        << said;
    // One node torn is a slit.
    const auto odd = oddities(torn_at(mesh, {seam[0]}));
    ASSERT_EQ(odd.size(), 1U) << name_of(shape);
    EXPECT_TRUE(odd[0].starts_with("1 pairs of nodes lie at one place")) << odd[0];
  }
}

TEST(MeshFaults, SeeHangingNodes) {
  // Two small quadrangles beside a large one: the node between them hangs on its side.
  Mesh mesh{.node = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {2, 1, 0}, {3, 0, 0}, {3, 1, 0}, {3, 2, 0}},
            .blocks = {},
            .groups = {}};
  mesh.blocks.push_back({.kind = ElementKind::quadrangle,
                         .entity = 1,
                         .groups = {},
                         .node = {0, 1, 2, 3, 1, 5, 6, 4, 4, 6, 7, 2},
                         .number = {11, 12, 13}});
  EXPECT_EQ(fault(mesh),
            "m.msh, element 11: a node at (2, 1, 0) m hangs on a side of this quadrangle without being one "
            "of its nodes; "
            "expected elements that share whole sides");
  mesh.node[4] = {2.01, 1, 0};  // a gap, which is no fault of this kind
  check_conforming(mesh, "m.msh");
}

TEST(MeshFaults, SeeElementsThatLieOnEachOther) {
  Mesh mesh = as_mesh(grid(ElementShape::t3));
  for (int copy = 0; copy < 2; ++copy) {
    for (int c = 0; c < 3; ++c)
      mesh.blocks[0].node.push_back(mesh.blocks[0].node[static_cast<std::size_t>(c)]);
    mesh.blocks[0].number.push_back(500);
  }
  EXPECT_NE(fault(mesh).find("belongs to"), std::string::npos);
}

}  // namespace
}  // namespace riven::testing
