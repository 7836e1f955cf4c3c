#include <fmt/format.h>

#include <cmath>

#include "base/nearest_name.hpp"
#include "input/format.hpp"
#include "input/schema.hpp"

namespace riven {
namespace {

std::string code_list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += fmt::format("{}`\"{}\"`", text.empty() ? "" : ", ", name);
  return text;
}

std::string range_text(const Range& range, const Dimension& dimension) {
  const std::string unit = dimension == dimension::none ? "" : fmt::format(" {}", si_unit(dimension));
  std::string text;
  if (std::isfinite(range.low))
    text += fmt::format(", {} {:g}{}", range.above_low ? "above" : "at least", range.low, unit);
  if (std::isfinite(range.high))
    text += fmt::format(", {} {:g}{}", range.below_high ? "below" : "at most", range.high, unit);
  return text;
}

std::string quantity_text(const Dimension& dimension, const Range& range) {
  const std::string unit =
      dimension == dimension::none ? "" : fmt::format(" such as `\"10 {}\"`", usual_unit(dimension));
  return fmt::format("{}{}{}", named(dimension), unit, range_text(range, dimension));
}

struct ValueText {
  std::string operator()(const kind::Text& k) const { return k.among.empty() ? "text" : code_list(k.among); }
  std::string operator()(const kind::Texts& k) const {
    return k.among.empty() ? "list of texts" : fmt::format("list of {}", code_list(k.among));
  }
  std::string operator()(const kind::Flag&) const { return "true or false"; }
  std::string operator()(const kind::Integer& k) const {
    return fmt::format("whole number, at least {}", k.low);
  }
  std::string operator()(const kind::Integers& k) const {
    return fmt::format("list of whole numbers, at least {}", k.low);
  }
  std::string operator()(const kind::Quantity& k) const { return quantity_text(k.dimension, k.range); }
  std::string operator()(const kind::Quantities& k) const {
    return fmt::format("list, each {}", quantity_text(k.dimension, k.range));
  }
  std::string operator()(const kind::AnyUnit&) const { return "number, with its unit"; }
  std::string operator()(const kind::Place& k) const {
    return fmt::format("list, per direction {}", quantity_text(dimension::length, k.range));
  }
  std::string operator()(const kind::Places& k) const {
    return fmt::format("list of {} or more places, each a list as `[\"1 mm\", \"2 mm\"]`", k.least);
  }
  std::string operator()(const kind::Condition&) const { return "formula, true or false"; }
  std::string operator()(const kind::Formula&) const { return "formula"; }
  std::string operator()(const kind::Components&) const {
    return "list, per direction a formula or `\"free\"`";
  }
  std::string operator()(const kind::Interval&) const {
    return "`\"5 min\"`, `\"1000 steps\"` or `\"never\"`";
  }
  std::string operator()(const kind::Part&) const { return "name"; }
  std::string operator()(const kind::Parts&) const { return "name or list of names"; }
  std::string operator()(const kind::Table&) const { return "table"; }
  std::string operator()(const kind::Tables&) const { return "array of tables"; }
  std::string operator()(const kind::NamedTables&) const { return "named tables"; }
};

std::string default_text(const Key& key) {
  if (key.fallback) return fmt::format("`{}`", *key.fallback);
  if (key.is_required) return "required";
  if (key.required_when) return fmt::format("required with `{}`", key.required_when->text());
  return "";
}

std::string heading(const std::string& path, const Kind& kind) {
  if (std::holds_alternative<kind::Tables>(kind)) return fmt::format("[[{}]]", path);
  if (std::holds_alternative<kind::NamedTables>(kind)) return fmt::format("[{}.NAME]", path);
  return fmt::format("[{}]", path);
}

void write_section(const Format& format, const std::string& title, const std::string& path,
                   std::string& page) {
  page += fmt::format("\n## `{}`\n\n{}\n\n| key | value | default | meaning |\n|---|---|---|---|\n", title,
                      format.doc);
  for (const Key& key : format.keys) {
    const std::string only = key.only ? fmt::format(" Only with `{}`.", key.only->text()) : "";
    page += fmt::format("| `{}` | {} | {} | {}{} |\n", key.name, std::visit(ValueText{}, key.kind),
                        default_text(key), key.doc, only);
  }
  for (const Group& group : format.groups)
    page += fmt::format("\n{} one of `{}`{}.\n", group.needed ? "Exactly" : "At most", listed(group.keys),
                        group.only ? fmt::format(" with `{}`", group.only->text()) : "");
  for (const Key& key : format.keys) {
    const std::string here = path.empty() ? key.name : path + "." + key.name;
    if (const auto* table = std::get_if<kind::Table>(&key.kind))
      write_section(table->open(), heading(here, key.kind), here, page);
    if (const auto* tables = std::get_if<kind::Tables>(&key.kind))
      write_section(tables->open(0), heading(here, key.kind), here, page);
    if (const auto* named_ones = std::get_if<kind::NamedTables>(&key.kind)) {
      named_ones->name(0);
      write_section(named_ones->open(0), heading(here, key.kind), here + ".NAME", page);
    }
  }
}

}  // namespace

std::string reference_page() {
  Case scratch;
  std::string page = fmt::format(
      "# Case files: reference\n\nWritten by `riven schema --markdown`; do not edit.\n\n"
      "A number with a dimension is a string with its unit: `\"5 mm\"`, `\"20 mm - dx\"`. Units: {}; "
      "compounds such as `kg/m^3`. "
      "`dx` is the spacing and `horizon` the horizon, as soon as `[geometry]` has given them.\n",
      listed(unit_names()));
  write_section(describe(scratch), "top of the file", "", page);
  return page;
}

}  // namespace riven
