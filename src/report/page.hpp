#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/result.hpp"
#include "verification/verdict.hpp"

namespace riven {

/// The report page: one HTML file that shows results, without a network. `web/` has its source.

/// A result as it goes into a page.
struct ReportItem {
  Result result;
  std::vector<Verdict> verdicts;
  std::vector<std::string> notes;  // sentences to show beside it
};

/// Its name, unless the user gives another.
inline constexpr const char* kReportFile = "report.html";

/// A page never takes more bytes: a browser should open it at once, and a mail carry it.
constexpr double kLargestPage = 30e6;

/// Writes the page of these results. What is left out to keep it below `largest` bytes is added to the notes
/// of `items`. Throws InputError when a file of a result is damaged or nothing fits, RunError when the page
/// cannot be written; an older file is then as it was.
void write_page(const std::filesystem::path& file, std::vector<ReportItem>& items,
                double largest = kLargestPage);

/// Whether a file is such a page.
bool is_page(const std::filesystem::path& file);

}  // namespace riven
