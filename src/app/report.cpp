#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/commands.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "input/case_reader.hpp"
#include "output/result_folder.hpp"
#include "simulation/verify.hpp"

namespace riven::app {

namespace fs = std::filesystem;

namespace {

/// Holds the case's expectations against the result. What a result cannot answer, one that failed before a
/// state for example, is only noted.
void add_verdicts(ReportItem& item) {
  const Case input = read_case(ResultFolder::open(item.result.folder).resolved());
  for (const ExpectInput& expect : input.expects) {
    try {
      const std::vector<Verdict> verdicts = judge(input, {expect}, item.result.folder);
      item.verdicts.insert(item.verdicts.end(), verdicts.begin(), verdicts.end());
    } catch (const InputError& problem) {
      item.notes.push_back(fmt::format("Not compared: {}.", problem.what()));
    }
  }
}

std::vector<ReportItem> read_items(const std::vector<fs::path>& folders) {
  std::vector<ReportItem> items;
  std::set<fs::path> seen;
  for (const fs::path& folder : folders) {
    items.push_back({.result = Result::open(folder)});
    if (!seen.insert(fs::canonical(folder / "")).second)
      throw InputError(fmt::format("{}: is named twice; expected each result once", folder.string()));
    add_verdicts(items.back());
  }
  return items;
}

void check_replaceable(const fs::path& file, bool force) {
  if (fs::is_directory(file))
    throw InputError(fmt::format("{}: is a folder, expected a file", file.string()));
  if (fs::exists(file) && !fs::is_regular_file(file))
    throw InputError(fmt::format("{}: is a device, expected a file", file.string()));
  const fs::path folder = fs::absolute(file).parent_path();
  if (!fs::is_directory(folder))
    throw InputError(
        fmt::format("{}: there is no folder {}; expected one that exists", file.string(), folder.string()));
  if (fs::exists(file) && !force && !is_page(file))
    throw InputError(fmt::format(
        "{}: exists already and is no report of Riven; expected a new name, or --force to replace it",
        file.string()));
}

/// Writes the page of these results to `file`, and what it left out.
void write_page_of(const std::vector<fs::path>& folders, const fs::path& file, bool force, std::FILE* tell) {
  std::vector<ReportItem> items = read_items(folders);
  check_replaceable(file, force);
  write_page(file, items);
  fmt::print(tell, "wrote {} ({})\n", file.string(), bytes_text(static_cast<double>(fs::file_size(file))));
  for (const ReportItem& item : items)
    for (const std::string& note : item.notes)
      fmt::print(tell, "  {}: {}\n", item.result.folder.string(), note);
}

}  // namespace

int report(const ReportOptions& options) {
  fs::path file = options.output;
  if (file.empty()) file = options.folders.size() == 1 ? options.folders.front() / kReportFile : kReportFile;
  write_page_of(options.folders, file, options.force, stdout);
  return kDone;
}

int report_after(const std::vector<fs::path>& results, const fs::path& folder) {
  return guarded([&] {
    write_page_of(results, folder / kReportFile, false, stderr);
    return kDone;
  });
}

}  // namespace riven::app
