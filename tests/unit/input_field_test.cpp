// Fields: values at places that formulas read by name.

#include "input/field_function.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "base/error.hpp"
#include "input/case_reader.hpp"
#include "input/case_writer.hpp"
#include "input/expression.hpp"
#include "simulation/resume.hpp"
#include "simulation/simulation.hpp"
#include "support/random.hpp"
#include "unit/scratch.hpp"

namespace riven::testing {
namespace {

/// Anywhere in [-3, 3] along each axis.
Point some_place(Random& random, int dimension) {
  Point x{};
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) x[a] = random.between(-3, 3);
  return x;
}

TEST(FieldFunction, GivesTheValueOfTheNearestPlace) {
  Random random(1);
  for (const int dimension : {1, 2, 3}) {
    PointList places;
    places.dimension = dimension;
    TableFunction::Column value{"v", {}, {}};
    for (int n = 0; n < 300; ++n) {
      places.position.push_back(some_place(random, dimension));
      value.values.push_back(n);
    }
    const double spacing = 0.6;
    const FieldFunction field("v", places, value, spacing);
    int found = 0;
    for (int n = 0; n < 1000; ++n) {
      const Point x = some_place(random, dimension);
      std::size_t nearest = 0;
      double least = INFINITY;
      for (std::size_t p = 0; p < places.position.size(); ++p) {
        const Point& place = places.position[p];
        const double distance = std::hypot(place[0] - x[0], place[1] - x[1], place[2] - x[2]);
        if (distance >= least) continue;
        least = distance;
        nearest = p;
      }
      const auto there = field.at(x);
      if (least <= 0.5 * spacing) {
        ASSERT_TRUE(there);
      }
      if (least > 0.51 * spacing) {
        ASSERT_FALSE(there);
      }
      if (there) {
        EXPECT_EQ(*there, static_cast<double>(nearest));
      }
      found += there ? 1 : 0;
    }
    EXPECT_GT(found, 10);
  }
}

TEST(FieldInFormulas, IsReadInAnyOrderOfPlaces) {
  PointList places;
  TableFunction::Column value{"v", {}, {}};
  for (int n = 0; n < 5; ++n) {
    places.position.push_back({static_cast<double>(n), 0, 0});
    value.values.push_back(10 + n);
  }
  const auto field = std::make_shared<const FieldFunction>("v", places, value, 1.0);
  const Expression formula("2*v + x", "2*v + x", {}, {.tables = {}, .fields = {{field}}});
  Random random(2);
  for (int round = 0; round < 200; ++round) {
    const int repeats = random.integer(1, 3), count = random.integer(1, 6);
    std::vector<double> order;
    for (int n = 0; n < count; ++n) order.push_back(random.integer(0, 4));
    for (int repeat = 0; repeat < repeats; ++repeat)
      for (const double x : order) {
        ASSERT_EQ(formula(Variables{.position = {x, 0, 0}}), 2 * (10 + x) + x);
      }
    EXPECT_THROW(formula(Variables{.position = {7, 0, 0}}), InputError);
  }
}

class Field : public ::testing::Test {
 protected:
  /// A bar of 4 points 1 mm apart, from 0 to 4 mm.
  Case read(const std::string& csv, const std::string& velocity,
            const std::string& field = "file = \"v.csv\"", const std::string& more = "",
            const std::string& name = "v0") {
    test::write_text(scratch_ / "v.csv", csv);
    return parse_case("title = \"t\"\n" + more +
                          "[geometry]\nbox = { size = [\"4 mm\"], from = [0], area = \"1 mm^2\", points = "
                          "[4] }\nhorizon = \"1 dx\"\n[field." +
                          name + "]\n" + field +
                          "\n[model]\nkind = \"pmb\"\n[material.m]\nlaw = \"linear-elastic\"\nyoungs_modulus "
                          "= \"1 GPa\"\ndensity = \"1000 kg/m^3\"\n[[initial]]\nvelocity = [\"" +
                          velocity + "\"]\n[solver]\nmethod = \"verlet\"\nuntil = \"1 us\"\n",
                      (scratch_ / "case.toml").string(), {});
  }
  std::string refusal(const std::string& csv, const std::string& velocity = "v0",
                      const std::string& field = "file = \"v.csv\"", const std::string& more = "",
                      const std::string& name = "v0") {
    return test::message_of<InputError>(
        [&] { static_cast<void>(build_simulation(read(csv, velocity, field, more, name))); });
  }
  test::Scratch scratch_;
};

const std::string kRows = "x [mm],v [mm/s]\n3.5,4\n0.5,1\n1.5,2\n2.6,3\n";

TEST_F(Field, IsReadByFormulasAtTheirPoints) {
  const Simulation simulation = build_simulation(read(kRows, "2 * v0 + 1 m/s"));
  const std::vector<double> wanted = {1.002, 1.004, 1.006, 1.008};
  for (std::size_t n = 0; n < 4; ++n)
    EXPECT_DOUBLE_EQ(simulation.initial_v[simulation.entry(0, n)], wanted[n]);
}

TEST_F(Field, HasSeveralColumnsOfWhichOneIsNamed) {
  const Simulation simulation = build_simulation(read(
      "a [K],x [mm],b [m/s]\n1,0.5,5\n1,1.5,6\n1,2.5,7\n1,3.5,8\n", "v0", "file = \"v.csv\"\nvalue = \"b\""));
  EXPECT_DOUBLE_EQ(simulation.initial_v[simulation.entry(0, 3)], 8);
}

TEST_F(Field, MakesSets) {
  const Case c = read(kRows, "1 m/s", "file = \"v.csv\"", "[set.fast]\nwhere = \"v0 > 2.5 mm/s\"\n");
  EXPECT_EQ(build_simulation(c).set("fast").points, (std::vector<std::size_t>{2, 3}));
}

TEST_F(Field, IsWrittenAsItWasRead) {
  const std::string text = resolved_case(read(kRows, "v0"));
  EXPECT_NE(text.find("[field.v0]\nfile = \"v.csv\"\nvalue = \"v [mm/s]\"\n"), std::string::npos) << text;
  EXPECT_EQ(resolved_case(parse_case(text, (scratch_ / "case.toml").string(), {})), text);
}

TEST_F(Field, DecidesWhetherARunMayGoOn) {
  const auto values = decisive_values(read(kRows, "v0"));
  EXPECT_EQ(decisive_values(read(kRows, "v0")), values);
  const auto others = decisive_values(read(kRows + "4.5,5\n", "v0"));
  EXPECT_NE(others.at("field.v0.file"), values.at("field.v0.file"));
}

TEST_F(Field, IsRefusedWithItsPlace) {
  const std::string file = "file = \"v.csv\"";
  const struct {
    std::string said, csv = kRows, velocity = "v0", field = "file = \"v.csv\"", more, name = "v0";
  } mistakes[] = {
      {"\"v0\": the field v0 has no value at (0.0025, 0, 0) m; expected a row of",
       "x [mm],v [mm/s]\n0.5,1\n1.5,2\n3.5,4\n"},
      {"initial.1.velocity.1", kRows, "v0 * 1 s"},
      {"the field v0 gives a velocity (\"v [mm/s]\")", kRows, "v0 * 1 s"},
      {"joins quantities that do not fit together", kRows, "v0 + 1 mm"},
      {"did you mean \"v0\"", kRows, "v00"},
      {"\"v0\" is a field; formulas that know x, y, z read it by its name alone", kRows, "v0(x)"},
      {"a product needs its sign: write \"2*v0\"", kRows, "2 v0"},
      {"v.csv:1: expected a column \"x\"", "a [mm],v [mm/s]\n1,1\n"},
      {"v.csv:1: found a column \"z\"; the body has x only", "x [mm],z [mm],v [mm/s]\n1,1,1\n"},
      {"v.csv:1: found the columns x [mm], u, v; expected one of values beside the places",
       "x [mm],u,v\n1,1,1\n"},
      {"v.csv:1: expected a column \"w\"", kRows, "v0", file + "\nvalue = \"w\""},
      {"v.csv:1: found the columns x [mm], v [mm/s]; expected one of values", kRows, "v0",
       file + "\nvalue = \"x\""},
      {"v.csv:2: column \"v\": found nan; expected a finite number", "x [mm],v\n1,nan\n"},
      {"v.csv:3: column \"x [mm]\": found inf; expected a finite number", "x [mm],v\n1,1\ninf,1\n"},
      {"v.csv:4: the point at (0.0005, 0) m stands in line 2 already; expected each place once",
       "x [mm],v [mm/s]\n0.5,1\n1.5,2\n0.5,1\n"},
      {"v.csv:1: found no row below the column names", "x [mm],v\n"},
      {"v.csv:1: column \"x\" has no unit", "x,v\n1,2\n"},
      {"no.csv: there is no such file", kRows, "v0", "file = \"no.csv\""},
      {"field.v0: \"v0\" is the name of a table at", kRows, "v0", file,
       "[table.v0]\nfile = \"v.csv\"\noutside = \"hold\"\n"},
      {"field.mm: \"mm\" is a unit in formulas; expected another name, such as \"mm_field\"", kRows, "1 m/s",
       file, "", "mm"},
      {"field.v-0: found the name \"v-0\", which formulas could not use", kRows, "1 m/s", file, "", "v-0"},
  };
  for (const auto& mistake : mistakes) {
    std::string csv = mistake.csv;
    if (!mistake.more.empty()) csv = "x [mm],v [mm/s]\n0.5,1\n1.5,2\n2.5,3\n3.5,4\n";
    const std::string found = refusal(csv, mistake.velocity, mistake.field, mistake.more, mistake.name);
    EXPECT_NE(found.find(mistake.said), std::string::npos) << found << "\nexpected: " << mistake.said;
    EXPECT_NE(found.find("case.toml"), std::string::npos) << found;
  }
  // A constant has no place.
  EXPECT_NE(
      refusal(kRows, "1 m/s", file, "[set.s]\nbox = { size = [\"v0 * 1 s\"] }\n").find("\"v0\" is a field"),
      std::string::npos);
}

}  // namespace
}  // namespace riven::testing
