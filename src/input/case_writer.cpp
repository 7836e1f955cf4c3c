#include "input/case_writer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "input/format.hpp"

namespace riven {
namespace {

std::string toml_string(const std::string& text) {
  return nlohmann::json(text).dump();
}

std::string toml_key(const std::string& name) {
  const bool bare =
      name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-") ==
      std::string::npos;
  return bare && !name.empty() ? name : toml_string(name);
}

std::string with_unit(double si, const std::string& unit) {
  if (unit == "1") return fmt::format("{}", si);
  // A unit cannot begin with a number: "2 /s", not "2 1/s".
  return fmt::format("\"{} {}\"", si, unit.starts_with("1/") ? unit.substr(1) : unit);
}

template <class Items, class Write>
std::string list(const Items& items, Write write) {
  std::string text;
  for (const auto& item : items) text.append(text.empty() ? "" : ", ").append(write(item));
  return fmt::format("[{}]", text);
}

std::string inline_table(const Format& format, int dimension);

// A key's value as TOML; empty for a value that was not given. Overloads for each kind.
class ValueText {
 public:
  explicit ValueText(int dimension) : dimension_(dimension) {}

  std::string operator()(const kind::Text& k) const { return k.to->empty() ? "" : toml_string(*k.to); }
  std::string operator()(const kind::Texts& k) const { return list(*k.to, toml_string); }
  std::string operator()(const kind::Flag& k) const { return *k.to ? "true" : "false"; }
  std::string operator()(const kind::Integer& k) const { return fmt::format("{}", *k.to); }
  std::string operator()(const kind::Integers& k) const {
    return k.to->empty() ? "" : list(*k.to, [](int i) { return fmt::format("{}", i); });
  }
  std::string operator()(const kind::Quantity& k) const {
    const auto* maybe = std::get_if<std::optional<double>*>(&k.to);
    if (maybe != nullptr && !**maybe) return "";
    const double si = maybe != nullptr ? ***maybe : *std::get<double*>(k.to);
    // A density that static cases leave out stays 0.
    if (k.range.above_low && si <= k.range.low) return "";
    return with_unit(si, si_unit(k.dimension));
  }
  std::string operator()(const kind::Quantities& k) const {
    return k.to->empty() ? "" : list(*k.to, [&](double si) { return with_unit(si, si_unit(k.dimension)); });
  }
  std::string operator()(const kind::AnyUnit& k) const {
    return *k.to ? with_unit((*k.to)->si, (*k.to)->dimension) : "";
  }
  std::string operator()(const kind::Place& k) const {
    const auto* maybe = std::get_if<std::optional<Point>*>(&k.to);
    if (maybe != nullptr && !**maybe) return "";
    return place(maybe != nullptr ? ***maybe : *std::get<Point*>(k.to));
  }
  std::string operator()(const kind::Places& k) const {
    return k.to->empty() ? "" : list(*k.to, [&](const Point& p) { return place(p); });
  }
  std::string operator()(const kind::Condition& k) const {
    return *k.to ? toml_string((*k.to)->written()) : "";
  }
  std::string operator()(const kind::Formula& k) const {
    return *k.to ? toml_string((*k.to)->written()) : "";
  }
  std::string operator()(const kind::Components& k) const {
    return k.to->empty() ? "" : list(*k.to, [](const ComponentInput& c) {
      return c.value ? toml_string(c.value->written()) : toml_string("free");
    });
  }
  std::string operator()(const kind::Interval& k) const {
    if (k.to->steps > 0) return toml_string(fmt::format("{} steps", k.to->steps));
    return k.to->seconds > 0 ? with_unit(k.to->seconds, "s") : toml_string("never");
  }
  std::string operator()(const kind::Part& k) const {
    return k.to->text.empty() ? "" : toml_string(k.to->text);
  }
  std::string operator()(const kind::Parts& k) const {
    return k.to->empty() ? "" : list(*k.to, [](const Named& name) { return toml_string(name.text); });
  }
  std::string operator()(const kind::Table& k) const {
    return k.given() ? inline_table(k.open(), dimension_) : "";
  }
  // These stand under their own headers.
  std::string operator()(const kind::Tables&) const { return ""; }
  std::string operator()(const kind::NamedTables&) const { return ""; }

 private:
  [[nodiscard]] std::string place(const Point& p) const {
    const std::vector<double> used(p.begin(), p.begin() + dimension_);
    return list(used, [](double si) { return with_unit(si, "m"); });
  }

  int dimension_;
};

std::string inline_table(const Format& format, int dimension) {
  std::string text;
  for (const Key& key : format.keys) {
    const std::string value = key.applies_now() ? std::visit(ValueText(dimension), key.kind) : "";
    if (!value.empty()) text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key.name, value);
  }
  return fmt::format("{{ {} }}", text);
}

class CaseWriter {
 public:
  explicit CaseWriter(int dimension) : value_(dimension) {}

  std::string write(const Format& format) {
    write_keys(format, "");
    return std::move(text_);
  }

 private:
  void write_section(const std::string& header, const Format& format, const std::string& path) {
    text_ += fmt::format("\n{}\n", header);
    write_keys(format, path);
  }

  // Plain values first: what follows a header belongs to it.
  void write_keys(const Format& format, const std::string& path) {
    for (const Key& key : format.keys) {
      if (path.empty() && std::holds_alternative<kind::Table>(key.kind)) continue;
      const std::string value = key.applies_now() ? std::visit(value_, key.kind) : "";
      if (!value.empty()) text_ += fmt::format("{} = {}\n", key.name, value);
    }
    for (const Key& key : format.keys)
      write_sections(key, path.empty() ? key.name : path + "." + key.name, path.empty());
  }

  void write_sections(const Key& key, const std::string& path, bool top) {
    if (const auto* table = std::get_if<kind::Table>(&key.kind); table != nullptr && top && table->given())
      write_section(fmt::format("[{}]", path), table->open(), path);
    if (const auto* tables = std::get_if<kind::Tables>(&key.kind))
      for (std::size_t i = 0; i < tables->count(); ++i)
        write_section(fmt::format("[[{}]]", path), tables->open(i), path);
    if (const auto* named = std::get_if<kind::NamedTables>(&key.kind))
      for (std::size_t i = 0; i < named->count(); ++i) {
        const std::string here = fmt::format("{}.{}", path, toml_key(named->name(i)));
        write_section(fmt::format("[{}]", here), named->open(i), here);
      }
  }

  ValueText value_;
  std::string text_;
};

}  // namespace

std::string resolved_case(const Case& of) {
  Case copy = of;  // the format points at members that a reader may write
  return CaseWriter(of.geometry.dimension).write(describe(copy));
}

}  // namespace riven
