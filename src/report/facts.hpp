#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/result.hpp"

namespace riven {

/// "finished", "failed", "interrupted", or "unfinished": the run goes on, or was killed.
std::string_view status_of(const Result& result);

/// One line about a run, ready to show.
struct Fact {
  std::string label;
  std::string value;
};

/// Status, program, time, size, energies: what the result knows of them.
std::vector<Fact> facts_of(const Result& result);

}  // namespace riven
