#include <gtest/gtest.h>

#include "base/error.hpp"
#include "output/result_folder.hpp"
#include "scratch.hpp"

namespace riven {
namespace {

namespace fs = std::filesystem;
using test::message_of;
using test::read_text;
using test::Scratch;
using test::write_text;

TEST(ResultFolder, AppearsWholeWhenPublished) {
  const Scratch scratch;
  auto folder = ResultFolder::create(scratch / "results/topic/name", false);
  EXPECT_FALSE(fs::exists(scratch / "results"));
  write_text(folder.log(), "early");
  folder.publish("as written", "resolved");
  EXPECT_EQ(folder.path(), scratch / "results/topic/name");
  EXPECT_EQ(read_text(scratch / "results/topic/name/case.toml"), "as written");
  EXPECT_EQ(read_text(scratch / "results/topic/name/resolved.toml"), "resolved");
  EXPECT_EQ(read_text(scratch / "results/topic/name/riven.log"), "early");
  EXPECT_TRUE(fs::is_directory(scratch / "results/topic/name/fields"));
  EXPECT_EQ(scratch.entries(), 1);
  EXPECT_EQ(folder.summary().filename(), "summary.json");
  EXPECT_EQ(folder.history().filename(), "history.csv");
  EXPECT_EQ(folder.collection().filename(), "fields.pvd");
}

TEST(ResultFolder, StaysWhenTheRunEnds) {
  const Scratch scratch;
  { ResultFolder::create(scratch / "a", false).publish("c", "r"); }
  EXPECT_TRUE(fs::exists(scratch / "a/case.toml"));
}

TEST(ResultFolder, AFailureBeforeTheRunLeavesNothing) {
  const Scratch scratch;
  {
    const auto folder = ResultFolder::create(scratch / "results/a", false);
    write_text(folder.log(), "text");
    EXPECT_EQ(scratch.entries(), 1);
  }
  EXPECT_EQ(scratch.entries(), 0);
}

TEST(ResultFolder, FilesThatAreOpenSurviveThePublishing) {
  const Scratch scratch;
  auto folder = ResultFolder::create(scratch / "a", false);
  std::ofstream log(folder.log());
  log << "before " << std::flush;
  folder.publish("c", "r");
  log << "after" << std::flush;
  EXPECT_EQ(read_text(scratch / "a/riven.log"), "before after");
}

TEST(ResultFolder, AnExistingOneIsAnErrorWithoutForce) {
  const Scratch scratch;
  ResultFolder::create(scratch / "a", false).publish("old", "r");
  const std::string message = message_of<InputError>([&] { ResultFolder::create(scratch / "a", false); });
  EXPECT_NE(message.find("--force"), message.npos);
  fs::create_directory(scratch / "empty");
  EXPECT_THROW(ResultFolder::create(scratch / "empty", false), InputError);
  EXPECT_EQ(scratch.entries(), 2);
}

TEST(ResultFolder, ForceReplacesAResultOnlyWhenTheNewRunStarts) {
  const Scratch scratch;
  ResultFolder::create(scratch / "a", false).publish("old", "r");
  write_text(scratch / "a/fields/0007.vtu", "old field");
  { const auto dropped = ResultFolder::create(scratch / "a", true); }
  EXPECT_EQ(read_text(scratch / "a/case.toml"), "old");
  auto folder = ResultFolder::create(scratch / "a/", true);
  folder.publish("new", "r");
  EXPECT_EQ(read_text(scratch / "a/case.toml"), "new");
  EXPECT_FALSE(fs::exists(scratch / "a/fields/0007.vtu"));
  EXPECT_EQ(scratch.entries(), 1);
}

TEST(ResultFolder, ForceTakesAnEmptyFolder) {
  const Scratch scratch;
  fs::create_directory(scratch / "a");
  ResultFolder::create(scratch / "a", true).publish("c", "r");
  EXPECT_TRUE(fs::exists(scratch / "a/case.toml"));
}

TEST(ResultFolder, ForceNeverRemovesWhatRivenDidNotMake) {
  const Scratch scratch;
  fs::create_directory(scratch / "thesis");
  write_text(scratch / "thesis/chapter.tex", "years");
  write_text(scratch / "thesis/case.toml", "input of a run, no result");
  write_text(scratch / "file", "text");
  EXPECT_NE(
      message_of<InputError>([&] { ResultFolder::create(scratch / "thesis", true); }).find("not a result"),
      std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { ResultFolder::create(scratch / "file", true); }).find("a file"),
            std::string::npos);
  EXPECT_EQ(read_text(scratch / "thesis/chapter.tex"), "years");
  EXPECT_EQ(scratch.entries(), 2);
}

TEST(ResultFolder, ForceNeverRemovesTheFolderItRunsIn) {
  const Scratch scratch;
  ResultFolder::create(scratch / "a", false).publish("c", "r");
  fs::create_directory(scratch / "a/inside");
  const fs::path before = fs::current_path();
  for (const char* place : {"a", "a/inside"}) {
    fs::current_path(scratch / place);
    EXPECT_THROW(ResultFolder::create(scratch / "a", true), InputError) << place;
  }
  EXPECT_THROW(ResultFolder::create(".", true), InputError);
  fs::current_path(before);
  EXPECT_TRUE(fs::exists(scratch / "a/case.toml"));
}

TEST(ResultFolder, TheSecondOfTwoRunsIntoOneFolderIsRefused) {
  const Scratch scratch;
  auto folder = ResultFolder::create(scratch / "a", false);
  fs::create_directory(scratch / "a");
  write_text(scratch / "a/case.toml", "of another run");
  EXPECT_THROW(folder.publish("c", "r"), InputError);
  EXPECT_EQ(read_text(scratch / "a/case.toml"), "of another run");
}

TEST(ResultFolder, SaysWhyItCannotBeCreated) {
  const Scratch scratch;
  write_text(scratch / "file", "text");
  const std::string message =
      message_of<InputError>([&] { ResultFolder::create(scratch / "file/a", false); });
  EXPECT_NE(message.find("file/a"), message.npos);
}

TEST(ResultFolder, OpensOnlyResults) {
  const Scratch scratch;
  EXPECT_THROW(ResultFolder::open(scratch / "no"), InputError);
  EXPECT_THROW(ResultFolder::open(scratch.path()), InputError);
  ResultFolder::create(scratch / "a", false).publish("c", "r");
  { EXPECT_EQ(read_text(ResultFolder::open(scratch / "a").case_file()), "c"); }
  EXPECT_TRUE(fs::exists(scratch / "a"));
}

TEST(ResultFolder, NumbersFieldFiles) {
  EXPECT_EQ(ResultFolder::field(0), "fields/0000.vtu");
  EXPECT_EQ(ResultFolder::field(123), "fields/0123.vtu");
  EXPECT_EQ(ResultFolder::field(12345), "fields/12345.vtu");
}

}  // namespace
}  // namespace riven
