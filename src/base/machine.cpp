#include "base/machine.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <system_error>

namespace riven {
namespace {

namespace fs = std::filesystem;

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// The number behind `name` in a file of names and numbers.
std::optional<double> entry(const fs::path& file, const std::string& name) {
  std::ifstream in(file);
  std::string word;
  while (in >> word) {
    double value = 0;
    if (word == name && in >> value) return value;
  }
  return std::nullopt;
}

std::optional<double> number(const fs::path& file) {
  std::ifstream in(file);
  double value = 0;
  if (in >> value) return value;
  return std::nullopt;  // no such file, or "max"
}

/// What a control group and those above it leave of their limits (bytes). The cache of files in `used` is
/// given back when memory is short.
double left_of_group(const fs::path& top, const std::string& group, const char* limit_name,
                     const char* used_name) {
  double left = kEndless;
  for (fs::path at = fs::path(group).relative_path();; at = at.parent_path()) {
    const auto limit = number(top / at / limit_name);
    const auto used = number(top / at / used_name);
    if (limit && used)
      left = std::min(left, *limit - *used + entry(top / at / "memory.stat", "inactive_file").value_or(0));
    if (at.empty()) return left;
  }
}

double left_of_groups(const fs::path& root) {
  double left = kEndless;
  std::ifstream groups(root / "proc/self/cgroup");  // number:controllers:group, a line each
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1),
                      group = line.substr(second + 1);
    if (controllers.empty())
      left = std::min(left, left_of_group(root / "sys/fs/cgroup", group, "memory.max", "memory.current"));
    if (controllers == "memory")
      left = std::min(left, left_of_group(root / "sys/fs/cgroup/memory", group, "memory.limit_in_bytes",
                                          "memory.usage_in_bytes"));
  }
  return left;
}

}  // namespace

double available_memory(const fs::path& root) {
  const auto kilobytes = entry(root / "proc/meminfo", "MemAvailable:");
  return std::max(0.0, std::min(kilobytes ? 1024 * *kilobytes : kEndless, left_of_groups(root)));
}

double available_disk(const fs::path& path) {
  std::error_code problem;
  fs::path at = fs::absolute(path, problem);
  while (!fs::exists(at, problem) && at.has_relative_path()) at = at.parent_path();
  const fs::space_info space = fs::space(at, problem);
  return problem ? kEndless : static_cast<double>(space.available);
}

}  // namespace riven
