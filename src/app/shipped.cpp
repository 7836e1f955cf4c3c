#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "app/commands.hpp"
#include "base/error.hpp"
#include "base/nearest_name.hpp"
#include "input/case_reader.hpp"

namespace riven::app {

namespace fs = std::filesystem;

namespace {

/// All shipped case files, sorted.
std::vector<fs::path> shipped_files() {
  std::vector<fs::path> files;
  if (!fs::is_directory(cases_folder())) return files;
  for (const auto& entry : fs::recursive_directory_iterator(cases_folder()))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  // By name: "plain" comes before "plain-published", which "plain.toml" does not.
  std::sort(files.begin(), files.end(),
            [](fs::path a, fs::path b) { return a.replace_extension() < b.replace_extension(); });
  return files;
}

}  // namespace

bool is_shipped(const fs::path& file) {
  const fs::path relative =
      fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(cases_folder()));
  return !relative.empty() && *relative.begin() != "..";
}

fs::path cases_folder() {
  const char* home = std::getenv("RIVEN_HOME");
  return fs::path(home != nullptr ? home : RIVEN_SOURCE_DIR) / "cases";
}

fs::path find_case(const std::string& target) {
  if (fs::exists(target)) return target;
  fs::path shipped = cases_folder() / (target + ".toml");
  if (fs::exists(shipped)) return shipped;
  std::vector<std::string> names;
  for (const fs::path& file : shipped_files()) names.push_back(case_name(file));
  throw InputError(
      fmt::format("{}: no such file; expected a case file in TOML or the name of a shipped case (riven cases "
                  "lists them){}",
                  target, did_you_mean(target, names)));
}

std::string case_name(const fs::path& case_file) {
  if (is_shipped(case_file)) {
    fs::path relative =
        fs::weakly_canonical(case_file).lexically_relative(fs::weakly_canonical(cases_folder()));
    return relative.replace_extension().generic_string();
  }
  return case_file.stem().string();
}

fs::path default_output(const fs::path& case_file) {
  return fs::path("results") / case_name(case_file);
}

int cases() {
  std::string topic;
  std::size_t width = 0;
  for (const fs::path& file : shipped_files()) width = std::max(width, case_name(file).size());
  for (const fs::path& file : shipped_files()) {
    const std::string name = case_name(file);
    const std::string here = name.substr(0, name.find('/'));
    if (here != topic) fmt::print("{}{}\n", topic.empty() ? "" : "\n", here);
    topic = here;
    fmt::print("  {:<{}}  {}\n", name, width, read_case(file).title);
  }
  return kDone;
}

}  // namespace riven::app
