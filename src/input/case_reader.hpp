#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "input/case.hpp"

namespace riven {

/// Reads and checks a case file. `overrides`: "path.to.key=value" as for --set; entries of arrays by their
/// number from 1, as in "load.1.displacement". Throws InputError for the first thing that is wrong.
Case read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same from text; `file` names it in messages.
Case parse_case(std::string_view text, const std::string& file,
                const std::vector<std::string>& overrides = {});

}  // namespace riven
