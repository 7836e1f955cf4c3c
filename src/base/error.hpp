#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace riven {

/// A place in a text file; line and column count from 1, 0 = unknown.
struct Location {
  std::string file;
  int line = 0;
  int column = 0;

  /// "file:line:column", leaving out what is unknown.
  [[nodiscard]] std::string text() const {
    std::string place = file;
    // Piece by piece: g++ 12 wrongly sees an overlap in ":" + std::to_string(line).
    if (line > 0) place.append(":").append(std::to_string(line));
    if (line > 0 && column > 0) place.append(":").append(std::to_string(column));
    return place;
  }
};

/// A string that the user wrote, with its place, so that a later check can point at it.
struct Named {
  std::string text;
  Location at;
};

/// Wrong input: the program says where and what was expected, and exits with 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
  InputError(const Location& at, const std::string& message)
      : std::runtime_error(at.file.empty() ? message : at.text() + ": " + message) {}
};

/// A run that went wrong: the program says where, when, why and what to change, and exits with 3.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace riven
