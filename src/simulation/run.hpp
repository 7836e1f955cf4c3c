#pragma once

#include <filesystem>
#include <string>

#include "output/summary.hpp"
#include "simulation/simulation.hpp"

namespace riven {

struct RunOptions {
  std::filesystem::path folder;
  bool force = false;     // replace an existing result
  std::string case_name;  // for summary.json
};

/// Runs a case into its result folder and returns what it wrote to `summary.json`. A run that fails or is
/// interrupted returns so in its status: the message has been shown and the last good state is on disk.
/// Throws InputError when the case can't be built; nothing is then left on disk.
Summary run_case(const Case& input, const RunOptions& options);

}  // namespace riven
