#include "output/log.hpp"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/basic_file_sink.h>

#include <mutex>
#include <string_view>
#include <utility>

#include "base/error.hpp"

namespace riven {
namespace {

/// Messages as a person reads them: no time, and a level only where something is wrong.
class ScreenSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  ScreenSink(std::ostream& screen, std::function<void()> before_message)
      : screen_(screen), before_message_(std::move(before_message)) {}

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    if (before_message_) before_message_();
    if (message.level == spdlog::level::warn) screen_ << "warning: ";
    if (message.level == spdlog::level::err) screen_ << "error: ";
    screen_ << std::string_view(message.payload.data(), message.payload.size()) << '\n';
  }
  void flush_() override { screen_.flush(); }

 private:
  std::ostream& screen_;
  std::function<void()> before_message_;
};

}  // namespace

Log::Log(std::ostream& screen, std::function<void()> before_message) {
  auto sink = std::make_shared<ScreenSink>(screen, std::move(before_message));
  sink->set_level(spdlog::level::info);
  logger_ = std::make_shared<spdlog::logger>("riven", std::move(sink));
  logger_->set_level(spdlog::level::debug);
  // A log that cannot be written must not hide the message about why.
  logger_->set_error_handler([](const std::string&) {});
  logger_->flush_on(spdlog::level::debug);  // a killed run keeps what it said
}

void Log::open(const std::filesystem::path& file) {
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string());
    sink->set_pattern("%Y-%m-%d %H:%M:%S.%e  %-8l %v");
    logger_->sinks().push_back(std::move(sink));
  } catch (const spdlog::spdlog_ex& problem) {
    throw RunError(fmt::format("cannot write {}: {}", file.string(), problem.what()));
  }
}

// "{}" because a message may hold braces of its own.
void Log::detail(const std::string& message) {
  logger_->debug("{}", message);
}
void Log::info(const std::string& message) {
  logger_->info("{}", message);
}
void Log::warning(const std::string& message) {
  logger_->warn("{}", message);
}
void Log::error(const std::string& message) {
  logger_->error("{}", message);
}

}  // namespace riven
