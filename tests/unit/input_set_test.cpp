#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "input/case_reader.hpp"
#include "input/case_writer.hpp"
#include "input/set_format.hpp"
#include "scratch.hpp"
#include "simulation/simulation.hpp"

namespace riven {
namespace {

using test::message_of;

/// A sheet of 100 x 80 mm, 50 x 40 points, with a set.
std::string sheet_with(const std::string& set) {
  return fmt::format(R"(
title = "Sheet"
[geometry]
box = {{ size = ["100 mm", "80 mm"], thickness = "1 mm", points = [50, 40] }}
[set.fibers]
{}
[model]
kind = "pmb"
[material.glass]
law = "linear-elastic"
youngs_modulus = "72 GPa"
density = "2440 kg/m^3"
[solver]
method = "verlet"
until = "1 us"
)",
                     set);
}

std::size_t points_of(const std::string& set) {
  return build_simulation(parse_case(sheet_with(set), "case.toml")).set("fibers").points.size();
}

std::string complaint(const std::string& set) {
  return message_of<InputError>([&] { static_cast<void>(parse_case(sheet_with(set), "case.toml")); });
}

TEST(Sets, OfSeveralShapesHaveThePointsOfEach) {
  // Cells of 2 mm: a fibre of 4 x 40 mm has 2 x 20 points; turned by a quarter, 20 x 2.
  EXPECT_EQ(points_of(R"(boxes = [{ size = ["4 mm", "40 mm"], center = ["-30 mm", 0] }])"), 40U);
  EXPECT_EQ(points_of(R"(boxes = [{ size = ["4 mm", "40 mm"], from = ["-32 mm", "-20 mm"] },
                                  { size = ["4 mm", "40 mm"], center = ["10 mm", 0], angle = "90 deg" }])"),
            80U);
  // What two share counts once.
  EXPECT_EQ(
      points_of(R"(boxes = [{ size = ["4 mm", "40 mm"] }, { size = ["4 mm", "40 mm"], angle = "90 deg" }])"),
      76U);
  EXPECT_EQ(
      points_of(
          R"(discs = [{ center = ["1 mm", "1 mm"], radius = "1 mm" }, { center = ["9 mm", "1 mm"], radius = "2.5 mm" }])"),
      1U + 5U);
}

// Counted by the distances along and across the fibre; no point lies on its outline.
TEST(Sets, TurnedBoxesHoldTheirPoints) {
  for (const int degrees : {10, 30, 45, 100, -60}) {
    const double along_x = std::cos(degrees * std::numbers::pi / 180);
    const double along_y = std::sin(degrees * std::numbers::pi / 180);
    std::size_t inside = 0;
    for (int i = 0; i < 50; ++i)
      for (int j = 0; j < 40; ++j) {
        const double x = -49 + 2 * i - 3.37, y = -39 + 2 * j + 1.21;  // mm
        inside += std::abs(along_x * x + along_y * y) < 25 && std::abs(along_x * y - along_y * x) < 3 ? 1 : 0;
      }
    EXPECT_EQ(
        points_of(fmt::format(
            R"(boxes = [{{ size = ["50 mm", "6 mm"], center = ["3.37 mm", "-1.21 mm"], angle = "{} deg" }}])",
            degrees)),
        inside)
        << degrees;
  }
}

TEST(Sets, RandomDiscsAreWrittenAsTheyWereAsked) {
  const Case input =
      parse_case(sheet_with(R"(random_discs = { number = 8, radius = "6 mm", seed = 3 })"), "case.toml");
  const RandomShapesInput& random = *input.sets[0].random_discs;
  EXPECT_EQ(random.places.gap, input.geometry.spacing);
  EXPECT_EQ(random.places.margin, input.geometry.spacing);
  EXPECT_EQ(shapes_of(input.sets[0]).size(), 8U);
  const std::string written = resolved_case(input);
  const Case again = parse_case(written, "resolved.toml");
  EXPECT_EQ(again.sets[0].random_discs->centers, random.centers);
  EXPECT_EQ(resolved_case(again), written);
}

TEST(Sets, ListsSurviveWriting) {
  const Case input =
      parse_case(sheet_with(R"(boxes = [{ size = ["4 mm", "40 mm"], center = ["-30 mm", "1 mm"] },
                                                       { size = ["4 mm", "20 mm"], angle = "30 deg" }])"),
                 "case.toml");
  const Case again = parse_case(resolved_case(input), "resolved.toml");
  ASSERT_EQ(again.sets[0].boxes.size(), 2U);
  for (std::size_t n = 0; n < 2; ++n) {
    const auto& was = std::get<Box>(input.sets[0].boxes[n].shape);
    const auto& is = std::get<Box>(again.sets[0].boxes[n].shape);
    EXPECT_EQ(is.center, was.center);
    EXPECT_EQ(is.half_size, was.half_size);
    EXPECT_EQ(again.sets[0].boxes[n].angle, input.sets[0].boxes[n].angle);
  }
}

TEST(Sets, SayWhatIsWrong) {
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(complaint("discs = []"), "case.toml:6:9: set.fibers.discs: found an empty list");
  has(complaint(R"(discs = [{ center = [0, 0] }])"), "set.fibers.discs.1.radius: missing");
  has(complaint(R"(boxes = [{ size = ["4 mm", "40 mm"], angel = 1 }])"), "did you mean \"angle\"?");
  has(complaint(R"(boxes = [{ size = ["4 mm", "40 mm"], angle = 30 }])"),
      "30 rad is more than a turn; write \"30 deg\"");
  has(complaint(R"(balls = [{ radius = "1 mm" }])"), "belongs to bodies in three dimensions");
  has(complaint(R"(random_balls = { number = 1, radius = "1 mm" })"),
      "belongs to bodies in three dimensions");
  has(complaint(R"(discs = [{ radius = "1 mm" }]
where = "x > 0")"),
      "given together with where; expected exactly one of");
  has(complaint(R"(random_discs = { number = 0, radius = "1 mm" })"), "expected a whole number from 1");
  has(complaint(R"(random_discs = { number = 200000, radius = "1 um" })"), "expected 10000 at most");
  has(complaint(R"(random_discs = { number = 40, radius = "8 mm" })"),
      "no room for 40 discs of radius 0.008 m, 0.002 m apart and 0.002 m from the edge: with the gaps around "
      "them they fill");
  has(complaint(R"(random_discs = { number = 1, radius = "50 mm" })"), "the body is too small for one");
}

}  // namespace
}  // namespace riven
