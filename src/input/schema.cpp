#include "input/schema.hpp"

#include <algorithm>
#include <cmath>

#include "input/format.hpp"

namespace riven {
namespace {

using Json = nlohmann::ordered_json;

Json table_schema(const Format& format);

Json number_schema(const Range& range) {
  Json schema{{"type", "number"}};
  if (std::isfinite(range.low)) schema[range.above_low ? "exclusiveMinimum" : "minimum"] = range.low;
  if (std::isfinite(range.high)) schema[range.below_high ? "exclusiveMaximum" : "maximum"] = range.high;
  return schema;
}

Json quantity_schema(const Dimension& dimension, const Range& range) {
  const Json text{{"type", "string"}, {"minLength", 1}};
  if (dimension == dimension::none) return {{"anyOf", {number_schema(range), text}}};
  if (range.above_low && range.low == 0) return text;
  return {{"anyOf", {Json{{"const", 0}}, text}}};
}

Json text_schema(const std::vector<std::string>& among) {
  Json schema{{"type", "string"}};
  if (!among.empty()) schema["enum"] = among;
  return schema;
}

Json list_schema(const Json& items, std::size_t least, std::size_t most) {
  Json schema{{"type", "array"}, {"items", items}};
  if (least > 0) schema["minItems"] = least;
  if (most < 1000) schema["maxItems"] = most;
  return schema;
}

struct ValueSchema {
  Json operator()(const kind::Text& k) const { return text_schema(k.among); }
  Json operator()(const kind::Texts& k) const {
    Json schema = list_schema(text_schema(k.among), 0, 1000);
    schema["uniqueItems"] = true;
    return schema;
  }
  Json operator()(const kind::Flag&) const { return {{"type", "boolean"}}; }
  Json operator()(const kind::Integer& k) const { return {{"type", "integer"}, {"minimum", k.low}}; }
  Json operator()(const kind::Integers& k) const {
    return list_schema({{"type", "integer"}, {"minimum", k.low}}, 1, 3);
  }
  Json operator()(const kind::Quantity& k) const { return quantity_schema(k.dimension, k.range); }
  Json operator()(const kind::Quantities& k) const {
    return list_schema(quantity_schema(k.dimension, k.range), 1, k.most);
  }
  Json operator()(const kind::AnyUnit&) const { return {{"type", Json::array({"number", "string"})}}; }
  Json operator()(const kind::Place& k) const {
    return list_schema(quantity_schema(dimension::length, k.range), 1, 3);
  }
  Json operator()(const kind::Places& k) const {
    return list_schema(list_schema(quantity_schema(dimension::length, any_number), 1, 3), k.least, 1000);
  }
  Json operator()(const kind::Condition&) const { return {{"type", "string"}}; }
  Json operator()(const kind::Formula&) const {
    return {{"anyOf", {Json{{"const", 0}}, Json{{"type", "string"}}}}};
  }
  Json operator()(const kind::Components&) const {
    return list_schema({{"anyOf", {Json{{"const", 0}}, Json{{"type", "string"}}}}}, 1, 3);
  }
  Json operator()(const kind::Interval&) const { return {{"type", "string"}}; }
  Json operator()(const kind::Part&) const { return {{"type", "string"}}; }
  Json operator()(const kind::Parts&) const {
    const Json name{{"type", "string"}};
    return {{"anyOf", {name, list_schema(name, 1, 1000)}}};
  }
  Json operator()(const kind::Table& k) const { return table_schema(k.open()); }
  Json operator()(const kind::Tables& k) const { return list_schema(table_schema(k.open(0)), 0, 1000); }
  Json operator()(const kind::NamedTables& k) const {
    k.name(0);
    return {{"type", "object"}, {"additionalProperties", table_schema(k.open(0))}};
  }
};

// Whether a rule looks at a key of the same table; JSON Schema sees no other.
bool is_local(const When& when) {
  return when.key.find('.') == std::string::npos;
}

/// A key that is not given has its default, so that the rule may hold without it.
bool holds_by_default(const When& when, const Format& format) {
  const auto key =
      std::find_if(format.keys.begin(), format.keys.end(), [&](const Key& k) { return k.name == when.key; });
  return key != format.keys.end() && key->fallback &&
         std::any_of(when.among.begin(), when.among.end(),
                     [&](const std::string& value) { return *key->fallback == '"' + value + '"'; });
}

Json condition(const When& when, const Format& format) {
  Json rule{{"properties", {{when.key, {{"enum", when.among}}}}}};
  if (!holds_by_default(when, format)) rule["required"] = Json::array({when.key});
  return rule;
}

Json group_schema(const Group& group) {
  Json choices = Json::array();
  for (const std::string& key : group.keys) choices.push_back({{"required", Json::array({key})}});
  if (group.needed) return {{"oneOf", choices}};
  return {{"not", {{"required", group.keys}}}};
}

void add_rules(const Format& format, Json& rules) {
  for (const Key& key : format.keys) {
    if (key.only && is_local(*key.only)) {
      Json rule{{"if", condition(*key.only, format)}};
      if (key.is_required) rule["then"] = {{"required", Json::array({key.name})}};
      rule["else"] = {{"properties", {{key.name, false}}}};
      rules.push_back(rule);
    }
    if (key.required_when && is_local(*key.required_when))
      rules.push_back(
          {{"if", condition(*key.required_when, format)}, {"then", {{"required", Json::array({key.name})}}}});
  }
  for (const Group& group : format.groups) {
    if (group.only)
      rules.push_back({{"if", condition(*group.only, format)}, {"then", group_schema(group)}});
    else
      rules.push_back(group_schema(group));
  }
}

Json key_schema(const Key& key) {
  Json schema = std::visit(ValueSchema{}, key.kind);
  schema["description"] = key.doc;
  return schema;
}

Json table_schema(const Format& format) {
  Json properties = Json::object();
  Json required = Json::array();
  for (const Key& key : format.keys) {
    properties[key.name] = key_schema(key);
    if (key.is_required && !key.only) required.push_back(key.name);
  }
  Json schema{{"type", "object"},
              {"description", format.doc},
              {"properties", properties},
              {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = required;
  Json rules = Json::array();
  add_rules(format, rules);
  if (!rules.empty()) schema["allOf"] = rules;
  return schema;
}

}  // namespace

Json case_schema() {
  Case scratch;
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Riven case"}};
  schema.update(table_schema(describe(scratch)));
  return schema;
}

}  // namespace riven
