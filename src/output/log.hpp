#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <ostream>
#include <string>

namespace spdlog {
class logger;
}

namespace riven {

/// What a run says: to the screen without noise, and to `riven.log` with time and level.
class Log {
 public:
  /// `before_message` runs before each message on the screen: where a progress line gives way.
  explicit Log(std::ostream& screen, std::function<void()> before_message = {});

  /// From now on messages go to this file too. Throws RunError when it cannot be created.
  void open(const std::filesystem::path& file);

  /// To the file only.
  void detail(const std::string& message);
  void info(const std::string& message);
  /// Shown as "warning: ...".
  void warning(const std::string& message);
  /// Shown as "error: ...".
  void error(const std::string& message);

 private:
  std::shared_ptr<spdlog::logger> logger_;
};

}  // namespace riven
