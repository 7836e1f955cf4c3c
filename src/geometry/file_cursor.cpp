#include "geometry/file_cursor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>

#include "base/error.hpp"

namespace riven {
namespace {

constexpr const char* kCut = "; is the file cut short?";

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// As much of a word as a message can show.
std::string shown(std::string_view word) {
  constexpr std::size_t kMost = 30;
  std::string text(word.substr(0, kMost));
  for (char& c : text)
    if (c < 0x20 || c > 0x7e) c = '?';
  return word.size() > kMost ? text + "..." : text;
}

}  // namespace

FileCursor::FileCursor(const std::filesystem::path& file) : file_(file.string()) {
  static_assert(std::endian::native == std::endian::little);
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file)) throw InputError(Location{file_}, "there is no such file");
  bytes_.assign(std::istreambuf_iterator<char>(in), {});
}

void FileCursor::fail(std::size_t at, const std::string& message) const {
  if (binary_)
    throw InputError(Location{file_},
                     fmt::format("byte {}{}{}: {}", at, section_.empty() ? "" : " in ", section_, message));
  const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(at);
  throw InputError(Location{file_, 1 + static_cast<int>(std::count(bytes_.begin(), end, '\n'))},
                   section_.empty() ? message : fmt::format("in {}: {}", section_, message));
}

void FileCursor::fail_number(std::string_view text, const char* what) const {
  fail(fmt::format("found {}; expected {}{}", described(text), what, text.empty() ? kCut : ""));
}

bool FileCursor::at_end() {
  skip_blanks();
  return at_ == bytes_.size();
}

std::string_view FileCursor::word() {
  skip_blanks();
  last_ = at_;
  while (at_ < bytes_.size() && !is_blank(bytes_[at_])) ++at_;
  return std::string_view(bytes_).substr(last_, at_ - last_);
}

void FileCursor::expect_word(std::string_view expected) {
  const std::string_view found = word();
  if (found != expected)
    fail(fmt::format("found {}; expected {}{}", described(found), expected, found.empty() ? kCut : ""));
}

std::string FileCursor::quoted(const char* what) {
  skip_blanks();
  last_ = at_;
  const bool begins = at_ < bytes_.size() && bytes_[at_] == '"';
  const std::size_t end = begins ? bytes_.find_first_of("\"\n", at_ + 1) : std::string::npos;
  if (end == std::string::npos || bytes_[end] == '\n')
    fail(fmt::format("expected {} in double quotes", what));
  at_ = end + 1;
  return bytes_.substr(last_ + 1, end - last_ - 1);
}

void FileCursor::skip_bytes(std::size_t count) {
  at_ = std::min(bytes_.size(), at_ + count);
}

void FileCursor::skip_line() {
  at_ = std::min(bytes_.find('\n', at_), bytes_.size() - 1) + 1;
}

void FileCursor::skip_behind(const std::string& mark) {
  const std::size_t found = bytes_.find("\n" + mark, at_);
  if (found == std::string::npos)
    fail(bytes_.size(), fmt::format("found the end of the file; expected {}{}", mark, kCut));
  at_ = found + 1 + mark.size();
}

double FileCursor::single(const char* what) {
  const auto value = number<float>(what);
  if (!std::isfinite(value)) return checked_real(value, what);
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.begin(), text.end(), value).ptr;
  double decimal = 0;
  std::from_chars(text.begin(), end, decimal);
  return decimal;
}

std::string FileCursor::described(std::string_view word) {
  return word.empty() ? "the end of the file" : fmt::format("\"{}\"", shown(word));
}

void FileCursor::take(void* value, std::size_t bytes, const char* what) {
  last_ = at_;
  if (bytes_.size() - at_ < bytes) fail_number({}, what);
  std::memcpy(value, bytes_.data() + at_, bytes);
  at_ += bytes;
}

std::size_t FileCursor::checked_count(std::uint64_t value, const char* what) const {
  if (value > bytes_.size() - at_)
    fail(fmt::format("found {} as {}, more than the rest of the file can hold{}", value, what, kCut));
  return value;
}

double FileCursor::checked_real(double value, const char* what) const {
  if (!std::isfinite(value)) fail(fmt::format("found {}; expected {}, a finite number", value, what));
  return value;
}

void FileCursor::skip_blanks() {
  while (at_ < bytes_.size() && is_blank(bytes_[at_])) ++at_;
}

}  // namespace riven
