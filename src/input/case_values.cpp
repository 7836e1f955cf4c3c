#include "input/case_values.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <sstream>

#include "input/case_writer.hpp"

namespace riven {
namespace {

void add(const toml::node& node, const std::string& path, std::map<std::string, std::string>& values) {
  const auto below = [&](const std::string& name) { return path.empty() ? name : path + "." + name; };
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table) add(value, below(std::string(key.str())), values);
  } else if (const toml::array* list = node.as_array()) {
    std::size_t number = 0;
    for (const toml::node& entry : *list) add(entry, below(std::to_string(number++)), values);
  } else if (const auto* real = node.as_floating_point()) {
    values[path] = fmt::format("{}", real->get());
  } else {
    std::ostringstream text;
    node.visit([&](const auto& value) {
      if constexpr (toml::is_value<decltype(value)>) text << value;
    });
    values[path] = text.str();
  }
}

}  // namespace

std::map<std::string, std::string> case_values(const Case& of) {
  std::map<std::string, std::string> values;
  add(toml::parse(resolved_case(of)), "", values);
  return values;
}

}  // namespace riven
