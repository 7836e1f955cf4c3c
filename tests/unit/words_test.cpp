#include <gtest/gtest.h>

#include "app/commands.hpp"
#include "app/sweep_plan.hpp"
#include "base/error.hpp"
#include "input/case_reader.hpp"
#include "scratch.hpp"

namespace riven::app {
namespace {

using test::message_of;
using Words = std::vector<std::string>;

TEST(Words, ListsAreSplitOutsideOfBracketsAndQuotes) {
  EXPECT_EQ(split_at_commas("a,b, c d "), (Words{"a", "b", "c d"}));
  EXPECT_EQ(split_at_commas("[1, 2],[3,[4,5]]"), (Words{"[1, 2]", "[3,[4,5]]"}));
  EXPECT_EQ(split_at_commas("\"a,b\",'c,]',max(1, 2)"), (Words{"\"a,b\"", "'c,]'", "max(1, 2)"}));
  EXPECT_EQ(split_at_commas("{ x = 1, y = 2 }"), (Words{"{ x = 1, y = 2 }"}));
  EXPECT_EQ(split_at_commas(""), (Words{""}));
  EXPECT_EQ(split_at_commas("a,,b,"), (Words{"a", "", "b", ""}));
}

TEST(Words, NamesOfFiles) {
  EXPECT_EQ(file_word("geometry.horizon=4 dx,k=[1, 2]"), "geometry.horizon=4_dx,k=_1,_2_");
  EXPECT_EQ(file_word("../a/b"), "_._a_b");
  EXPECT_LT(file_word(std::string(1000, 'x')).size(), 200U);
}

TEST(Words, ForTheShell) {
  EXPECT_EQ(shell_word("a=b"), "a=b");
  EXPECT_EQ(shell_word("it's 1"), "'it'\\''s 1'");
  EXPECT_EQ(shell_word(""), "''");
}

using Rows = std::vector<Words>;

TEST(SweptKeys, AreNamesWithValues) {
  const SweptKeys key = swept_keys("load.1.displacement=[0, free],[1 mm, 0]");
  EXPECT_EQ(key.name(), "load.1.displacement");
  EXPECT_EQ(key.values, (Rows{{"[0, free]"}, {"[1 mm, 0]"}}));
  EXPECT_EQ(key.text(1), "[1 mm, 0]");
  const SweptKeys keys = swept_keys("a.number, a.size = (12, [6 mm, 1 mm]),(1e+3,\"x, y\")");
  EXPECT_EQ(keys.names, (Words{"a.number", "a.size"}));
  EXPECT_EQ(keys.values, (Rows{{"12", "[6 mm, 1 mm]"}, {"1e+3", "\"x, y\""}}));
  EXPECT_EQ(keys.text(0), "(12, [6 mm, 1 mm])");
  EXPECT_EQ(swept_keys("k=max(1, 2)").values, (Rows{{"max(1, 2)"}}));
}

TEST(SweptKeys, AreCheckedInAllParts) {
  for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
           {"horizon", "expected KEY=a,b,c"},
           {"=3", "expected KEY=a,b,c"},
           {"a,=(1,2)", "expected KEY=a,b,c"},
           {"k=", "value 1 is empty"},
           {"k=1,,2", "value 2 is empty"},
           {"k=1,2,", "value 3 is empty"},
           {"k=1,2, 1", "the value 1 stands there twice"},
           {"a,b=1,2", "found the value 1 for 2 keys; expected one for each in round brackets"},
           {"a,b=(1,2),(3)", "(3) has 1 value; expected 2"},
           {"a,b=(1,2,3)", "(1,2,3) has 3 values; expected 2"},
           {"a,b=(1,)", "value 1 is empty"},
           {"a,b=(1,2),(1, 2)", "the value (1, 2) stands there twice"}})
    EXPECT_NE(message_of<InputError>([&] { static_cast<void>(swept_keys(text)); }).find(part),
              std::string::npos)
        << text;
  EXPECT_NE(message_of<InputError>([] {
              static_cast<void>(all_swept_keys({"a=1", "b,a=(1,2)"}));
            }).find("a: the key stands there twice"),
            std::string::npos);
}

TEST(SweptKeys, ShortNames) {
  EXPECT_EQ(last_part("set.inclusions.random_discs.seed"), "seed");
  EXPECT_EQ(last_part("solver.stretch.1"), "stretch.1");
  EXPECT_EQ(last_part("load.1.displacement.2"), "displacement.2");
  EXPECT_EQ(last_part("title"), "title");
  EXPECT_EQ(short_names({"a.radius", "b.number"}), (Words{"radius", "number"}));
  EXPECT_EQ(short_names({"a.radius", "b.radius"}), (Words{"a.radius", "b.radius"}));
  EXPECT_TRUE(swept_keys("set.a.random_discs.seed=1,2").repeats());
  EXPECT_FALSE(swept_keys("a.seed,a.radius=(1,2)").repeats());
  EXPECT_FALSE(swept_keys("a.seeds=1,2").repeats());
}

TEST(SweptKeys, ValuesInSi) {
  const Case input = parse_case(R"(
title = "Sheet"
[geometry]
box = { size = ["0.2 m", "0.2 m"], thickness = "10 mm", points = [20, 20] }
horizon = "3 dx"
[[hole]]
disc = { radius = "30 mm" }
[material.rubber]
law = "neo-hookean"
youngs_modulus = "6 MPa"
[[load]]
on = ["left", "right"]
displacement = ["(stretch - 1)*x", "free"]
[solver]
method = "dynamic-relaxation"
stretch = [1.2]
)",
                                "sheet.toml");
  const auto expect = [&](const char* key, double value, const char* unit) {
    const auto si = value_in_si(input, key);
    ASSERT_TRUE(si) << key;
    EXPECT_NEAR(si->value / value, 1, 1e-14) << key;
    EXPECT_EQ(si->unit, unit) << key;
  };
  expect("geometry.horizon", 0.03, "m");
  expect("hole.1.disc.radius", 0.03, "m");
  expect("material.rubber.youngs_modulus", 6e6, "Pa");
  expect("solver.stretch.1", 1.2, "");
  for (const char* key :
       {"geometry.box.points", "load.1.displacement", "load.1.displacement.1", "title", "no.such"})
    EXPECT_FALSE(value_in_si(input, key)) << key;
}

}  // namespace
}  // namespace riven::app
