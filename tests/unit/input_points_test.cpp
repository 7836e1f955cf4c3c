// Bodies from points of a CSV file: what is read, and what is refused with its line.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "input/case_reader.hpp"
#include "input/case_writer.hpp"
#include "unit/scratch.hpp"

namespace riven::testing {
namespace {

constexpr const char* kRest = R"(
[material.rubber]
law = "neo-hookean"
youngs_modulus = "1 MPa"
[solver]
method = "dynamic-relaxation"
stretch = [2]
)";

class Points : public ::testing::Test {
 protected:
  Case read(const std::string& csv, const std::string& geometry) {
    std::ofstream(folder_ / "p.csv") << csv;
    return parse_case("title = \"t\"\n[geometry]\n" + geometry + kRest, (folder_ / "case.toml").string(), {});
  }
  /// The message; it must name the case's line of `points`.
  std::string refusal(const std::string& csv, const std::string& geometry = kPlane) {
    try {
      read(csv, geometry);
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("case.toml:3"), std::string::npos) << error.what();
      return error.what();
    }
    return "accepted";
  }
  static constexpr const char* kPlane = "points = { file = \"p.csv\", thickness = \"2 mm\" }";
  static constexpr const char* kSquare =
      "points = { file = \"p.csv\", thickness = \"2 mm\", box = { size = [\"20 mm\", \"20 mm\"] } }";

  test::Scratch scratch_;
  std::filesystem::path folder_ = scratch_.path();
};

const std::string kFour = "x [mm],y [cm],volume [mm^3]\n5,0.5,200\n-5,0.5,200\n5,-0.5,200\n-5,-0.5,200\n";

TEST_F(Points, AreReadInTheirUnits) {
  const Case c = read(kFour, kSquare);
  const GeometryInput& g = c.geometry;
  ASSERT_TRUE(g.points);
  EXPECT_EQ(g.points->list->position,
            (std::vector<Point>{{0.005, 0.005}, {-0.005, 0.005}, {0.005, -0.005}, {-0.005, -0.005}}));
  EXPECT_EQ(g.points->list->line, (std::vector<int>{2, 3, 4, 5}));
  EXPECT_EQ(g.dimension, 2);
  EXPECT_DOUBLE_EQ(g.points->list->volume[3], 2e-7);
  EXPECT_DOUBLE_EQ(g.spacing, 0.01);  // 200 mm^3 over 2 mm: squares of 10 mm
  EXPECT_DOUBLE_EQ(g.horizon, 0.03);
  EXPECT_EQ(g.bonds, "listed");
  EXPECT_EQ(std::get<Box>(g.shape).half_size, (Point{0.01, 0.01, INFINITY}));
}

TEST_F(Points, TakeAreasTimesTheThickness) {
  const Case c =
      read("# made by hand\nid,area [mm^2],y [mm],x [mm]\n1,100,5,5\n2,100,5,-5\n\n3,100,-5,5\n", kPlane);
  EXPECT_DOUBLE_EQ(c.geometry.points->list->volume[0], 2e-7);
  EXPECT_EQ(c.geometry.points->list->line, (std::vector<int>{3, 4, 6}));
  // Without a box the body ends half a spacing beyond its points, and has no edges.
  EXPECT_NEAR(std::get<Box>(c.geometry.shape).half_size[0], 0.01, 1e-12);
}

TEST_F(Points, ExistInThreeDimensions) {
  const Case c = read("x [m],y [m],z [m],volume [m^3]\n0,0,0,8\n2,0,0,8\n0,2,0,8\n0,0,2,8\n",
                      "points = { file = \"p.csv\", box = { size = [\"4 m\", \"4 m\", \"4 m\"], from = [\"-1 "
                      "m\", \"-1 m\", \"-1 m\"] } }");
  EXPECT_EQ(c.geometry.dimension, 3);
  EXPECT_DOUBLE_EQ(c.geometry.spacing, 2);
  EXPECT_EQ(std::get<Box>(c.geometry.shape).center, (Point{1, 1, 1}));
}

TEST_F(Points, AreWrittenAsTheyWereRead) {
  for (const char* geometry : {kPlane, kSquare}) {
    const Case first = read(kFour, geometry);
    const std::string text = resolved_case(first);
    const Case second = parse_case(text, (folder_ / "case.toml").string(), {});
    EXPECT_EQ(resolved_case(second), text);
    EXPECT_EQ(second.geometry.points->has_edges(), first.geometry.points->has_edges());
    EXPECT_EQ(second.geometry.horizon, first.geometry.horizon);
  }
}

TEST_F(Points, AreRefusedWithTheirLine) {
  const struct {
    std::string csv, said;
    const char* geometry = kPlane;
  } mistakes[] = {
      {"x [mm],volume [mm^3]\n1,2\n1,2\n1,2\n", "p.csv:1: expected a column \"y\""},
      {"x,y [mm],volume [mm^3]\n1,2,3\n1,2,3\n1,2,3\n",
       "p.csv:1: column \"x\" has no unit; write it in brackets: \"x [mm]\""},
      {"x [mm],y [mn],volume [mm^3]\n1,2,3\n1,2,3\n1,2,3\n", "unknown unit \"mn\""},
      {"x [mm],y [ms],volume [mm^3]\n1,2,3\n1,2,3\n1,2,3\n",
       "column \"y [ms]\" is a time; expected a length, such as [mm]"},
      {"x [mm],y [mm],volume [mm^2]\n1,2,3\n1,2,3\n1,2,3\n", "column \"volume [mm^2]\" is an area; expected"},
      {"x [mm],y [mm]\n1,2\n2,3\n3,3\n",
       "expected a column of what belongs to each point, \"volume [mm^3]\" or \"area"},
      {"x [mm],y [mm],volume [mm^3],area [mm^2]\n1,2,3,3\n2,2,3,3\n1,1,3,3\n",
       "volume and area; expected one of them"},
      {"x [mm],y [mm],volume [mm^3]\n1,2,3\n1,,3\n1,3,3\n", "p.csv:3: column \"y [mm]\": expected a number"},
      {"x [mm],y [mm],volume [mm^3]\n1,2,3\n1,nan,3\n1,3,3\n",
       "p.csv:3: column \"y [mm]\": found nan; expected a finite"},
      {"x [mm],y [mm],volume [mm^3]\n1,2,3\n1,3,3\n2,3,-1\n",
       "p.csv:4: column \"volume [mm^3]\": found -1; expected a value above 0"},
      {"x [mm],y [mm],volume [mm^3]\n1,2,3\n1,3,3\n", "found 2 points; expected 3 at least"},
      {kFour + "5,0.5,200\n", "p.csv:6: the point at (0.005, 0.005) m stands in line 2 already"},
      {kFour + "15,0.5,200\n", "p.csv:6: the point at (0.015, 0.005) m lies outside of the box", kSquare},
      {"x [mm],y [mm],z [mm],area [mm^2]\n1,2,3,1\n2,2,3,1\n1,2,4,1\n2,1,1,1\n",
       "expected volume beside x, y, z"},
      {"x [mm],y [mm],z [mm],volume [mm^3]\n1,2,3,1\n2,2,3,1\n1,2,4,1\n2,1,1,1\n",
       "thickness: belongs to bodies in two dimensions"},
      {kFour, "thickness: missing", "points = { file = \"p.csv\" }"},
      {kFour, "p.csvv: there is no such file", "points = { file = \"p.csvv\", thickness = \"2 mm\" }"},
      {kFour, "box: size has 1 entries; expected 2, as the file has columns x, y",
       "points = { file = \"p.csv\", thickness = \"2 mm\", box = { size = [\"1 m\"] } }"},
  };
  for (const auto& mistake : mistakes)
    EXPECT_NE(refusal(mistake.csv, mistake.geometry).find(mistake.said), std::string::npos)
        << refusal(mistake.csv, mistake.geometry);
}

TEST_F(Points, AreOnNoLattice) {
  try {
    read(kFour, std::string(kPlane) + "\nbonds = \"lattice\"");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("case.toml:4"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace riven::testing
