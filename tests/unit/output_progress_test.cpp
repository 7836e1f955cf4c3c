#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "base/error.hpp"
#include "output/log.hpp"
#include "output/progress.hpp"
#include "scratch.hpp"

namespace riven {
namespace {

using test::read_text;
using test::Scratch;

struct Screen {
  std::ostringstream out;
  double now = 100;
  int width = 0;

  Progress progress() {
    return Progress(
        out, [this] { return width; }, [this] { return now; });
  }
  [[nodiscard]] long lines() const {
    const std::string text = out.str();
    return std::count(text.begin(), text.end(), '\n');
  }
};

ProgressState example() {
  ProgressState state;
  state.value = 1.5;
  state.load_step = 3;
  state.load_steps = 8;
  state.fraction = 0.25;
  state.residual = 2.1e-4;
  state.iterations = 340;
  state.balance_error = 1e-6;
  return state;
}

TEST(Progress, TellsWhatTheSolverHas) {
  EXPECT_EQ(progress_text(example(), 12),
            "step 3/8, stretch 1.5, residual 2.1e-04, iteration 340, 0:12 elapsed, 0:36 left, energy balance "
            "1.0e-06");
  ProgressState dynamic;
  dynamic.parameter = Parameter::time;
  dynamic.value = 4.3e-5;
  dynamic.iterations = 12;
  EXPECT_EQ(progress_text(dynamic, 3723), "time 4.3e-05 s, iteration 12, 1:02:03 elapsed");
}

TEST(Progress, PlainLinesAreRateLimitedButKeepFinishedSteps) {
  Screen screen;
  Progress progress = screen.progress();
  for (int i = 0; i < 1000; ++i) {
    screen.now += 0.01;
    progress.update(example());
  }
  EXPECT_GE(screen.lines(), 5);
  EXPECT_LE(screen.lines(), 6);
  const long before = screen.lines();
  ProgressState done = example();
  done.step_done = true;
  progress.update(done);
  progress.update(done);
  EXPECT_EQ(screen.lines(), before + 2);
  EXPECT_EQ(screen.out.str().find_first_of("\r\x1b"), std::string::npos);
}

TEST(Progress, ATerminalLineIsRewrittenAndNeverWraps) {
  Screen screen;
  screen.width = 40;
  Progress progress = screen.progress();
  for (int i = 0; i < 5; ++i) {
    screen.now += 1;
    progress.update(example());
  }
  EXPECT_EQ(screen.lines(), 0);
  std::istringstream rewritten(screen.out.str());
  std::string line;
  std::getline(rewritten, line, '\r');
  EXPECT_EQ(line, "");
  int count = 0;
  while (std::getline(rewritten, line, '\r')) {
    ASSERT_TRUE(line.starts_with("\x1b[K"));
    EXPECT_EQ(line.size(), 3u + 39u);
    ++count;
  }
  EXPECT_EQ(count, 5);
  progress.finish();
  EXPECT_EQ(screen.lines(), 1);
}

TEST(Progress, FinishShowsWhatTheRateLimitHeldBack) {
  Screen screen;
  Progress progress = screen.progress();
  progress.update(example());
  ProgressState last = example();
  last.iterations = 341;
  progress.update(last);
  EXPECT_EQ(screen.out.str().find("341"), std::string::npos);
  progress.finish();
  EXPECT_NE(screen.out.str().find("341"), std::string::npos);
  const long lines = screen.lines();
  progress.finish();
  EXPECT_EQ(screen.lines(), lines);
}

TEST(Log, ScreenHasNoNoiseAndTheFileHasTimes) {
  const Scratch scratch;
  std::ostringstream screen;
  Log log(screen);
  log.open(scratch / "riven.log");
  log.detail("inner {} value");
  log.info("reading {}");
  log.warning("coarse");
  log.error("bad");
  EXPECT_EQ(screen.str(), "reading {}\nwarning: coarse\nerror: bad\n");
  std::istringstream file(read_text(scratch / "riven.log"));
  for (const char* expected : {"inner {} value", "reading {}", "coarse", "bad"}) {
    std::string line;
    std::getline(file, line);
    EXPECT_TRUE(line.ends_with(expected)) << line;
    EXPECT_EQ(line.find("20"), 0u) << line;
    EXPECT_EQ(line[10], ' ') << line;
  }
}

TEST(Log, MessagesDoNotGarbleTheProgressLine) {
  Screen screen;
  screen.width = 80;
  Progress progress = screen.progress();
  Log log(screen.out, [&] { progress.clear(); });
  progress.update(example());
  log.warning("look");
  EXPECT_TRUE(screen.out.str().ends_with("\r\x1b[Kwarning: look\n"));
  progress.update(example());  // comes back at once
  EXPECT_FALSE(screen.out.str().ends_with("look\n"));
}

TEST(Log, SaysWhatCannotBeWritten) {
  const Scratch scratch;
  test::write_text(scratch / "file", "");
  std::ostringstream screen;
  Log log(screen);
  EXPECT_THROW(log.open(scratch / "file/riven.log"), RunError);
}

}  // namespace
}  // namespace riven
