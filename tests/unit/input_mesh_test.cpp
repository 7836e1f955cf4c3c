// Bodies from meshes: points and groups, and what is refused with its element.

#include <gtest/gtest.h>

#include <numeric>

#include "input/case_reader.hpp"
#include "input/case_writer.hpp"
#include "input/format.hpp"
#include "input/mesh_points.hpp"
#include "simulation/simulation.hpp"
#include "support/meshes.hpp"
#include "unit/scratch.hpp"

namespace riven::testing {
namespace {

constexpr const char* kPlane = "mesh = { file = \"m.msh\", unit = \"mm\", thickness = \"2 mm\" }";
constexpr const char* kSpace = "mesh = { file = \"m.msh\", unit = \"cm\" }";

class InputMesh : public ::testing::Test {
 protected:
  Case read(const Mesh& mesh, const std::string& geometry, const std::string& more = "") {
    test::write_text(scratch_ / "m.msh", msh_text(mesh, true));
    const std::string rest =
        "\n[model]\nkind = \"lps\"\n[material.m]\nlaw = \"linear-elastic\"\nyoungs_modulus = \"1 "
        "MPa\"\npoissons_ratio = 0.2\n"
        "[solver]\nmethod = \"dynamic-relaxation\"\nstretch = [2]\n";
    return parse_case("title = \"t\"\n[geometry]\n" + geometry + "\n" + more + rest,
                      (scratch_ / "case.toml").string(), {});
  }
  std::string refusal(const Mesh& mesh, const std::string& geometry, const std::string& more = "") {
    return test::message_of<InputError>([&] { read(mesh, geometry, more); });
  }
  test::Scratch scratch_;
};

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Two by two squares with one line along x = 0, y from 0 to 1.
Mesh quadrangles_with_edge() {
  Random random(1);
  Mesh mesh = box_mesh(ElementKind::quadrangle, {3, 2, 0}, 0, random);
  mesh.groups.push_back({1, "side"});
  mesh.blocks.push_back(
      {.kind = ElementKind::line, .entity = 1, .groups = {1}, .node = {0, 4}, .number = {77}});
  return mesh;
}

TEST_F(InputMesh, GivesAPointForEachElement) {
  const Case c = read(quadrangles_with_edge(), kPlane);
  const GeometryInput& g = c.geometry;
  ASSERT_TRUE(g.points);
  EXPECT_TRUE(g.points->is_mesh());
  EXPECT_EQ(g.dimension, 2);
  EXPECT_EQ(g.bonds, "listed");
  EXPECT_DOUBLE_EQ(g.spacing, 1e-3);
  EXPECT_DOUBLE_EQ(g.horizon, 3e-3);
  ASSERT_EQ(g.points->list->position.size(), 6U);
  EXPECT_NEAR(g.points->list->position[4][0], 1.5e-3, 1e-18);
  EXPECT_NEAR(g.points->list->position[4][1], 1.5e-3, 1e-18);
  EXPECT_NEAR(g.points->list->volume[4], 2e-9, 1e-24);
  const Box& box = std::get<Box>(g.shape);
  EXPECT_NEAR(box.half_size[0], 1.5e-3, 1e-18);
  EXPECT_NEAR(box.center[1], 1e-3, 1e-18);
}

TEST_F(InputMesh, HasTheVolumeOfItsBoxAndAllEdges) {
  for (unsigned seed = 1; seed <= 5; ++seed)
    for (const ElementKind kind : kBodyKinds) {
      Random random(seed);
      const bool plane = dimension_of(kind) == 2;
      const Case c = read(box_mesh(kind, {4, 3, 3}, 0.1, random), plane ? kPlane : kSpace);
      EXPECT_EQ(c.geometry.dimension, dimension_of(kind));
      EXPECT_NEAR(sum(c.geometry.points->list->volume), plane ? 4 * 3 * 2e-9 : 4 * 3 * 3 * 1e-6,
                  plane ? 1e-20 : 1e-17);
      EXPECT_EQ(edge_names(c).size(), plane ? 4U : 6U);
    }
}

TEST_F(InputMesh, MakesSetsOfGroups) {
  const Simulation simulation = build_simulation(
      read(quadrangles_with_edge(), kPlane, "[set.all]\ngroup = \"body\"\n[set.side]\ngroup = \"side\"\n"));
  EXPECT_EQ(simulation.set("all").points.size(), 6U);
  // The line ends in the middle of the left side: both squares there have a node of it.
  EXPECT_EQ(simulation.set("side").points, (std::vector<std::size_t>{0, 3}));
}

TEST_F(InputMesh, DropsPointsOfGroupsThatLieInHoles) {
  const Simulation simulation =
      build_simulation(read(quadrangles_with_edge(), kPlane,
                            "[[hole]]\ndisc = { center = [\"0.5 mm\", \"0.5 mm\"], radius = \"0.3 mm\" "
                            "}\n[set.side]\ngroup = \"side\"\n"));
  ASSERT_EQ(simulation.set("side").points.size(), 1U);
  const Point x = simulation.body->position(simulation.body->points[simulation.set("side").points[0]]);
  EXPECT_NEAR(x[1], 1.5e-3, 1e-15);
}

TEST_F(InputMesh, JoinsGroupsOfOneName) {
  Mesh mesh = quadrangles_with_edge();
  mesh.groups.push_back({0, "side"});  // another dimension, the same name: corner (3, 2)
  mesh.blocks.push_back(
      {.kind = ElementKind::point, .entity = 1, .groups = {2}, .node = {11}, .number = {78}});
  const Simulation simulation = build_simulation(read(mesh, kPlane, "[set.s]\ngroup = \"side\"\n"));
  EXPECT_EQ(simulation.set("s").points, (std::vector<std::size_t>{0, 3, 5}));
}

TEST_F(InputMesh, IsWrittenAsItWasRead) {
  const Case first = read(quadrangles_with_edge(), kPlane, "[set.side]\ngroup = \"side\"\n");
  const std::string text = resolved_case(first);
  const Case second = parse_case(text, (scratch_ / "case.toml").string(), {});
  EXPECT_EQ(resolved_case(second), text);
  EXPECT_EQ(second.geometry.points->list->position, first.geometry.points->list->position);
  EXPECT_EQ(second.geometry.horizon, first.geometry.horizon);
}

TEST_F(InputMesh, TakesSurfacesThatAreTurnedOver) {
  Random random(1);
  Mesh mesh = box_mesh(ElementKind::triangle, {3, 3, 0}, 0.1, random);
  const double area = sum(read(mesh, kPlane).geometry.points->list->volume);
  for (std::size_t n = 0; n < mesh.blocks[0].size(); ++n)
    std::swap(mesh.blocks[0].node[3 * n], mesh.blocks[0].node[3 * n + 1]);
  EXPECT_NEAR(sum(read(mesh, kPlane).geometry.points->list->volume), area, 1e-15 * area);
  std::swap(mesh.blocks[0].node[12], mesh.blocks[0].node[13]);
  EXPECT_NE(
      refusal(mesh, kPlane).find("element 5: this triangle is turned over against others of its surface"),
      std::string::npos);
}

TEST_F(InputMesh, RefusesTurnedAndFlatElementsOfAnyKind) {
  for (const ElementKind kind : kBodyKinds) {
    const bool plane = dimension_of(kind) == 2;
    Random random(1);
    Mesh mesh = box_mesh(kind, {2, 2, 2}, 0, random);
    const std::size_t corners = corners_of(kind), last = (mesh.blocks[0].size() - 1) * corners;
    Mesh flat = mesh;
    for (std::size_t c = 0; c < corners; ++c)
      flat.blocks[0].node[last + c] = flat.blocks[0].node[last + c % 2];
    const std::string element =
        ", element " + std::to_string(mesh.blocks[0].size()) + ": this " + name_of(kind) + " is ";
    EXPECT_NE(refusal(flat, plane ? kPlane : kSpace).find(element + "flat"), std::string::npos)
        << refusal(flat, plane ? kPlane : kSpace);
    if (plane) continue;
    // Each order of corners that mirrors the element turns it over as a whole.
    for (std::size_t n = 0; n < mesh.blocks[0].size(); ++n) {
      std::uint32_t* c = &mesh.blocks[0].node[n * corners];
      if (kind == ElementKind::tetrahedron) std::swap(c[0], c[1]);
      if (kind == ElementKind::pyramid) std::swap(c[1], c[3]);
      if (kind == ElementKind::hexahedron) std::swap_ranges(c, c + 4, c + 4);
      if (kind == ElementKind::prism) std::swap_ranges(c, c + 3, c + 3);
    }
    EXPECT_NE(
        refusal(mesh, kSpace).find(", element 1: this " + std::string(name_of(kind)) + " is turned over"),
        std::string::npos);
  }
}

TEST_F(InputMesh, IsRefusedWhereItIsNoBody) {
  const Mesh good = quadrangles_with_edge();
  const auto changed = [&](const auto& change) {
    Mesh mesh = good;
    change(mesh);
    return mesh;
  };
  const struct {
    Mesh mesh;
    std::string said, geometry = kPlane, more;
  } mistakes[] = {
      {changed([](Mesh& m) { m.blocks.clear(); }), "m.msh: the mesh has no elements; expected triangles"},
      {changed([](Mesh& m) { m.blocks.erase(m.blocks.begin()); }),
       "m.msh: the mesh has lines only; expected triangles"},
      {changed([](Mesh& m) { m.node[11][2] = 0.1; }),
       "m.msh, element 6: the mesh has surface elements only, and they reach from z = 0 m to 0.0001 m"},
      {changed([](Mesh& m) {
         m.node.push_back({9, 9, 0});
         m.blocks[1].node[1] = 12;
       }),
       "m.msh, element 77: this line hangs on no element of 2 dimensions"},
      {changed([](Mesh& m) { std::swap(m.blocks[0].node[1], m.blocks[0].node[2]); }),
       "m.msh, element 1: this quadrangle is folded"},
      {changed([](Mesh& m) {
         m.blocks[0].number.push_back(8);
         for (std::size_t n = 0; n < 4; ++n) m.blocks[0].node.push_back(m.blocks[0].node[n]);
       }),
       "m.msh, element 8: the point at (0.0005, 0.0005) m stands in element 1 already"},
      {good, "mesh.thickness: missing; a body in two dimensions", "mesh = { file = \"m.msh\" }"},
      {good, "unit: found \"MPa\"; expected a unit of length",
       "mesh = { file = \"m.msh\", unit = \"MPa\", thickness = \"1 mm\" }"},
      {good, "unit: found \"mm^2\"; expected a unit of length",
       "mesh = { file = \"m.msh\", unit = \"mm^2\", thickness = \"1 mm\" }"},
      {good, "none.msh: there is no such file", "mesh = { file = \"none.msh\", thickness = \"1 mm\" }"},
      {good, "bonds: points from a file are on no lattice", std::string(kPlane) + "\nbonds = \"lattice\""},
      {good, "set.s.group: the mesh has no physical group \"sde\"; it has body, side; did you mean \"side\"?",
       kPlane, "[set.s]\ngroup = \"sde\"\n"},
      {good, "set.s.group: belongs to bodies from a mesh",
       "box = { size = [\"1 m\"], area = \"1 mm^2\", points = [9] }", "[set.s]\ngroup = \"side\"\n"},
      {good, "set.left: \"left\" is the name of an edge", kPlane, "[set.left]\ngroup = \"side\"\n"},
      {changed([](Mesh& m) {
         m.blocks[0].number.pop_back();
         m.blocks[0].node.resize(20);
       }),
       "load.1.on: the body has no edge \"top\": its boundary does not cover all of that side of the box "
       "around it; known are "
       "left, bottom; expected a set",
       kPlane, "[[load]]\non = \"top\"\ndisplacement = [0, 0]\n"},
  };
  for (const auto& mistake : mistakes) {
    const std::string found = refusal(mistake.mesh, mistake.geometry, mistake.more);
    EXPECT_NE(found.find(mistake.said), std::string::npos) << found << "\nexpected: " << mistake.said;
    EXPECT_NE(found.find("case.toml:"), std::string::npos) << found;
  }
  Random random(1);
  EXPECT_NE(refusal(box_mesh(ElementKind::hexahedron, {2, 2, 2}, 0, random), kPlane)
                .find("thickness: belongs to bodies in two"),
            std::string::npos);
}

TEST_F(InputMesh, MayHavePointsLeftFromDrawing) {
  Mesh mesh = quadrangles_with_edge();
  mesh.node.push_back({1, 1, 5});
  mesh.blocks.push_back(
      {.kind = ElementKind::point, .entity = 1, .groups = {}, .node = {12}, .number = {99}});
  EXPECT_EQ(read(mesh, kPlane).geometry.points->list->position.size(), 6U);
}

TEST_F(InputMesh, MayLieInAPlaneAboveTheOrigin) {
  Mesh mesh = quadrangles_with_edge();
  for (Point& x : mesh.node) x[2] = 40;
  EXPECT_EQ(read(mesh, kPlane).geometry.points->list->position[0][2], 0);
}

}  // namespace
}  // namespace riven::testing
