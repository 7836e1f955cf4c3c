#include "input/format.hpp"

#include <algorithm>

namespace riven {

bool When::holds() const {
  return std::find(among.begin(), among.end(), *value) != among.end();
}

std::string When::text() const {
  std::string values;
  for (const std::string& each : among)
    values.append(values.empty() ? "\"" : " or \"").append(each).append("\"");
  return key + " = " + values;
}

bool Key::needed_now() const {
  return applies_now() && (is_required || (required_when && required_when->holds()));
}

void for_each_key(const Format& format, const std::string& path,
                  const std::function<void(const std::string&, const Key&)>& visit) {
  for (const Key& key : format.keys) {
    const std::string here = path.empty() ? key.name : path + "." + key.name;
    visit(here, key);
    if (const auto* table = std::get_if<kind::Table>(&key.kind)) for_each_key(table->open(), here, visit);
    if (const auto* tables = std::get_if<kind::Tables>(&key.kind))
      for_each_key(tables->open(0), here + "[]", visit);
    if (const auto* named = std::get_if<kind::NamedTables>(&key.kind)) {
      named->name(0);
      for_each_key(named->open(0), here + ".NAME", visit);
    }
  }
}

std::vector<std::string> all_keys() {
  Case scratch;
  std::vector<std::string> keys;
  for_each_key(describe(scratch), "", [&](const std::string& path, const Key&) { keys.push_back(path); });
  return keys;
}

}  // namespace riven
