#include "report/page.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "base/error.hpp"
#include "input_cases.hpp"
#include "report/packed.hpp"
#include "scratch.hpp"

namespace riven {
namespace {

using nlohmann::json;
using test::message_of;
using test::read_text;
using test::Scratch;
using test::write_text;

/// Numbers that do not compress.
PointCloud noise(std::size_t points, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  PointCloud cloud;
  for (std::size_t i = 0; i < points; ++i)
    cloud.positions.push_back({1e-3 * static_cast<double>(i % 100), 1e-3 * static_cast<double>(i / 100), 0});
  for (const auto& [name, components] : {std::pair("damage", 1), {"displacement", 3}}) {
    PointField field{name, components, {}, components == 1 ? "" : "m"};
    for (std::size_t n = 0; n < points * static_cast<std::size_t>(components); ++n)
      field.values.push_back(normal(random));
    cloud.fields.push_back(field);
  }
  return cloud;
}

std::filesystem::path state_file(int state) {
  return "fields/" + std::to_string(state) + ".vtu";
}

/// A folder as a run leaves it.
void write_result(const std::filesystem::path& folder, const std::vector<PointCloud>& states) {
  std::filesystem::create_directories(folder / "fields");
  write_text(folder / "case.toml", static_case);
  write_text(folder / "resolved.toml", static_case);
  if (states.empty()) return;
  Collection collection(folder / "fields.pvd");
  for (std::size_t n = 0; n < states.size(); ++n) {
    write_vtu(folder / state_file(static_cast<int>(n)), states[n]);
    collection.add(static_cast<double>(n), state_file(static_cast<int>(n)));
  }
}

std::vector<PointCloud> noises(std::size_t states, std::size_t points) {
  std::vector<PointCloud> clouds;
  for (std::size_t n = 0; n < states; ++n) clouds.push_back(noise(points, static_cast<unsigned>(n)));
  return clouds;
}

class Page : public ::testing::Test {
 protected:
  json write(const std::vector<std::string>& folders, double largest = kLargestPage) {
    std::vector<ReportItem> items;
    for (const std::string& folder : folders) items.push_back({.result = Result::open(scratch / folder)});
    write_page(scratch / "page.html", items, largest);
    const std::string text = read_text(scratch / "page.html");
    EXPECT_LE(static_cast<double>(text.size()), largest);
    page_bytes = static_cast<double>(text.size());
    const std::string begin = "<script id=\"riven-data\" type=\"application/json\">";
    const std::size_t at = text.find(begin) + begin.size();
    return json::parse(text.substr(at, text.find("</script>", at) - at));
  }

  /// Bytes of a page without fields.
  double empty() {
    write_result(scratch / "empty", {});
    static_cast<void>(write({"empty"}));
    return page_bytes;
  }

  Scratch scratch;
  double page_bytes = 0;
};

TEST_F(Page, HoldsEverythingThatFits) {
  write_result(scratch / "a", noises(3, 500));
  const json result = write({"a"})["results"][0];
  EXPECT_EQ(result["title"], "Membrane with a hole");
  EXPECT_EQ(result["status"], "unfinished");
  EXPECT_EQ(result["case_text"], static_case);
  EXPECT_EQ(result["notes"], json::array());
  const json view = result["view"];
  EXPECT_EQ(view["points"], 500);
  EXPECT_EQ(view["points_of"], 500);
  EXPECT_EQ(view["spacing"], 0.005);
  EXPECT_EQ(view["cells"], json::array());
  EXPECT_EQ(view["fields"][0]["name"], "displacement") << "first, wherever it stands in the file";
  EXPECT_EQ(view["fields"][1]["name"], "damage");
  ASSERT_EQ(view["states"].size(), 3u);
  EXPECT_EQ(view["states"][2]["value"], 2);
  EXPECT_EQ(view["states"][2]["values"][0]["count"], 1500);
}

TEST_F(Page, ThinsStatesThenPointsAndSaysSo) {
  const double rest = empty() + 5000;
  write_result(scratch / "states", noises(60, 300));
  json result = write({"states"}, rest + 50 * 300 * 4 * 5)["results"][0];
  const std::size_t states = result["view"]["states"].size();
  EXPECT_GE(states, 40u);
  EXPECT_LT(states, 60u);
  EXPECT_EQ(result["view"]["states"][0]["value"], 0);
  EXPECT_EQ(result["view"]["states"][states - 1]["value"], 59);
  ASSERT_EQ(result["notes"].size(), 1u);
  EXPECT_EQ(result["notes"][0],
            std::to_string(states) + " of 60 states are shown: the first, the last and evenly spaced ones.");

  write_result(scratch / "points", noises(3, 20000));
  result = write({"points"}, rest + 2e5)["results"][0];
  const auto points = result["view"]["points"].get<std::size_t>();
  EXPECT_LT(points, 20000u);
  EXPECT_GT(points, 1000u);
  EXPECT_EQ(result["view"]["points_of"], 20000);
  EXPECT_EQ(result["view"]["states"].size(), 3u);
  EXPECT_EQ(result["view"]["positions"]["count"], 3 * points);
  EXPECT_EQ(result["view"]["states"][1]["values"][0]["count"], 3 * points);
  ASSERT_EQ(result["notes"].size(), 1u);
  const std::string note = result["notes"][0];
  EXPECT_NE(note.find(" of 20 000 points are shown: one per cell of "), note.npos) << note;
  EXPECT_NE(note.find(" mm."), note.npos) << note;
}

TEST_F(Page, ResultsShareThePage) {
  const double rest = empty() + 10000;
  write_result(scratch / "small", noises(2, 50));
  write_result(scratch / "large", noises(4, 20000));
  const json results = write({"small", "large"}, rest + 4e5)["results"];
  EXPECT_EQ(results[0]["view"]["points"], 50);
  EXPECT_EQ(results[0]["notes"], json::array());
  EXPECT_LT(results[1]["view"]["points"], 20000);
  EXPECT_GT(page_bytes, rest + 2e5) << "the large one has what the small one leaves";
}

TEST_F(Page, AMeshKeepsItsCellsAndPointsOrIsRefused) {
  std::vector<PointCloud> states = noises(3, 5000);
  for (PointCloud& state : states)
    state.cells = {{CellKind::quad, {0, 1, 101, 100}}, {CellKind::line, {7, 8}}};
  write_result(scratch / "mesh", states);
  json view = write({"mesh"})["results"][0]["view"];
  EXPECT_EQ(view["cells"][0]["kind"], "quad");
  EXPECT_EQ(view["cells"][0]["nodes"], packed(std::vector<std::uint32_t>{0, 1, 101, 100}));
  EXPECT_EQ(view["cells"][1]["kind"], "line");
  const double rest = empty() + 5000;
  view = write({"mesh"}, rest + 2e5)["results"][0]["view"];
  EXPECT_EQ(view["points"], 5000);
  EXPECT_LT(view["states"].size(), 3u);
  const std::string said = message_of<InputError>([&] { write({"mesh"}, rest + 4e4); });
  EXPECT_NE(said.find("5 000 points of a mesh"), said.npos) << said;
}

TEST_F(Page, OutOfPlaneMotionIsThreeDimensional) {
  std::vector<PointCloud> states = noises(2, 100);
  for (PointCloud& state : states)
    for (std::size_t z = 2; z < 300; z += 3) state.fields[1].values[z] = 0;
  write_result(scratch / "flat", states);
  EXPECT_EQ(write({"flat"})["results"][0]["view"]["dimension"], 2);
  states[1].fields[1].values[299] = 1e-9;
  write_result(scratch / "lifted", states);
  EXPECT_EQ(write({"lifted"})["results"][0]["view"]["dimension"], 3);
  states = noises(1, 100);
  states[0].fields.pop_back();
  write_result(scratch / "still", states);
  EXPECT_EQ(write({"still"})["results"][0]["view"]["dimension"], 2);
  states[0].positions[5][2] = 1;
  write_result(scratch / "solid", states);
  EXPECT_EQ(write({"solid"})["results"][0]["view"]["dimension"], 3);
}

TEST_F(Page, LeavesOutStatesThatAreUnusableAndSaysWhy) {
  std::vector<PointCloud> states = noises(3, 100);
  write_result(scratch / "a", states);
  const auto expect_note = [&](const char* why) {
    const json result = write({"a"})["results"][0];
    EXPECT_EQ(result["view"]["states"].size(), 2U) << why;
    ASSERT_EQ(result["notes"].size(), 1U) << why;
    EXPECT_NE(result["notes"][0].get<std::string>().find(why), std::string::npos) << result["notes"][0];
  };
  EXPECT_EQ(write({"a"})["results"][0]["view"]["states"].size(), 3U);
  write_text(scratch / "a" / state_file(1), "<VTKFile");
  expect_note("1.vtu");
  states[1] = noise(99, 1);
  write_result(scratch / "a", states);
  expect_note("1.vtu: has other points");
  states[1] = noise(100, 1);
  states[1].fields[0].name = "harm";
  write_result(scratch / "a", states);
  expect_note("or fields");
  states[1].fields.push_back({"pair", 2, std::vector<double>(200)});
  write_result(scratch / "a", states);
  expect_note("has 2 components");
  std::filesystem::remove(scratch / "a" / state_file(1));
  expect_note("1.vtu: there is no such file");
}

TEST_F(Page, LongHistoriesAreThinnedToo) {
  write_result(scratch / "a", {});
  constexpr std::size_t kRows = 30000;
  HistoryWriter writer(scratch / "a" / "history.csv", Parameter::time, {{"force", "N"}, {"count", ""}});
  for (std::size_t row = 0; row < kRows; ++row)
    writer.add(static_cast<double>(row), std::array{std::sin(static_cast<double>(row)), 1.0 / 3});
  json result = write({"a"})["results"][0];
  EXPECT_EQ(result["histories"][0]["rows"], kRows);
  EXPECT_EQ(result["histories"][0]["columns"][0], (json{{"name", "time"}, {"unit", "s"}}));
  EXPECT_EQ(result["histories"][0]["columns"][1], (json{{"name", "force"}, {"unit", "N"}}));
  EXPECT_EQ(result["histories"][0]["columns"][2], (json{{"name", "count"}, {"unit", ""}}));
  result = write({"a"}, empty() + 3e5)["results"][0];
  const auto rows = result["histories"][0]["rows"].get<std::size_t>();
  EXPECT_LT(rows, kRows);
  EXPECT_EQ(result["histories"][0]["values"]["count"], 3 * rows);
  const std::string note = result["notes"][0];
  EXPECT_NE(note.find(" of 30 000 rows of history.csv are shown"), note.npos) << note;
}

TEST_F(Page, KnowsItsOwnPages) {
  write_result(scratch / "a", {});
  static_cast<void>(write({"a"}));
  EXPECT_TRUE(is_page(scratch / "page.html"));
  write_text(scratch / "other.html", "<html></html>");
  EXPECT_FALSE(is_page(scratch / "other.html"));
  EXPECT_FALSE(is_page(scratch / "none.html"));
  EXPECT_FALSE(is_page(scratch.path()));
}

TEST(JsonText, CannotEndTheElementThatHoldsIt) {
  const json text = {{"a<b", "</script><!--"}};
  EXPECT_EQ(json_text(text).find('<'), std::string::npos);
  EXPECT_EQ(json::parse(json_text(text)), text);
  EXPECT_EQ(json::parse(json_text("caf\xE9")), "caf\xEF\xBF\xBD");
}

}  // namespace
}  // namespace riven
