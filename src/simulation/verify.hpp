#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "input/case.hpp"
#include "verification/compare.hpp"

namespace riven {

/// One expectation held against a result.
struct Verdict {
  std::string what;  // metric, or "displacement field"
  std::string unit;
  double at = 0;  // stretch, time (s) or cycle
  bool published = false;
  bool decides = true;             // a reference; published values are only reported
  std::optional<double> expected;  // none for a field
  std::optional<double> ours;      // the metric; none for a field
  std::optional<double>
      deviation;      // from the expected value, relative if that is not 0; of a field relative L2
  std::string limit;  // what was asked: "0.5 %", ">= 2"
  bool met = true;
  std::string source;
};

/// Holds the expectations of a case against its result folder. Throws InputError when an expectation names a
/// metric or state that the result has not, or has another unit.
std::vector<Verdict> judge(const Case& input, const std::vector<ExpectInput>& expects,
                           const std::filesystem::path& folder);

/// How a verdict reads in a table: "ok", "missed", or "reported" where it does not decide.
std::string_view outcome(const Verdict& verdict);

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
