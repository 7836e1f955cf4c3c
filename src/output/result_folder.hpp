#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace riven {

/// Folders that `--force` replaces: others may hold what Riven did not write.
struct FolderKind {
  std::string_view what;   // "a result of Riven"
  std::string_view marks;  // the files that tell
  bool (*is)(const std::filesystem::path& folder);
};

/// Throws InputError when `folder` exists and is not to be replaced, or not of this kind, or in use.
void check_free(const std::filesystem::path& folder, bool force, const FolderKind& kind);

/// Descriptor of a folder that other runs respect as long as it is open. Throws InputError when another one
/// holds it.
int lock_folder(const std::filesystem::path& folder);

/// The folder of a run. It is prepared as a hidden folder beside its place and takes its name by `publish`,
/// when the run is about to start: whatever fails before leaves nothing behind, and an older result
/// untouched.
class ResultFolder {
 public:
  /// Prepares the folder `path`. Throws InputError when it exists and `force` is not given, when `force`
  /// would remove something that is not a result of Riven (a folder with `case.toml` and `resolved.toml`, or
  /// an empty one) or to which a run writes, or when it cannot be created.
  static ResultFolder create(const std::filesystem::path& path, bool force);

  /// An existing result. Throws InputError when there is none at `path`, with the name of one near.
  static ResultFolder open(const std::filesystem::path& path);

  /// The same, to write to it. Throws InputError when another run does.
  static ResultFolder go_on(const std::filesystem::path& path);

  /// Removes the prepared folder if it was not published. Lets others write to it.
  ~ResultFolder();
  ResultFolder(ResultFolder&& other) noexcept;
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  /// Writes `case.toml` (as the user wrote it) and `resolved.toml`, and gives the folder its name; an older
  /// result is removed only now. Files that are open in it stay open; paths taken before no longer hold.
  /// Throws RunError when the folder cannot be written, InputError when another run took the name meanwhile.
  void publish(const std::string& case_text, const std::string& resolved_text);

  /// Where the folder is now: hidden before `publish`, `path` after it.
  [[nodiscard]] const std::filesystem::path& path() const { return current_; }
  /// Where it is to be, or is; of a new one absolute and without links.
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }
  [[nodiscard]] std::filesystem::path case_file() const { return current_ / "case.toml"; }
  [[nodiscard]] std::filesystem::path resolved() const { return current_ / "resolved.toml"; }
  [[nodiscard]] std::filesystem::path log() const { return current_ / "riven.log"; }
  [[nodiscard]] std::filesystem::path summary() const { return current_ / "summary.json"; }
  [[nodiscard]] std::filesystem::path history() const { return current_ / "history.csv"; }
  [[nodiscard]] std::filesystem::path energy() const { return current_ / "energy.csv"; }
  [[nodiscard]] std::filesystem::path collection() const { return current_ / "fields.pvd"; }
  [[nodiscard]] std::filesystem::path checkpoint() const { return current_ / "checkpoint.h5"; }
  /// Removes what a killed run left half written, and the field files from output state `states` on.
  void cut_off(int states) const;
  /// Field file of an output state, counted from 0, relative to the folder: "fields/0000.vtu".
  [[nodiscard]] static std::filesystem::path field(int state);

 private:
  ResultFolder() = default;

  std::filesystem::path target_;  // absolute
  std::filesystem::path current_;
  bool force_ = false;
  bool published_ = false;
  int lock_ = -1;  // descriptor of the folder that keeps other runs out
};

}  // namespace riven
