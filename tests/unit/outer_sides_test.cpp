#include "report/outer_sides.hpp"

#include <gtest/gtest.h>

#include <set>

#include "fem/mesh_body.hpp"

namespace riven::testing {
namespace {

// A block of 3 x 2 x 2 cells shows 2 (3 2 + 3 2 + 2 2) sides, those on the faces that its mesh knows.
TEST(OuterSides, AreThoseOfTheFaces) {
  for (const ElementShape shape : {ElementShape::h8, ElementShape::t4}) {
    const MeshBody mesh = make_mesh(shape, {3, 2, 2}, 1, [](const Point& x) { return x; });
    const CellKind kind = shape == ElementShape::h8 ? CellKind::hexahedron : CellKind::tetrahedron;
    const std::vector<Cells> sides = outer_sides({{kind, mesh.corner}});
    ASSERT_EQ(sides.size(), 1U);
    const std::size_t corners = shape == ElementShape::h8 ? 4 : 3;
    EXPECT_EQ(sides[0].nodes.size(), 32 * (shape == ElementShape::h8 ? 1 : 2) * corners);
    std::set<std::set<std::uint32_t>> shown, expected;
    for (std::size_t n = 0; n < sides[0].nodes.size(); n += corners)
      shown.insert({sides[0].nodes.begin() + static_cast<std::ptrdiff_t>(n),
                    sides[0].nodes.begin() + static_cast<std::ptrdiff_t>(n + corners)});
    for (const auto& face : mesh.face)
      for (const Side& side : face) expected.insert({side.node.begin(), side.node.end()});
    EXPECT_EQ(shown, expected);
  }
}

TEST(OuterSides, OfCellsInAPlaneAreTheCells) {
  const std::vector<Cells> cells{{CellKind::quad, {0, 1, 4, 3}}, {CellKind::triangle, {1, 2, 4}}};
  const std::vector<Cells> shown = outer_sides(cells);
  ASSERT_EQ(shown.size(), 2U);
  EXPECT_EQ(shown[0].nodes, cells[0].nodes);
  EXPECT_EQ(shown[1].nodes, cells[1].nodes);
}

}  // namespace
}  // namespace riven::testing
