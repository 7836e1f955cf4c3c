#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/result.hpp"
#include "report/thinning.hpp"

namespace riven {

/// The size of the fields of a result, which has some, as measured on a few of its states. Throws InputError
/// that names the file when a field file is damaged.
ViewSize measured(const Result& result);

/// The fields of a result as a page holds them, in at most `budget` bytes; states are read one by one. What
/// is left out for that is said in `notes`. Throws InputError as above, or when nothing fits.
nlohmann::json view(const Result& result, const ViewSize& size, double budget,
                    std::vector<std::string>& notes);

}  // namespace riven
