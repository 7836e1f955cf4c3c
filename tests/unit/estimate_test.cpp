#include "simulation/estimate.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/text.hpp"
#include "input/case_reader.hpp"
#include "input_cases.hpp"
#include "scratch.hpp"

namespace riven {
namespace {

using test::Scratch;

void write(const Scratch& root, const std::string& file, const std::string& text) {
  std::filesystem::create_directories((root / file).parent_path());
  test::write_text(root / file, text);
}

TEST(Machine, MemoryIsWhatTheKernelCallsAvailable) {
  const Scratch root;
  EXPECT_EQ(available_memory(root.path()), std::numeric_limits<double>::infinity());
  write(root, "proc/meminfo", "MemTotal:  8000 kB\nMemFree:  1000 kB\nMemAvailable:  3000 kB\n");
  EXPECT_EQ(available_memory(root.path()), 3000 * 1024.0);
  EXPECT_GT(available_memory(), 1e6);
}

TEST(Machine, MemoryIsWhatAControlGroupLeavesOfItsLimit) {
  const Scratch root;
  write(root, "proc/meminfo", "MemAvailable:  1000000 kB\n");
  write(root, "proc/self/cgroup", "0::/outer/inner\n");
  write(root, "sys/fs/cgroup/outer/inner/memory.max", "max\n");
  write(root, "sys/fs/cgroup/outer/inner/memory.current", "100\n");
  EXPECT_EQ(available_memory(root.path()), 1024e6);
  write(root, "sys/fs/cgroup/outer/memory.max", "500000\n");
  write(root, "sys/fs/cgroup/outer/memory.current", "300000\n");
  EXPECT_EQ(available_memory(root.path()), 200000);
  write(root, "sys/fs/cgroup/outer/memory.stat", "anon 5\ninactive_file 50000\n");  // cache is given back
  EXPECT_EQ(available_memory(root.path()), 250000);
  // The older kind.
  write(root, "proc/self/cgroup", "5:cpu:/\n4:memory:/box\n");
  write(root, "sys/fs/cgroup/memory/box/memory.limit_in_bytes", "70000\n");
  write(root, "sys/fs/cgroup/memory/box/memory.usage_in_bytes", "90000\n");
  EXPECT_EQ(available_memory(root.path()), 0);
}

TEST(Machine, DiskIsThatOfTheNearestFolderThereIs) {
  const Scratch root;
  EXPECT_GT(available_disk(root / "not/there/yet"), 0);
  EXPECT_EQ(available_disk(root / "not/there/yet"), available_disk(root.path()));
}

TEST(Estimate, NamesASpacingThatFits) {
  const Case input = parse_case(static_case, "case.toml");  // 100 x 100 points, spacing 5 mm
  const double need = memory_estimate(input);
  EXPECT_NO_THROW(check_memory(input, need));
  const std::string said = test::message_of<InputError>([&] { check_memory(input, 0.99 * need); });
  EXPECT_NE(said.find("case.toml:3:1: geometry: 1e+04 points need about "), std::string::npos) << said;
  EXPECT_NE(said.find("expected a larger spacing, 0.0052 m at least"), std::string::npos) << said;
  // What is named does fit, and hardly more than that.
  Case coarse = input;
  coarse.geometry.spacing *= 1.04;
  coarse.geometry.horizon *= 1.04;
  EXPECT_NO_THROW(check_memory(coarse, 0.99 * need));
}

TEST(Estimate, DiskGrowsWithStatesPointsAndFields) {
  const Simulation simulation = build_simulation(parse_case(static_case, "case.toml"));
  const double need = output_estimate(simulation);
  // Positions, displacement and damage: 7 numbers of 8 bytes, in base64, at 4 states; and some history.
  const auto points = static_cast<double>(simulation.model->points());
  EXPECT_NEAR(need, 4 * points * 7 * 8 * 4 / 3, 0.01 * need);
  EXPECT_NO_THROW(check_disk(simulation, need));
  const std::string said = test::message_of<InputError>([&] { check_disk(simulation, 0.5 * need); });
  EXPECT_NE(said.find("case.toml:30:1: output: 4 states of "), std::string::npos) << said;
}

TEST(Estimate, SaysDurationsInWordsOfTheirSize) {
  for (const auto& [seconds, words] : std::vector<std::pair<double, std::string>>{{0.04, "0.04 s"},
                                                                                  {2.34, "2.3 s"},
                                                                                  {85, "85 s"},
                                                                                  {600, "10 min"},
                                                                                  {7200, "2.0 h"},
                                                                                  {1e6, "12 days"},
                                                                                  {1e12, "3.2e+04 years"}})
    EXPECT_EQ(duration_text(seconds), words);
  EXPECT_EQ(bytes_text(119934), "120 kB");
  EXPECT_EQ(bytes_text(17.2e6), "18 MB");
  EXPECT_EQ(bytes_text(1.234e10), "12.3 GB");
  EXPECT_EQ(count_text(1, "thread"), "1 thread");
  EXPECT_EQ(count_text(16, "thread"), "16 threads");
  for (const auto& [number, text] :
       std::vector<std::pair<std::int64_t, std::string>>{{0, "0"},
                                                         {999, "999"},
                                                         {-999, "-999"},
                                                         {1000, "1 000"},
                                                         {64000, "64 000"},
                                                         {-1234567, "-1 234 567"}})
    EXPECT_EQ(grouped(number), text);
}

}  // namespace
}  // namespace riven
