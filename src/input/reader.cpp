#include "input/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/nearest_name.hpp"

namespace riven {
namespace {

std::string join(const std::string& path, std::string_view name) {
  return path.empty() ? std::string(name) : fmt::format("{}.{}", path, name);
}

// How users write the section of a key whose path is `path`: [solver], [[load]], [material.NAME].
std::string section(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos) return "the top of the file, above all sections";
  std::string table = path.substr(0, dot);
  if (table.ends_with("[]")) return fmt::format("[[{}]]", table.substr(0, table.size() - 2));
  table.erase(std::remove(table.begin(), table.end(), '['), table.end());
  table.erase(std::remove(table.begin(), table.end(), ']'), table.end());
  return fmt::format("[{}]", table);
}

// Sections where a key of this name is valid.
std::vector<std::string> sections_with(std::string_view name) {
  std::vector<std::string> found;
  for (const std::string& path : all_keys()) {
    const std::size_t dot = path.rfind('.');
    if (path.substr(dot == std::string::npos ? 0 : dot + 1) == name) found.push_back(section(path));
  }
  return found;
}

[[noreturn]] void fail_unknown(const std::string& name, const std::vector<std::string>& valid,
                               const Origin& origin) {
  const std::string near = did_you_mean(name, valid);
  const std::vector<std::string> elsewhere = near.empty() ? sections_with(name) : std::vector<std::string>{};
  const std::string belongs =
      elsewhere.empty() ? "" : fmt::format("; \"{}\" belongs in {}", name, fmt::join(elsewhere, " or "));
  origin.fail(fmt::format("unknown key; valid here are {}{}{}", listed(valid), belongs, near));
}

std::string with(const std::optional<When>& rule) {
  return rule ? fmt::format(" with {}", rule->text()) : "";
}

// What a value of this kind looks like, for a missing key.
std::string example(const Kind& kind) {
  if (const auto* text = std::get_if<kind::Text>(&kind); text != nullptr && !text->among.empty())
    return fmt::format("\"{}\"", fmt::join(text->among, "\" or \""));
  if (std::holds_alternative<kind::Text>(kind)) return "a string";
  if (const auto* quantity = std::get_if<kind::Quantity>(&kind)) {
    if (quantity->dimension == dimension::none) return "a number";
    return fmt::format("{} such as \"10 {}\"", named(quantity->dimension), usual_unit(quantity->dimension));
  }
  if (std::holds_alternative<kind::Table>(kind) || std::holds_alternative<kind::NamedTables>(kind))
    return "a section";
  if (std::holds_alternative<kind::Part>(kind) || std::holds_alternative<kind::Parts>(kind))
    return "the name of an edge or a set";
  return "a list";
}

}  // namespace

class Reader::TableCheck : public Check {
 public:
  TableCheck(const Source& source, const toml::table& table, std::string path)
      : source_(source), table_(table), path_(std::move(path)) {}

  [[nodiscard]] bool given(const std::string& key) const override { return table_.contains(key); }
  [[nodiscard]] Location at(const std::string& key) const override { return origin(key).at; }
  [[noreturn]] void fail(const std::string& key, const std::string& message) const override {
    origin(key).fail(message);
  }

 private:
  [[nodiscard]] Origin origin(const std::string& key) const {
    const toml::node* node = table_.get(key);
    return source_.origin(key.empty() ? path_ : join(path_, key), node != nullptr ? *node : table_);
  }

  const Source& source_;
  const toml::table& table_;
  std::string path_;
};

void Reader::read_all() {
  read(source_.root(), describe(case_), "");
}

void Reader::read(const toml::table& table, const Format& format, const std::string& path) {
  if (format.at != nullptr) *format.at = source_.origin(path, table).at;
  check_names(table, format, path);
  for (const Key& key : format.keys) read_key(table, key, path);
  check_groups(table, format, path);
  if (format.finish) format.finish(TableCheck(source_, table, path));
}

void Reader::check_names(const toml::table& table, const Format& format, const std::string& path) const {
  std::vector<std::string> valid;
  for (const Key& key : format.keys) valid.push_back(key.name);
  for (const auto& [name, node] : table) {
    const std::string found(name.str());
    if (std::find(valid.begin(), valid.end(), found) == valid.end())
      fail_unknown(found, valid, source_.origin(join(path, found), name));
  }
}

void Reader::read_key(const toml::table& table, const Key& key, const std::string& path) {
  const std::string here = join(path, key.name);
  const toml::node* node = table.get(key.name);
  if (node != nullptr) {
    const Origin origin = source_.origin(here, *node);
    if (!key.applies_now())
      origin.fail(fmt::format("does not apply here; it belongs to {}, found \"{}\"", key.only->text(),
                              *key.only->value));
    if (std::holds_alternative<kind::Text>(key.kind) && !key.fallback && node->value<std::string>() == "")
      origin.fail("found an empty text; expected some letters");
    std::visit([&](const auto& to) { read_value(to, *node, origin); }, key.kind);
  } else if (key.needed_now()) {
    const std::string why = with(key.required_when && !key.is_required ? key.required_when : key.only);
    source_.origin(here, table).fail(fmt::format("missing{}; expected {}", why, example(key.kind)));
  } else if (key.fallback && key.applies_now()) {
    read_fallback(table, key, path);
  }
}

void Reader::read_fallback(const toml::table& table, const Key& key, const std::string& path) {
  const toml::table parsed = parse_value(*key.fallback);
  const Origin origin = source_.origin(join(path, key.name), table);
  std::visit([&](const auto& to) { read_value(to, *parsed.get("value"), origin); }, key.kind);
}

void Reader::check_groups(const toml::table& table, const Format& format, const std::string& path) const {
  for (const Group& group : format.groups) {
    if (group.only && !group.only->holds()) continue;
    std::vector<std::string> found;
    for (const std::string& key : group.keys)
      if (table.contains(key)) found.push_back(key);
    const std::string when = with(group.only);
    if (found.empty() && group.needed)
      source_.origin(path, table)
          .fail(fmt::format("nothing found; expected one of {}{}", listed(group.keys), when));
    if (found.size() > 1)
      source_.origin(join(path, found[1]), *table.get(found[1]))
          .fail(fmt::format("given together with {}; expected {}one of {}{}", found[0],
                            group.needed ? "exactly " : "at most ", listed(group.keys), when));
  }
}

Symbols Reader::symbols(std::vector<std::string> variables) const {
  const GeometryInput& g = case_.geometry;
  Symbols known{{}, {}, std::move(variables), {}, {}};
  for (const TableInput& table : case_.tables) known.tables.push_back(table.function);
  for (const FieldInput& field : case_.fields) known.fields.push_back(field.field);
  if (g.spacing > 0) known.dx = g.spacing;
  if (g.horizon > 0) known.horizon = g.horizon;
  return known;
}

Origin Reader::entry_origin(const Origin& list, std::size_t index, const toml::node& node) const {
  return source_.origin(join(list.key, std::to_string(index + 1)), node);
}

}  // namespace riven
