#include "output/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "base/error.hpp"

namespace riven {

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path) {
  // The process id keeps two programs that write the same file out of each other's temporary.
  temporary_ = path.parent_path() / fmt::format(".{}.{}.tmp", path.filename().string(), ::getpid());
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_)
    throw RunError(fmt::format("cannot write {}: is its folder there and writable?", path_.string()));
}

AtomicFile::~AtomicFile() {
  if (temporary_.empty()) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::close() {
  stream_.close();
  if (!stream_) throw RunError(fmt::format("cannot write {}: is the disk full?", path_.string()));
}

void AtomicFile::commit_to_disk() {
  close();
  sync_to_disk(temporary_);
  commit();
  sync_to_disk(path_.parent_path() / ".");
}

void AtomicFile::commit() {
  if (stream_.is_open()) close();
  std::error_code problem;
  std::filesystem::rename(temporary_, path_, problem);
  if (problem) throw RunError(fmt::format("cannot write {}: {}", path_.string(), problem.message()));
  temporary_.clear();
}

void sync_to_disk(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool done = file >= 0 && ::fsync(file) == 0;
  if (file >= 0) ::close(file);
  if (!done)
    throw RunError(fmt::format("cannot bring {} to the disk: {}", path.string(), std::strerror(errno)));
}

}  // namespace riven
