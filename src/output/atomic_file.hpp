#pragma once

#include <filesystem>
#include <fstream>

namespace riven {

/// A file that appears under its name only when it is complete: written to a hidden temporary beside it, then
/// renamed. A program killed at any moment leaves the old file or the new one, never half of one.
class AtomicFile {
 public:
  /// Throws RunError when the temporary cannot be created.
  explicit AtomicFile(const std::filesystem::path& path);
  /// Removes the temporary unless `commit` was called.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  [[nodiscard]] std::ofstream& stream() { return stream_; }

  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }

  /// Gives the file its name. Throws RunError when something could not be written (a full disk, say).
  void commit();
  /// The same, and the file survives a power cut from then on.
  void commit_to_disk();

 private:
  void close();

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::ofstream stream_;
};

/// Returns when a file or a folder is on the disk: it then survives a power cut. Throws RunError when the
/// disk refuses.
void sync_to_disk(const std::filesystem::path& path);

}  // namespace riven
