#include <cctype>
#include <string_view>

#include "app/commands.hpp"

namespace riven::app {

std::string shell_word(const std::string& word) {
  const bool plain = word.find_first_not_of(
                         "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789"
                         "_-./=:,+") == std::string::npos;
  if (plain && !word.empty()) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string file_word(const std::string& text) {
  constexpr std::size_t kMost = 120;  // file systems allow 255 bytes, and endings come on top
  std::string word;
  for (const char c : text.substr(0, kMost)) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                       std::string_view("._-+=,").find(c) != std::string_view::npos;
    word += plain && (c != '.' || !word.empty()) ? c : '_';  // a name with a dot first would be hidden
  }
  return word;
}

}  // namespace riven::app
