#include "output/checkpoint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/error.hpp"
#include "unit/scratch.hpp"

namespace riven {
namespace {

namespace fs = std::filesystem;
using test::message_of;
using test::read_text;
using test::Scratch;
using test::write_text;

Checkpoint sample() {
  Checkpoint checkpoint;
  checkpoint.case_values = {{"solver.method", "'verlet'"}, {"title", "caf\xc3\xa9 \"1\"\n"}};
  auto& arrays = checkpoint.state.arrays;
  arrays["state.u"] = std::vector<double>{0.1, -0.0, 1e-310, std::numeric_limits<double>::infinity()};
  arrays["state.steps"] = std::vector<std::int64_t>{-1, std::numeric_limits<std::int64_t>::max()};
  arrays["model.broken"] = Snapshot::Bytes{0, 255, 7};
  arrays["nothing"] = std::vector<double>{};
  std::vector<double> many(5000);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = std::sin(static_cast<double>(i));
  arrays["many"] = many;
  return checkpoint;
}

struct Members {
  double number = 0;
  long count = 0;
  bool flag = false;
  std::string text;
  std::vector<double> numbers;
  std::vector<int> counts;
  std::array<double, 3> point{};

  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    each("number", self.number);
    each("count", self.count);
    each("flag", self.flag);
    each("text", self.text);
    each("numbers", self.numbers);
    each("counts", self.counts);
    each("point", self.point);
  }
};

TEST(Snapshot, GivesMembersBack) {
  const Members from{0.1, -3, true, "word", {1, 2, 3}, {-4, 5}, {6, 7, 8}};
  Snapshot snapshot;
  Members::each_member(from, snapshot.saving());
  Members to;
  Members::each_member(to, snapshot.restoring());
  EXPECT_EQ(std::tie(to.number, to.count, to.flag, to.text, to.numbers, to.counts, to.point),
            std::tie(from.number, from.count, from.flag, from.text, from.numbers, from.counts, from.point));
}

TEST(Snapshot, RefusesWhatDoesNotFit) {
  Snapshot snapshot;
  snapshot.saving()("u", std::vector<double>{1, 2});
  EXPECT_THROW(snapshot.saving()("u", 1.0), std::logic_error);
  double number = 0;
  std::vector<double> three(3);
  std::vector<int> whole;
  EXPECT_NE(message_of<InputError>([&] { snapshot.restoring()("v", number); }).find("\"v\""),
            std::string::npos);
  EXPECT_THROW(snapshot.restoring()("u", number), InputError);
  EXPECT_THROW(snapshot.restoring()("u", three), InputError);
  EXPECT_THROW(snapshot.restoring()("u", whole), InputError);
}

TEST(CheckpointFile, GivesBackWhatWasWritten) {
  const Scratch scratch;
  const Checkpoint written = sample();
  write_checkpoint(scratch / "a.h5", written);
  EXPECT_EQ(scratch.entries(), 1) << "a temporary file was left";
  const Checkpoint read = read_checkpoint(scratch / "a.h5");
  EXPECT_EQ(read.version, this_program());
  EXPECT_EQ(read.case_values, written.case_values);
  EXPECT_EQ(read.state, written.state);
  const auto& u = std::get<std::vector<double>>(read.state.arrays.at("state.u"));
  EXPECT_TRUE(std::signbit(u[1]));
}

TEST(CheckpointFile, ReplacesAnOlderOneOnlyWhenComplete) {
  const Scratch scratch;
  write_checkpoint(scratch / "a.h5", sample());
  const std::string before = read_text(scratch / "a.h5");
  fs::create_directory(scratch / "folder");
  EXPECT_NE(message_of<RunError>([&] { write_checkpoint(scratch / "folder", sample()); }).find("folder"),
            std::string::npos);
  EXPECT_THROW(write_checkpoint(scratch / "no/a.h5", sample()), RunError);
  EXPECT_EQ(read_text(scratch / "a.h5"), before);
  Checkpoint other = sample();
  other.state.arrays["more"] = std::vector<double>{1};
  write_checkpoint(scratch / "a.h5", other);
  EXPECT_EQ(read_checkpoint(scratch / "a.h5").state, other.state);
}

TEST(CheckpointFile, RefusesAFlipOfAnyByte) {
  const Scratch scratch;
  write_checkpoint(scratch / "a.h5", sample());
  const std::string whole = read_text(scratch / "a.h5");
  std::mt19937 random(7);
  std::vector<std::size_t> places(600);
  // Every byte of the header's text and many of the rest: also bytes that HDF5 itself does not look at.
  for (std::size_t n = 0; n < places.size(); ++n)
    places[n] = n < 100 ? n : std::uniform_int_distribution<std::size_t>(0, whole.size() - 1)(random);
  for (const std::size_t place : places) {
    std::string damaged = whole;
    damaged[place] =
        static_cast<char>(damaged[place] ^ (1 << std::uniform_int_distribution<int>(0, 7)(random)));
    write_text(scratch / "b.h5", damaged);
    const std::string said = message_of<InputError>([&] { read_checkpoint(scratch / "b.h5"); });
    EXPECT_TRUE(said.find("b.h5") != std::string::npos) << place << ": " << said;
  }
}

TEST(CheckpointFile, RefusesAFileThatIsCutShortOrTooLong) {
  const Scratch scratch;
  write_checkpoint(scratch / "a.h5", sample());
  const std::string whole = read_text(scratch / "a.h5");
  for (const std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{17}, std::size_t{300},
                                 std::size_t{512}, std::size_t{4000}, whole.size() / 2, whole.size() - 1}) {
    write_text(scratch / "b.h5", whole.substr(0, size));
    EXPECT_THROW(read_checkpoint(scratch / "b.h5"), InputError) << size;
  }
  write_text(scratch / "b.h5", whole + "x");
  EXPECT_NE(message_of<InputError>([&] { read_checkpoint(scratch / "b.h5"); }).find("damaged"),
            std::string::npos);
}

TEST(CheckpointFile, RefusesForeignFilesAndOtherFormats) {
  const Scratch scratch;
  write_text(scratch / "text", "stretch,force\n1,2\n");
  EXPECT_NE(message_of<InputError>([&] { read_checkpoint(scratch / "text"); }).find("no checkpoint"),
            std::string::npos);
  EXPECT_THROW(read_checkpoint(scratch / "missing"), InputError);
  write_checkpoint(scratch / "a.h5", sample());
  std::string newer = read_text(scratch / "a.h5");
  newer.replace(newer.find("format 2"), 8, "format 3");
  write_text(scratch / "a.h5", newer);
  const std::string said = message_of<InputError>([&] { read_checkpoint(scratch / "a.h5"); });
  EXPECT_NE(said.find("has format \"3\""), std::string::npos) << said;
  EXPECT_NE(said.find("reads format 2"), std::string::npos) << said;
}

}  // namespace
}  // namespace riven
