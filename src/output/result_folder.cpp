#include "output/result_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>
#include <utility>

#include "base/error.hpp"
#include "base/nearest_name.hpp"
#include "output/atomic_file.hpp"

namespace riven {
namespace {

namespace fs = std::filesystem;

bool is_result(const fs::path& folder) {
  return fs::exists(folder / "case.toml") && fs::exists(folder / "resolved.toml");
}

/// Whether `folder` is where the program runs or holds it: never a folder to remove.
bool holds_working_folder(const fs::path& folder) {
  const fs::path here = fs::weakly_canonical(fs::current_path());
  const auto [mismatch, rest] = std::mismatch(folder.begin(), folder.end(), here.begin(), here.end());
  return mismatch == folder.end();
}

}  // namespace

int lock_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  // Where the file system knows no locks there are none.
  if (descriptor < 0 || ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK)
    return descriptor;
  ::close(descriptor);
  throw InputError(fmt::format("{}: a run writes there; wait for its end, or stop it", folder.string()));
}

void check_free(const fs::path& folder, bool force, const FolderKind& kind) {
  if (!fs::exists(folder)) return;
  const std::string name = folder.string();
  if (!force)
    throw InputError(
        fmt::format("{}: exists already; expected a new folder, or --force to replace it", name));
  if (!fs::is_directory(folder)) throw InputError(fmt::format("{}: is a file, expected a folder", name));
  if (holds_working_folder(folder)) {
    throw InputError(
        fmt::format("{}: is where Riven runs; --force does not remove it, name another folder", name));
  }
  if (!fs::is_empty(folder) && !kind.is(folder)) {
    throw InputError(
        fmt::format("{}: is not {} (it has no {}); --force does not remove it, name another folder", name,
                    kind.what, kind.marks));
  }
  if (const int descriptor = lock_folder(folder); descriptor >= 0) ::close(descriptor);
}

namespace {

const FolderKind kResult{"a result of Riven", "case.toml and resolved.toml", is_result};

/// A hidden place for `target` in the nearest folder that exists, so that a failure leaves no parents behind
/// and the move into place is a rename within one disk.
fs::path hidden_beside(const fs::path& target, const std::string& number) {
  fs::path parent = target.parent_path();
  while (!fs::exists(parent)) parent = parent.parent_path();
  return parent / fmt::format(".{}.new.{}", target.filename().string(), number);
}

/// Removes the hidden folders of runs that were killed while they prepared them.
void remove_leftovers(const fs::path& target) {
  const fs::path pattern = hidden_beside(target, "");
  for (const auto& entry : fs::directory_iterator(pattern.parent_path())) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(pattern.filename().string())) continue;
    const int process = std::atoi(name.c_str() + pattern.filename().string().size());
    std::error_code ignored;
    if (process > 0 && ::kill(process, 0) != 0 && errno == ESRCH) fs::remove_all(entry.path(), ignored);
  }
}

void write_text(const fs::path& path, const std::string& text) {
  AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

/// Moves a folder into place. One that is there already takes its place, in the same moment where the file
/// system can do so.
void move_folder(const fs::path& from, const fs::path& to) {
  std::error_code problem;
  if (fs::exists(to)) {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) return;
    if (errno == EINVAL || errno == ENOSYS) fs::remove_all(to, problem);
  }
  fs::rename(from, to, problem);
  if (problem)
    throw RunError(fmt::format("cannot create the result folder {}: {}", to.string(), problem.message()));
}

/// The result beside `path` that a typist most likely meant.
std::string result_near(const fs::path& path) {
  const fs::path parent = fs::absolute(path / "").parent_path().parent_path();
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(parent, none))
    if (is_result(entry.path())) names.push_back(entry.path().filename().string());
  return did_you_mean((path / "").parent_path().filename().string(), names);
}

}  // namespace

ResultFolder ResultFolder::create(const fs::path& path, bool force) {
  ResultFolder folder;
  try {
    folder.target_ = fs::weakly_canonical(fs::absolute(path / ""));
    if (!folder.target_.has_filename()) folder.target_ = folder.target_.parent_path();
    folder.force_ = force;
    check_free(folder.target_, force, kResult);
    remove_leftovers(folder.target_);
    folder.current_ = hidden_beside(folder.target_, std::to_string(::getpid()));
    fs::remove_all(folder.current_);  // of a killed run whose process id came round again
    fs::create_directories(folder.current_ / "fields");
    folder.lock_ = lock_folder(folder.current_);
  } catch (const fs::filesystem_error& error) {
    throw InputError(
        fmt::format("{}: cannot create a result folder there: {}", path.string(), error.code().message()));
  }
  return folder;
}

ResultFolder ResultFolder::open(const fs::path& path) {
  if (!fs::is_directory(path))
    throw InputError(
        fmt::format("{}: expected a result folder, there is none{}", path.string(), result_near(path)));
  if (!is_result(path)) {
    throw InputError(fmt::format("{}: is not a result of Riven: it has no case.toml and resolved.toml{}",
                                 path.string(), result_near(path)));
  }
  ResultFolder folder;
  folder.target_ = folder.current_ = path;
  folder.published_ = true;
  return folder;
}

ResultFolder ResultFolder::go_on(const fs::path& path) {
  ResultFolder folder = open(path);
  folder.lock_ = lock_folder(folder.current_);
  return folder;
}

ResultFolder::ResultFolder(ResultFolder&& other) noexcept
    : target_(std::move(other.target_)),
      current_(std::exchange(other.current_, {})),
      force_(other.force_),
      published_(std::exchange(other.published_, true)),
      lock_(std::exchange(other.lock_, -1)) {}

ResultFolder::~ResultFolder() {
  if (lock_ >= 0) ::close(lock_);
  if (published_ || current_.empty()) return;
  std::error_code ignored;
  fs::remove_all(current_, ignored);
}

void ResultFolder::publish(const std::string& case_text, const std::string& resolved_text) {
  write_text(case_file(), case_text);
  write_text(resolved(), resolved_text);
  check_free(target_, force_, kResult);
  std::error_code problem;
  fs::create_directories(target_.parent_path(), problem);  // what failed here shows in the rename
  move_folder(current_, target_);
  fs::remove_all(current_, problem);  // an older result
  current_ = target_;
  published_ = true;
}

void ResultFolder::cut_off(int states) const {
  const auto clean = [](const fs::path& folder, const auto& unwanted) {
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".tmp" || unwanted(entry.path())) fs::remove(entry.path());
  };
  clean(current_, [](const fs::path&) { return false; });
  clean(current_ / "fields", [&](const fs::path& file) {
    return file.extension() == ".vtu" && std::atoi(file.stem().c_str()) >= states;
  });
}

fs::path ResultFolder::field(int state) {
  return fs::path("fields") / fmt::format("{:04}.vtu", state);
}

}  // namespace riven
