#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "input/case_reader.hpp"
#include "input/case_writer.hpp"
#include "input/format.hpp"
#include "input/schema.hpp"
#include "input_cases.hpp"

namespace riven {
namespace {

using Json = nlohmann::json;

// The part of JSON Schema that the case schema uses; an unknown word is an error, so that nothing goes
// unchecked.
bool valid(const Json& value, const Json& schema);

bool is_type(const Json& value, const Json& type) {
  if (type.is_array())
    return std::any_of(type.begin(), type.end(), [&](const Json& one) { return is_type(value, one); });
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "number") return value.is_number();
  if (type == "integer") return value.is_number_integer();
  throw std::logic_error("type " + type.dump());
}

int count_valid(const Json& value, const Json& schemas) {
  return static_cast<int>(
      std::count_if(schemas.begin(), schemas.end(), [&](const Json& s) { return valid(value, s); }));
}

bool object_valid(const Json& value, const Json& schema) {
  if (!value.is_object()) return true;
  const Json properties = schema.value("properties", Json::object());
  for (const Json& name : schema.value("required", Json::array()))
    if (!value.contains(name.get<std::string>())) return false;
  for (const auto& [name, member] : value.items()) {
    if (properties.contains(name) && !valid(member, properties[name])) return false;
    if (!properties.contains(name) && schema.contains("additionalProperties") &&
        !valid(member, schema["additionalProperties"]))
      return false;
  }
  return true;
}

bool array_valid(const Json& value, const Json& schema) {
  if (!value.is_array()) return true;
  if (value.size() < schema.value("minItems", 0U) || value.size() > schema.value("maxItems", 1000U))
    return false;
  if (schema.value("uniqueItems", false) && std::set<Json>(value.begin(), value.end()).size() != value.size())
    return false;
  return !schema.contains("items") || std::all_of(value.begin(), value.end(), [&](const Json& item) {
    return valid(item, schema["items"]);
  });
}

bool word_valid(const std::string& word, const Json& value, const Json& schema) {
  const Json& rule = schema[word];
  if (word == "type") return is_type(value, rule);
  if (word == "enum") return std::find(rule.begin(), rule.end(), value) != rule.end();
  if (word == "const") return value == rule;
  if (word == "minimum") return !value.is_number() || value >= rule;
  if (word == "exclusiveMinimum") return !value.is_number() || value > rule;
  if (word == "maximum") return !value.is_number() || value <= rule;
  if (word == "minLength")
    return !value.is_string() || value.get<std::string>().size() >= rule.get<std::size_t>();
  if (word == "anyOf") return count_valid(value, rule) > 0;
  if (word == "oneOf") return count_valid(value, rule) == 1;
  if (word == "allOf") return count_valid(value, rule) == static_cast<int>(rule.size());
  if (word == "not") return !valid(value, rule);
  if (word == "if") {
    const char* branch = valid(value, rule) ? "then" : "else";
    return !schema.contains(branch) || valid(value, schema[branch]);
  }
  static const std::set<std::string> elsewhere{
      "$schema", "title",    "description", "properties",  "required", "additionalProperties",
      "items",   "minItems", "maxItems",    "uniqueItems", "then",     "else"};
  if (elsewhere.contains(word)) return true;
  throw std::logic_error("word " + word);
}

bool valid(const Json& value, const Json& schema) {
  if (schema.is_boolean()) return schema.get<bool>();
  for (const auto& [word, rule] : schema.items())
    if (!word_valid(word, value, schema)) return false;
  return object_valid(value, schema) && array_valid(value, schema);
}

const Json& schema() {
  static const Json parsed = Json::parse(case_schema().dump());
  return parsed;
}

bool schema_accepts(const toml::table& table) {
  std::ostringstream json;
  json << toml::json_formatter{table};
  return valid(Json::parse(json.str()), schema());
}

std::string reader_says(const toml::table& table) {
  std::ostringstream text;
  text << table;
  try {
    parse_case(text.str(), "case.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

using Paths = std::vector<std::string>;

void collect(const toml::node& node, const std::string& path, Paths& paths) {
  if (!path.empty()) paths.push_back(path);
  if (const auto* table = node.as_table())
    for (const auto& [name, member] : *table)
      collect(member, path.empty() ? std::string(name.str()) : path + "." + std::string(name.str()), paths);
  if (const auto* list = node.as_array(); list != nullptr && list->is_array_of_tables())
    for (std::size_t i = 0; i < list->size(); ++i)
      collect((*list)[i], path + "[" + std::to_string(i) + "]", paths);
}

Paths paths_of(const toml::table& table) {
  Paths paths;
  collect(table, "", paths);
  return paths;
}

// The table that holds the last name of a path, and that name; array entries are left alone.
std::pair<toml::table*, std::string> holder(toml::table& root, const std::string& path) {
  const std::size_t dot = path.rfind('.');
  const std::string name = path.substr(dot == std::string::npos ? 0 : dot + 1);
  if (name.ends_with("]")) return {nullptr, name};
  return {dot == std::string::npos ? &root : root.at_path(path.substr(0, dot)).as_table(), name};
}

class SchemaAndReader : public testing::TestWithParam<std::string> {};

TEST_P(SchemaAndReader, AcceptTheSameCase) {
  const toml::table table = toml::parse(GetParam());
  EXPECT_TRUE(schema_accepts(table));
  EXPECT_EQ(reader_says(table), "accepted");
}

TEST_P(SchemaAndReader, RefuseTheSameMissingKeys) {
  // What the reader knows and a schema cannot: rules between sections, the dimension of the body, references
  // to sets.
  const std::set<std::string> only_reader{"geometry.box.thickness",
                                          "set",
                                          "set.ends",
                                          "set.patch",
                                          "material.rubber.density",
                                          "material.rubber",
                                          "load[0].on",  // needed but for a body_force
                                          "load[1].on",
                                          "expect[0].value",
                                          "expect[0].tolerance",
                                          "expect[1].tolerance",
                                          "expect[1].file",
                                          "short.expect[0].value",
                                          "short.expect[0].absolute_tolerance"};
  for (const std::string& path : paths_of(toml::parse(GetParam()))) {
    toml::table changed = toml::parse(GetParam());
    const auto [table, name] = holder(changed, path);
    if (table == nullptr) continue;
    table->erase(name);
    const std::string said = reader_says(changed);
    const bool accepted = schema_accepts(changed);
    const bool known_gap = accepted && only_reader.contains(path);
    EXPECT_TRUE(known_gap || accepted == (said == "accepted")) << path << ": " << said;
  }
}

TEST_P(SchemaAndReader, RefuseWrongTypesAndUnknownKeys) {
  for (const std::string& path : paths_of(toml::parse(GetParam()))) {
    toml::table wrong_type = toml::parse(GetParam());
    const auto [table, name] = holder(wrong_type, path);
    if (table != nullptr) {
      table->insert_or_assign(name, true);
      EXPECT_FALSE(schema_accepts(wrong_type)) << path;
      EXPECT_NE(reader_says(wrong_type), "accepted") << path;
    }
    toml::table more = toml::parse(GetParam());
    toml::table* inside = more.at_path(path).as_table();
    if (inside == nullptr || path == "set" || path == "material") continue;
    inside->insert("unknown_key", 1);
    EXPECT_FALSE(schema_accepts(more)) << path;
    EXPECT_NE(reader_says(more).find("unknown key"), std::string::npos) << path;
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, SchemaAndReader, testing::Values(static_case, moving_case));

// The schema's entry for "load[].on", "set.NAME.where".
const Json* find_in_schema(const std::string& path) {
  const Json* at = &schema();
  std::istringstream names(path);
  for (std::string name; std::getline(names, name, '.');) {
    const bool entries = name.ends_with("[]");
    if (entries) name.resize(name.size() - 2);
    if (name == "NAME") {
      at = &(*at)["additionalProperties"];
    } else {
      if (!at->contains("properties") || !(*at)["properties"].contains(name)) return nullptr;
      at = &(*at)["properties"][name];
    }
    if (entries) at = &(*at)["items"];
  }
  return at;
}

TEST(Schema, HoldsEveryKeyWithItsMeaning) {
  EXPECT_EQ(schema()["$schema"], "https://json-schema.org/draft/2020-12/schema");
  ASSERT_GT(all_keys().size(), 80U);
  for (const std::string& path : all_keys()) {
    const Json* found = find_in_schema(path);
    ASSERT_NE(found, nullptr) << path;
    EXPECT_TRUE(found->contains("description")) << path;
  }
  EXPECT_EQ(find_in_schema("geometry.horizn"), nullptr);
}

TEST(Reference, ListsEveryKeyInItsSection) {
  const std::string page = reference_page();
  Case scratch;
  for_each_key(describe(scratch), "", [&](const std::string& path, const Key& key) {
    const std::size_t dot = path.rfind('.');
    std::string section = dot == std::string::npos ? "top of the file" : path.substr(0, dot);
    const std::string title = section.ends_with("[]")    ? "[[" + section.substr(0, section.size() - 2) + "]]"
                              : dot == std::string::npos ? section
                                                         : "[" + section + "]";
    if (title.find("[].") != std::string::npos) return;
    const std::size_t at = page.find("\n## `" + title + "`");
    ASSERT_NE(at, std::string::npos) << title;
    const std::string text = page.substr(at, page.find("\n## ", at + 1) - at);
    EXPECT_NE(text.find("\n| `" + key.name + "` | "), std::string::npos) << path;
    EXPECT_NE(text.find(key.doc), std::string::npos) << path;
  });
}

TEST(Reference, ThePageInDocsIsTheGeneratedOne) {
  std::ifstream file(RIVEN_ROOT "/docs/reference.md");
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_TRUE(text == reference_page())
      << "docs/reference.md is out of date: write it anew by riven schema --markdown";
}

class RoundTrip : public testing::TestWithParam<std::string> {};

TEST_P(RoundTrip, TheResolvedCaseReadsBackToTheSameValues) {
  const Case first = parse_case(GetParam(), "case.toml");
  const std::string resolved = resolved_case(first);
  SCOPED_TRACE(resolved);
  const Case second = parse_case(resolved, "resolved.toml");
  // What is written from the same values is the same text, so equal texts mean equal values.
  EXPECT_EQ(resolved_case(second), resolved);
  EXPECT_EQ(second.geometry.spacing, first.geometry.spacing);
  EXPECT_EQ(second.geometry.horizon, first.geometry.horizon);
  EXPECT_EQ(second.geometry.thickness, first.geometry.thickness);
  EXPECT_EQ(second.materials[0].density, first.materials[0].density);
  EXPECT_EQ(second.materials[0].numbers, first.materials[0].numbers);
  EXPECT_EQ(second.solver.stretch, first.solver.stretch);
  EXPECT_EQ(second.solver.until, first.solver.until);
  EXPECT_EQ(second.solver.safety, first.solver.safety);
  EXPECT_EQ(second.output.fields, first.output.fields);
  EXPECT_EQ(second.holes.size(), first.holes.size());
  EXPECT_EQ(second.inclusions.size(), first.inclusions.size());
  ASSERT_EQ(second.sets.size(), first.sets.size());
  ASSERT_EQ(second.expects.size(), first.expects.size());
  for (std::size_t i = 0; i < first.expects.size(); ++i) {
    EXPECT_EQ(second.expects[i].state, first.expects[i].state);
    EXPECT_EQ(second.expects[i].value.has_value(), first.expects[i].value.has_value());
  }
  const Variables place{{0.031, 0.012, 0}, 1e-5, 1.7};
  for (std::size_t i = 0; i < first.loads.size(); ++i)
    for (std::size_t d = 0; d < 2; ++d) {
      const auto& a = first.loads[i].displacement[d].value;
      const auto& b = second.loads[i].displacement[d].value;
      ASSERT_EQ(a.has_value(), b.has_value());
      if (a) {
        EXPECT_EQ((*a)(place), (*b)(place));
      }
    }
}

TEST_P(RoundTrip, EveryDefaultIsWritten) {
  const std::string resolved = resolved_case(parse_case(GetParam(), "case.toml"));
  Case scratch = parse_case(GetParam(), "case.toml");
  const toml::table table = toml::parse(resolved);
  const Format top = describe(scratch);
  for (const Key& section : top.keys) {
    const auto* format = std::get_if<kind::Table>(&section.kind);
    if (format == nullptr || !format->given()) continue;
    for (const Key& key : format->open().keys)
      if (key.fallback && key.applies_now()) {
        EXPECT_TRUE(table[section.name].as_table()->contains(key.name)) << section.name << "." << key.name;
      }
  }
}

TEST(RoundTrip, ValuesAreInSiUnits) {
  const std::string resolved = resolved_case(parse_case(static_case, "case.toml"));
  EXPECT_NE(resolved.find("spacing = \"0.005 m\""), std::string::npos) << resolved;
  EXPECT_NE(resolved.find("youngs_modulus = \"109000000 Pa\""), std::string::npos) << resolved;
  EXPECT_NE(resolved.find("value = \"512000 N\""), std::string::npos) << resolved;
  EXPECT_NE(resolved.find("max_iterations = 20000"), std::string::npos) << resolved;
}

INSTANTIATE_TEST_SUITE_P(Cases, RoundTrip, testing::Values(static_case, moving_case));

}  // namespace
}  // namespace riven
