#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "output/summary.hpp"
#include "simulation/verify.hpp"

namespace riven::app {

/// What verifying a case gave.
struct Verification {
  std::string name;   // "topic/name"
  std::string title;  // of the case; empty when it could not be read
  std::filesystem::path folder;
  bool brief = false;  // its short variant
  std::vector<Verdict> verdicts;
  std::size_t unreached = 0;       // expectations at states that the run does not reach
  std::optional<Summary> summary;  // none: nothing was run
  std::string problem;             // why there is nothing to compare
  int code = 0;
};

/// One HTML file that shows them all: pictures, tables, a section per topic. `conclusion` is the line that
/// sums them up. Throws RunError when it cannot be written.
void write_gallery(const std::filesystem::path& file, const std::vector<Verification>& all,
                   const std::string& conclusion);

}  // namespace riven::app
