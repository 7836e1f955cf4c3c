#pragma once

#include <filesystem>
#include <string>

#include "output/summary.hpp"
#include "simulation/simulation.hpp"

namespace riven {

struct RunOptions {
  std::filesystem::path folder;
  bool force = false;          // replace an existing result
  bool resume = false;         // go on with it
  std::string resume_command;  // what the user is told to type after an interrupt
  std::string case_name;       // for summary.json
};

/// Runs a case into its result folder, or goes on with it, and returns what it wrote to `summary.json`. A run
/// that fails or is interrupted returns so in its status: the message has been shown and the last good state
/// is on disk. Throws InputError when the case can't be built or resumed; nothing is then changed on disk.
Summary run_case(const Case& input, const RunOptions& options);

}  // namespace riven
