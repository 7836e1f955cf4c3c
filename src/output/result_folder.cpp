#include "output/result_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>
#include <utility>

#include "base/error.hpp"
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

void check_free(const fs::path& folder, bool force) {
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
  if (!fs::is_empty(folder) && !is_result(folder)) {
    throw InputError(
        fmt::format("{}: is not a result of Riven (it has no case.toml and resolved.toml); --force does not "
                    "remove it, name another folder",
                    name));
  }
}

/// A hidden place for `target` in the nearest folder that exists, so that a failure leaves no parents behind
/// and the move into place is a rename within one disk.
fs::path hidden_beside(const fs::path& target, const char* purpose) {
  fs::path parent = target.parent_path();
  while (!fs::exists(parent)) parent = parent.parent_path();
  return parent / fmt::format(".{}.{}.{}", target.filename().string(), purpose, ::getpid());
}

void write_text(const fs::path& path, const std::string& text) {
  AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

void move_folder(const fs::path& from, const fs::path& to) {
  std::error_code problem;
  fs::rename(from, to, problem);
  if (problem)
    throw RunError(fmt::format("cannot create the result folder {}: {}", to.string(), problem.message()));
}

}  // namespace

ResultFolder ResultFolder::create(const fs::path& path, bool force) {
  ResultFolder folder;
  try {
    folder.target_ = fs::weakly_canonical(fs::absolute(path / ""));
    if (!folder.target_.has_filename()) folder.target_ = folder.target_.parent_path();
    folder.force_ = force;
    check_free(folder.target_, force);
    folder.current_ = hidden_beside(folder.target_, "new");
    fs::remove_all(folder.current_);  // of a killed run whose process id came round again
    fs::create_directories(folder.current_ / "fields");
  } catch (const fs::filesystem_error& error) {
    throw InputError(
        fmt::format("{}: cannot create a result folder there: {}", path.string(), error.code().message()));
  }
  return folder;
}

ResultFolder ResultFolder::open(const fs::path& path) {
  if (!fs::is_directory(path))
    throw InputError(fmt::format("{}: expected a result folder, there is none", path.string()));
  if (!is_result(path)) {
    throw InputError(
        fmt::format("{}: is not a result of Riven: it has no case.toml and resolved.toml", path.string()));
  }
  ResultFolder folder;
  folder.target_ = folder.current_ = path;
  folder.published_ = true;
  return folder;
}

ResultFolder::ResultFolder(ResultFolder&& other) noexcept
    : target_(std::move(other.target_)),
      current_(std::exchange(other.current_, {})),
      force_(other.force_),
      published_(std::exchange(other.published_, true)) {}

ResultFolder::~ResultFolder() {
  if (published_ || current_.empty()) return;
  std::error_code ignored;
  fs::remove_all(current_, ignored);
}

void ResultFolder::publish(const std::string& case_text, const std::string& resolved_text) {
  write_text(case_file(), case_text);
  write_text(resolved(), resolved_text);
  check_free(target_, force_);
  std::error_code problem;
  fs::create_directories(target_.parent_path(), problem);  // what failed here shows in the rename
  const fs::path old = hidden_beside(target_, "old");
  const bool replaces = fs::exists(target_);
  if (replaces) move_folder(target_, old);
  try {
    move_folder(current_, target_);
  } catch (const RunError&) {
    if (replaces) fs::rename(old, target_, problem);
    throw;
  }
  current_ = target_;
  published_ = true;
  if (replaces) fs::remove_all(old, problem);
}

fs::path ResultFolder::field(int state) {
  return fs::path("fields") / fmt::format("{:04}.vtu", state);
}

}  // namespace riven
