#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "input/case.hpp"
#include "verification/compare.hpp"
#include "verification/verdict.hpp"

namespace riven {

/// Holds the expectations of a case against its result folder. Throws InputError when an expectation names a
/// metric or state that the result has not, or has another unit.
std::vector<Verdict> judge(const Case& input, const std::vector<ExpectInput>& expects,
                           const std::filesystem::path& folder);

/// What a comparison with this case's results must know of its geometry.
CompareSettings compare_settings(const Case& input, double exclude_within);

/// A verdict as a row of a table under these headings.
inline constexpr std::array<std::string_view, 8> kVerdictColumns = {
    "metric", "at", "published", "reference", "ours", "deviation", "limit", ""};
using VerdictCells = std::array<std::string, kVerdictColumns.size()>;
VerdictCells cells(const Verdict& verdict);

/// The table published / reference / ours / deviation of one case, one line per metric and state.
std::string table(const std::vector<Verdict>& verdicts);

}  // namespace riven
