#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace riven::app {

/// A run of this program beside this one. It ends, with a checkpoint, when this program does.
class ChildRun {
 public:
  /// `words`: what stands behind "riven" on the command line. What the run says goes to `log`. Throws
  /// RunError when it cannot be started.
  ChildRun(const std::vector<std::string>& words, const std::filesystem::path& log);

  /// Its exit code, once it has ended; 128 + the signal that killed it.
  [[nodiscard]] std::optional<int> ended() const;
  /// Asks it to stop, once: a second signal would end it without a checkpoint.
  void interrupt();
  [[nodiscard]] double seconds() const;

 private:
  int process_ = 0;
  bool asked_to_stop_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace riven::app
