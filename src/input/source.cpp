#include "input/source.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <utility>

namespace riven {
namespace {

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// The index of the entry that a path names by its number, from 1.
std::optional<std::size_t> index_of(const toml::array& array, const std::string& number) {
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), count);
  if (error != std::errc{} || end != number.data() + number.size() || count < 1 || count > array.size())
    return std::nullopt;
  return count - 1;
}

bool begins_with_path(const std::string& path, const std::string& start) {
  return path == start || (path.starts_with(start) && path[start.size()] == '.');
}

// toml++ keeps places when it moves values, and loses them when it copies.
void put(toml::table& into, const std::string& name, toml::node& value) {
  value.visit([&](auto& concrete) { into.insert_or_assign(name, std::move(concrete)); });
}

void put(toml::array& into, std::size_t index, toml::node& value) {
  value.visit([&](auto& concrete) {
    into.replace(into.cbegin() + static_cast<std::ptrdiff_t>(index), std::move(concrete));
  });
}

}  // namespace

toml::table parse_value(const std::string& text) {
  if (text.find('\n') == std::string::npos) {
    try {
      return toml::parse(fmt::format("value = {}", text));
    } catch (const toml::parse_error&) {
      // Not TOML: a bare word.
    }
  }
  toml::table bare;
  bare.insert("value", text);
  return bare;
}

Source::Source(std::string_view text, std::string file, const std::vector<std::string>& overrides)
    : file_(std::move(file)), lines_(split(text, '\n')) {
  if (text.find('\0') != std::string_view::npos)
    throw InputError({file_}, "is a binary file; expected a case file in TOML");
  try {
    root_ = toml::parse(text, file_);
  } catch (const toml::parse_error& error) {
    const auto& begin = error.source().begin;
    throw InputError({file_, static_cast<int>(begin.line), static_cast<int>(begin.column)},
                     fmt::format("is not TOML here: {}", error.description()));
  }
  for (const std::string& each : overrides) apply(each);
}

void Source::apply(const std::string& override_text) {
  const std::size_t equals = override_text.find('=');
  const std::string path = trimmed(override_text.substr(0, equals));
  const Origin origin{"", {fmt::format("--set {}", path)}};
  if (equals == std::string::npos || path.empty())
    throw InputError(fmt::format("--set {}: expected path.to.key=value, such as geometry.horizon=\"4 dx\"",
                                 override_text));
  const std::vector<std::string> names = split(path, '.');
  toml::table parsed = parse_value(trimmed(override_text.substr(equals + 1)));
  toml::node& value = *parsed.get("value");
  toml::node* at = &root_;
  std::string walked;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool last = i + 1 == names.size();
    if (names[i].empty()) origin.fail("has an empty name; expected path.to.key=value");
    if (toml::array* array = at->as_array()) {
      const auto index = index_of(*array, names[i]);
      if (!index)
        origin.fail(array->empty()
                        ? fmt::format("{} has no entries", walked)
                        : fmt::format("{} has {} {}; expected a number from 1 to {}, found \"{}\"", walked,
                                      array->size(), array->size() == 1 ? "entry" : "entries", array->size(),
                                      names[i]));
      if (last) put(*array, *index, value);
      at = array->get(*index);
    } else if (toml::table* table = at->as_table()) {
      if (last)
        put(*table, names[i], value);
      else if (table->get(names[i]) == nullptr)
        table->insert(names[i], toml::table{});
      if (!last) at = table->get(names[i]);
    } else {
      origin.fail(fmt::format("{} is neither a table nor a list", walked));
    }
    walked += (walked.empty() ? "" : ".") + names[i];
  }
  overridden_.push_back(path);
}

Origin Source::origin(const std::string& path, const toml::node& node) const {
  Origin origin = this->origin(path, node.source());
  origin.text_column = text_column(node);
  return origin;
}

Origin Source::origin(const std::string& path, const toml::key& key) const {
  return origin(path, key.source());
}

Origin Source::origin(const std::string& path, const toml::source_region& region) const {
  for (const std::string& each : overridden_) {
    if (begins_with_path(path, each)) return {path, {fmt::format("--set {}", path)}};
    if (region.begin.line == 0 && begins_with_path(each, path))
      return {path, {fmt::format("--set {}", each)}};
  }
  return {path, {file_, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)}};
}

int Source::text_column(const toml::node& node) const {
  const toml::source_position begin = node.source().begin;
  const auto* text = node.as_string();
  if (text == nullptr || begin.line == 0 || begin.line > lines_.size()) return 0;
  // Escapes and multi-line strings have no simple columns.
  const std::string& line = lines_[begin.line - 1];
  std::size_t byte = 0;
  for (unsigned column = 1; column < begin.column && byte < line.size(); ++column) {
    ++byte;
    while (byte < line.size() && (static_cast<unsigned char>(line[byte]) & 0xC0U) == 0x80U) ++byte;
  }
  const bool plain = line.compare(std::min(byte + 1, line.size()), text->get().size(), text->get()) == 0;
  return plain ? static_cast<int>(begin.column) + 1 : 0;
}

}  // namespace riven
