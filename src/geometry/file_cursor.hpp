#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace riven {

/// The bytes of a file of words and numbers, some written out, some binary, read from front to back. Every
/// reading function takes what it expects, for the message where something else stands, and throws InputError
/// with the line or, in a binary file, the byte.
class FileCursor {
 public:
  /// Throws InputError when there is no such file.
  explicit FileCursor(const std::filesystem::path& file);

  /// Numbers that follow are binary, little-endian; messages count bytes.
  void set_binary() { binary_ = true; }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] bool starts_with(std::string_view text) const { return bytes_.starts_with(text); }
  /// The binary number that begins at a byte; 0 beyond the end.
  template <class Number>
  [[nodiscard]] Number peek(std::size_t byte) const {
    Number value{};
    if (byte + sizeof value <= bytes_.size()) std::memcpy(&value, bytes_.data() + byte, sizeof value);
    return value;
  }
  [[nodiscard]] const std::string& file() const { return file_; }
  /// What messages call the part of the file that is read now; empty: nothing.
  void enter(std::string section) { section_ = std::move(section); }

  /// At the word or number that was read last.
  [[noreturn]] void fail(const std::string& message) const { fail(last_, message); }

  /// Whether only blanks are left.
  [[nodiscard]] bool at_end();
  /// The next word between blanks; empty at the end.
  std::string_view word();
  /// Reads a word that must be this one.
  void expect_word(std::string_view expected);
  /// A text in double quotes.
  std::string quoted(const char* what);
  void skip_bytes(std::size_t count);
  /// Goes behind the end of the line; binary data begin there.
  void skip_line();
  /// Goes behind `mark`, which begins a line.
  void skip_behind(const std::string& mark);

  /// A number written out, also in a binary file.
  template <class Number>
  Number written(const char* what) {
    const std::string_view text = word();
    Number value{};
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || problem != std::errc{} || end != text.data() + text.size()) fail_number(text, what);
    return value;
  }
  template <class Number>
  Number number(const char* what) {
    if (!binary_) return written<Number>(what);
    Number value{};
    take(&value, sizeof value, what);
    return value;
  }
  int integer(const char* what) { return number<std::int32_t>(what); }
  std::size_t tag(const char* what) { return number<std::uint64_t>(what); }
  /// A number of things that follow, each of which takes a byte at least.
  std::size_t count(const char* what) { return checked_count(number<std::uint64_t>(what), what); }
  std::size_t written_count(const char* what) { return checked_count(written<std::uint64_t>(what), what); }
  /// A finite number.
  double real(const char* what) { return checked_real(number<double>(what), what); }
  /// The same of single precision: the shortest decimal number that it stands for.
  double single(const char* what);

  /// For messages: the word in quotes, or "the end of the file".
  static std::string described(std::string_view word);

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& message) const;
  [[noreturn]] void fail_number(std::string_view text, const char* what) const;
  void take(void* value, std::size_t bytes, const char* what);
  [[nodiscard]] std::size_t checked_count(std::uint64_t value, const char* what) const;
  [[nodiscard]] double checked_real(double value, const char* what) const;
  void skip_blanks();

  std::string file_, bytes_, section_;
  bool binary_ = false;
  std::size_t at_ = 0, last_ = 0;
};

}  // namespace riven
