#include <fmt/format.h>

#include <algorithm>

#include "app/commands.hpp"
#include "base/embedded.hpp"
#include "base/error.hpp"
#include "base/nearest_name.hpp"
#include "output/atomic_file.hpp"

namespace riven::app {

namespace fs = std::filesystem;

namespace {

/// The files of `src/app/starters`. KIND.toml is the case that `riven new --kind KIND` writes; its first line
/// is a comment that says what it is. KIND.NAME is a file that stands beside it, as NAME.
std::vector<EmbeddedFile> starter_files() {
  constexpr std::string_view kFolder = "src/app/starters/";
  std::vector<EmbeddedFile> files;
  for (const EmbeddedFile& file : embedded_files())
    if (file.path.starts_with(kFolder)) files.push_back({file.path.substr(kFolder.size()), file.text});
  return files;
}

struct Starter {
  std::string kind;
  std::string what;  // one line
};

std::vector<Starter> starters() {
  std::vector<Starter> all;
  for (const EmbeddedFile& file : starter_files())
    if (file.path.ends_with(".toml")) {
      const std::string_view line = file.text.substr(0, file.text.find('\n'));
      all.push_back({std::string(file.path.substr(0, file.path.size() - 5)), std::string(line.substr(2))});
    }
  std::sort(all.begin(), all.end(), [](const Starter& a, const Starter& b) { return a.kind < b.kind; });
  return all;
}

int print_list() {
  const std::vector<Starter> all = starters();
  std::size_t width = 0;
  for (const Starter& starter : all) width = std::max(width, starter.kind.size());
  for (const Starter& starter : all) fmt::print("{:<{}}  {}\n", starter.kind, width, starter.what);
  return kDone;
}

void check_kind(const std::string& kind) {
  std::vector<std::string> kinds;
  for (const Starter& starter : starters()) kinds.push_back(starter.kind);
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw InputError(fmt::format("--kind {}: unknown; expected one of {}{}", kind, listed(kinds),
                                 did_you_mean(kind, kinds)));
}

/// Where the case goes: "sheet" means sheet.toml.
fs::path case_file(const NewOptions& options) {
  if (options.file.empty()) return options.kind + ".toml";
  if (fs::is_directory(options.file))
    throw InputError(fmt::format("{}: is a folder; expected the name of a file to write, such as {}",
                                 options.file.string(), (options.file / (options.kind + ".toml")).string()));
  return options.file.extension() == ".toml" ? options.file : fs::path(options.file.string() + ".toml");
}

struct Target {
  fs::path path;
  std::string_view text;
};

std::vector<Target> targets(const NewOptions& options) {
  const fs::path file = case_file(options);
  std::vector<Target> all;
  for (const EmbeddedFile& starter : starter_files()) {
    if (starter.path == options.kind + ".toml") all.insert(all.begin(), {file, starter.text});
    const std::string beside = options.kind + ".";
    if (starter.path.starts_with(beside) && starter.path != options.kind + ".toml")
      all.push_back({file.parent_path() / starter.path.substr(beside.size()), starter.text});
  }
  return all;
}

/// Either all are written or none.
void check_free(const std::vector<Target>& all, bool force) {
  const fs::path folder = all.front().path.parent_path();
  if (!folder.empty() && !fs::is_directory(folder))
    throw InputError(fmt::format("{}: there is no folder {}; expected one that exists",
                                 all.front().path.string(), folder.string()));
  for (const Target& target : all) {
    if (!fs::exists(target.path)) continue;
    if (!force || !fs::is_regular_file(target.path))
      throw InputError(fmt::format("{}: exists already; expected a new name, or --force to replace it",
                                   target.path.string()));
  }
}

/// A word that a shell reads as one.
std::string quoted(const std::string& word) {
  return word.find_first_of(" '\"\\$&;()<>|*?`!#~") == std::string::npos ? word : fmt::format("'{}'", word);
}

}  // namespace

int new_case(const NewOptions& options) {
  if (options.list) return print_list();
  check_kind(options.kind);
  const std::vector<Target> all = targets(options);
  check_free(all, options.force);
  for (const Target& target : all) {
    AtomicFile file(target.path);
    file.stream() << target.text;
    file.commit();
    fmt::print("wrote {}\n", target.path.string());
  }
  const fs::path& file = all.front().path;
  const std::string name = quoted(file.string());
  fmt::print(
      "Read it, change it, then:\n"
      "  riven check {0}    what it means, with all defaults; memory and time\n"
      "  riven run {0}      results in {1}: open fields.pvd in ParaView\n",
      name, default_output(file).string());
  return kDone;
}

}  // namespace riven::app
