#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

#include "input/formula.hpp"

namespace riven {

/// A parsed case file with what messages need to point at its text.
class Source {
 public:
  /// Throws InputError where the text is not TOML or an override cannot be applied.
  Source(std::string_view text, std::string file, const std::vector<std::string>& overrides);

  [[nodiscard]] const toml::table& root() const { return root_; }
  [[nodiscard]] const std::string& file() const { return file_; }

  /// The place of a value, or the override that gave it.
  [[nodiscard]] Origin origin(const std::string& path, const toml::node& node) const;
  /// The place of a key's name.
  [[nodiscard]] Origin origin(const std::string& path, const toml::key& key) const;

 private:
  void apply(const std::string& override_text);
  [[nodiscard]] Origin origin(const std::string& path, const toml::source_region& region) const;
  [[nodiscard]] int text_column(const toml::node& node) const;

  std::string file_;
  std::vector<std::string> lines_;
  toml::table root_;
  std::vector<std::string> overridden_;  // paths
};

/// Parses one TOML value; what is no TOML, such as `5 mm`, is taken as a string.
toml::table parse_value(const std::string& text);

}  // namespace riven
