#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "input/case_reader.hpp"
#include "scratch.hpp"
#include "simulation/estimate.hpp"
#include "simulation/preflight.hpp"

namespace riven {
namespace {

namespace fs = std::filesystem;

constexpr int kMutations = 400;
constexpr double kLarge = 60e6;  // bytes: larger bodies take time and show nothing more

std::vector<fs::path> shipped_cases() {
  std::vector<fs::path> files;
  for (const char* folder : {"cases", "src/app/starters"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(RIVEN_ROOT) / folder))
      if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// Flips bits, takes pieces out, doubles lines, or exchanges digits: most of the results are still nearly
/// cases.
std::string mutated(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  for (std::size_t count = 1 + below(3); count > 0 && text.size() > 1; --count) {
    const std::size_t at = below(text.size());
    switch (below(4)) {
      case 0:
        text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 1:
        text.erase(at, 1 + below(20));
        break;
      case 2: {
        const std::size_t begin = text.rfind('\n', at) + 1,
                          end = std::min(text.find('\n', at), text.size() - 1);
        if (end >= begin) text.insert(begin, text.substr(begin, end + 1 - begin));
        break;
      }
      default:
        if (const std::size_t digit = text.find_first_of("0123456789", at); digit != std::string::npos)
          text[digit] = "0123456789-.e\""[below(14)];
    }
  }
  return text;
}

/// What `riven check` does. Returns whether the case is right.
bool is_right(const std::string& text, const fs::path& file) {
  try {
    const Case input = parse_case(text, file.string());
    if (memory_estimate(input) > kLarge) return true;
    const Simulation simulation = build_simulation(input);
    check_before_run(simulation, Probes(simulation));
    static_cast<void>(warnings(simulation));
    return true;
  } catch (const InputError& error) {
    EXPECT_STRNE(error.what(), "");
    return false;
  }
}

TEST(MutatedCase, IsRightOrWrongInputAndNothingElse) {
  std::mt19937 random(20240607);
  const std::vector<fs::path> files = shipped_cases();
  ASSERT_GE(files.size(), 15U);
  int right = 0;
  for (int n = 0; n < kMutations; ++n) {
    const fs::path& file = files[static_cast<std::size_t>(n) % files.size()];
    std::string text = test::read_text(file);
    for (const char* fine : {"[100, 100]", "[160, 80]", "[80, 40]"})
      if (const std::size_t at = text.find(fine); at != std::string::npos)
        text.replace(at, std::string(fine).size(), "[10, 10]");
    text = mutated(text, random);
    SCOPED_TRACE(file.string() + ", mutation " + std::to_string(n));
    try {
      right += is_right(text, file) ? 1 : 0;
    } catch (const std::exception& other) {
      ADD_FAILURE() << other.what() << "\n" << text;
    }
  }
  // Both happen often, or the test would show little.
  EXPECT_GT(right, kMutations / 20);
  EXPECT_LT(right, kMutations * 19 / 20);
}

}  // namespace
}  // namespace riven
