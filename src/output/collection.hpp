#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace riven {

/// One state of a series: the stretch, time (s) or cycle and its field file.
struct CollectionEntry {
  double value = 0;
  std::filesystem::path file;
};

/// The series of field files of a run (`fields.pvd`), which ParaView opens as one. The whole file is replaced
/// after each state, so it is readable at any moment.
class Collection {
 public:
  explicit Collection(std::filesystem::path path) : path_(std::move(path)) {}

  /// Adds a state; `file` is relative to the collection's folder. Throws RunError when it cannot be written.
  void add(double value, const std::filesystem::path& file);
  /// Starts with these states, instead of those that the file has.
  void replace(std::vector<CollectionEntry> entries);

 private:
  void write() const;

  std::filesystem::path path_;
  std::vector<CollectionEntry> entries_;
};

/// The states of a series in the order of the file; paths lead from where the program runs.
/// Throws InputError when the file is missing or damaged.
std::vector<CollectionEntry> read_collection(const std::filesystem::path& path);

}  // namespace riven
