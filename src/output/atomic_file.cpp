#include "output/atomic_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

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

void AtomicFile::commit() {
  stream_.close();
  if (!stream_) throw RunError(fmt::format("cannot write {}: is the disk full?", path_.string()));
  std::error_code problem;
  std::filesystem::rename(temporary_, path_, problem);
  if (problem) throw RunError(fmt::format("cannot write {}: {}", path_.string(), problem.message()));
  temporary_.clear();
}

}  // namespace riven
