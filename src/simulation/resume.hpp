#pragma once

#include <map>
#include <optional>
#include <string>

#include "input/case.hpp"
#include "output/checkpoint.hpp"
#include "output/result_folder.hpp"

namespace riven {

/// What a run's result depends on, by key as for --set; of files that are read the contents, not the names.
std::map<std::string, std::string> decisive_values(const Case& input);

/// How a run goes on in a result folder: it is finished, or there is a checkpoint, or it has to start over.
struct Resumption {
  bool finished = false;
  std::optional<Checkpoint> checkpoint;
};

/// Throws InputError when the result was begun with another case, with the keys that differ, or when its
/// checkpoint cannot be read.
Resumption find_resumption(const Case& input, const ResultFolder& folder);

}  // namespace riven
