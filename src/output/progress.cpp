#include "output/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>

namespace riven {
namespace {

constexpr double kTerminalInterval = 0.1;  // s
constexpr double kPlainInterval = 2;       // s
constexpr double kTellingFraction = 0.02;  // of the run: before it, the time left is anyone's guess
constexpr const char* kClearLine = "\r\x1b[K";

int terminal_width() {
  if (!::isatty(STDERR_FILENO)) return 0;
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::min(seconds, 1e9));
  const long hours = whole / 3600, minutes = whole / 60 % 60, rest = whole % 60;
  return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, rest)
                   : fmt::format("{}:{:02}", minutes, rest);
}

}  // namespace

std::string progress_text(const ProgressState& state, double elapsed_s) {
  std::string text;
  auto out = std::back_inserter(text);
  if (state.load_step > 0) fmt::format_to(out, "step {}/{}, ", state.load_step, state.load_steps);
  fmt::format_to(out, "{} {:.6g}", name(state.parameter), state.value);
  if (!unit(state.parameter).empty()) fmt::format_to(out, " {}", unit(state.parameter));
  if (!std::isnan(state.residual)) fmt::format_to(out, ", residual {:.1e}", state.residual);
  if (state.iterations > 0) fmt::format_to(out, ", iteration {}", state.iterations);
  fmt::format_to(out, ", {} elapsed", duration_text(elapsed_s));
  if (state.fraction >= kTellingFraction && state.fraction < 1) {
    fmt::format_to(out, ", {} left", duration_text(elapsed_s * (1 - state.fraction) / state.fraction));
  }
  if (!std::isnan(state.balance_error)) fmt::format_to(out, ", energy balance {:.1e}", state.balance_error);
  return text;
}

Progress::Progress() : Progress(std::cerr, terminal_width, steady_seconds) {}

Progress::Progress(std::ostream& out, Width width, Clock clock)
    : out_(out), width_(std::move(width)), clock_(std::move(clock)), start_(clock_()) {}

void Progress::update(const ProgressState& state) {
  last_ = state;
  pending_ = true;
  const double waited = clock_() - last_shown_;
  const bool due = waited >= kPlainInterval || (waited >= kTerminalInterval && width_() > 0);
  if (due || state.step_done) show(state);
}

void Progress::show(const ProgressState& state) {
  const double now = clock_();
  std::string text = progress_text(state, now - start_);
  const int width = width_();
  if (width > 0) {
    // A line that wraps could not be rewritten; the last column stays free because some terminals wrap there.
    if (text.size() >= static_cast<std::size_t>(width)) text.resize(static_cast<std::size_t>(width - 1));
    out_ << kClearLine << text << std::flush;
    line_open_ = true;
  } else {
    out_ << text << '\n' << std::flush;
  }
  last_shown_ = now;
  pending_ = false;
}

void Progress::clear() {
  if (!line_open_) return;
  out_ << kClearLine << std::flush;
  line_open_ = false;
  last_shown_ = -std::numeric_limits<double>::infinity();
}

void Progress::finish() {
  if (pending_) show(last_);
  if (line_open_) out_ << '\n' << std::flush;
  line_open_ = false;
}

}  // namespace riven
