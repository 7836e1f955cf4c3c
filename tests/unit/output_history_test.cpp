#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "base/csv.hpp"
#include "base/error.hpp"
#include "output/history.hpp"
#include "scratch.hpp"

namespace riven {
namespace {

using test::message_of;
using test::read_text;
using test::Scratch;
using test::write_text;

TEST(History, HasTheParameterAndUnitsInItsFirstRow) {
  const Scratch scratch;
  HistoryWriter(scratch / "a.csv", Parameter::time, {{"reaction", "N"}, {"damage", ""}});
  EXPECT_EQ(read_text(scratch / "a.csv"), "time [s],reaction [N],damage\n");
  HistoryWriter(scratch / "b.csv", Parameter::stretch, {});
  EXPECT_EQ(read_text(scratch / "b.csv"), "stretch\n");
  HistoryWriter(scratch / "c.csv", Parameter::cycle, {});
  EXPECT_EQ(read_text(scratch / "c.csv"), "cycle\n");
}

TEST(History, RoundTripsEveryDouble) {
  const Scratch scratch;
  std::mt19937_64 random(7);
  std::vector<std::array<double, 2>> rows;
  HistoryWriter writer(scratch / "a.csv", Parameter::stretch, {{"reaction", "N"}, {"odd, \"name\" #", ""}});
  for (int i = 0; i < 500; ++i) {
    const auto value = [&] {
      return std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 600) - 300);
    };
    rows.push_back({value(), -value()});
    writer.add(i / 3.0, rows.back());
  }
  const History history = History::read(scratch / "a.csv");
  const auto reaction = history.column("reaction");
  const auto odd = history.column("odd, \"name\" #");
  ASSERT_EQ(reaction.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(reaction[i], rows[i][0]);
    EXPECT_EQ(odd[i], rows[i][1]);
    EXPECT_EQ(history.parameter()[i], static_cast<double>(i) / 3.0);
  }
  EXPECT_EQ(history.column("reaction [N]"), reaction);
}

TEST(History, EachRowIsOnDiskAtOnce) {
  const Scratch scratch;
  HistoryWriter writer(scratch / "a.csv", Parameter::stretch, {{"f", "N"}});
  for (std::size_t i = 1; i <= 3; ++i) {
    writer.add(1, std::array{2.5});
    EXPECT_EQ(History::read(scratch / "a.csv").column("f").size(), i);
  }
}

TEST(History, KeepsNaN) {
  const Scratch scratch;
  HistoryWriter writer(scratch / "a.csv", Parameter::stretch, {{"f", "N"}});
  writer.add(1, std::array{std::numeric_limits<double>::quiet_NaN()});
  EXPECT_TRUE(std::isnan(History::read(scratch / "a.csv").column("f")[0]));
}

TEST(History, DropsARowThatAKillLeftUnfinished) {
  const Scratch scratch;
  write_text(scratch / "a.csv", "stretch,f [N]\n1,2\n1.5,31");  // was to be 31.25
  EXPECT_EQ(History::read(scratch / "a.csv").column("f"), std::vector<double>{2});
}

TEST(History, RefusesRowsOfTheWrongLengthAndUnwritableFiles) {
  const Scratch scratch;
  HistoryWriter writer(scratch / "a.csv", Parameter::stretch, {{"f", "N"}});
  EXPECT_THROW(writer.add(1, std::array{1.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(HistoryWriter(scratch / "no/a.csv", Parameter::stretch, {}), RunError);
}

TEST(History, NamesTheColumnsThereAre) {
  const Scratch scratch;
  write_text(scratch / "a.csv", "stretch,force [N]\n1,2\n");
  const std::string message =
      message_of<InputError>([&] { return History::read(scratch / "a.csv").column("forc"); });
  EXPECT_NE(message.find("a.csv:1: expected a column \"forc\"; there are: stretch, force [N]"), message.npos)
      << message;
}

TEST(Csv, AcceptsWhatOtherProgramsWrite) {
  const Scratch scratch;
  write_text(scratch / "a.csv",
             "\xEF\xBB\xBF# made by hand\r\n"
             "name , x [m],\"a, \"\"b\"\"\"\r\n"
             "\r\n"
             "\"one, two\", +1.5e0 ,3\r\n"
             "# between\r\n"
             "#,-2,nan\r\n"
             ",4,5");
  const CsvTable table = CsvTable::read(scratch / "a.csv");
  EXPECT_EQ(table.columns(), (std::vector<std::string>{"name", "x [m]", "a, \"b\""}));
  ASSERT_EQ(table.rows(), 2u);  // "#,-2,nan" is a comment too
  EXPECT_EQ(table.line(0), 4);
  EXPECT_EQ(table.line(1), 7);
  EXPECT_EQ(table.numbers(table.column("x")), (std::vector<double>{1.5, 4}));
  EXPECT_EQ(table.number(1, table.column("a, \"b\"")), 5);
}

TEST(Csv, ErrorsNameFileAndLine) {
  const Scratch scratch;
  const auto refused = [&](const std::string& text) {
    write_text(scratch / "a.csv", text);
    return message_of<InputError>([&] { return CsvTable::read(scratch / "a.csv").numbers(0); });
  };
  EXPECT_NE(refused("a,b\n1,2\n3\n").find("a.csv:3: expected 2 cells"), std::string::npos);
  EXPECT_NE(refused("a\n\n1\n1.5x\n").find("a.csv:4: column \"a\": expected a number, found \"1.5x\""),
            std::string::npos);
  EXPECT_NE(refused("a,b\n,2\n").find("a.csv:2"), std::string::npos);
  EXPECT_NE(refused("a\n\"1\n").find("a.csv:2: expected a closing quote"), std::string::npos);
  EXPECT_NE(refused("a\n\"1\"2\n").find("a.csv:2: expected a comma"), std::string::npos);
  EXPECT_NE(refused("").find("found nothing"), std::string::npos);
  EXPECT_NE(refused("# only\n\n").find("found nothing"), std::string::npos);
  EXPECT_THROW(CsvTable::read(scratch / "no.csv"), InputError);
  EXPECT_THROW(CsvTable::read(scratch.path()), InputError);
}

TEST(Csv, ANameIsNoPrefix) {
  const Scratch scratch;
  write_text(scratch / "a.csv", "force x,force_y [N],force [N]\n1,2,3\n");
  EXPECT_EQ(CsvTable::read(scratch / "a.csv").column("force"), 2u);
}

}  // namespace
}  // namespace riven
