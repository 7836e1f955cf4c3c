#include "input/formula_text.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "base/nearest_name.hpp"

namespace riven {
namespace {

bool digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

const std::vector<std::string>& function_names() {
  static const std::vector<std::string> names = [] {
    const mu::Parser parser;
    std::vector<std::string> list;
    for (const auto& [name, function] : parser.GetFunDef()) list.push_back(name);
    return list;
  }();
  return names;
}

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

double UnitScale::of(const Dimension& d) const {
  return std::pow(metre, d.metre) * std::pow(second, d.second) * std::pow(kilogram, d.kilogram) *
         std::pow(kelvin, d.kelvin);
}

FormulaText::FormulaText(const std::string& text, const Symbols& symbols, const Origin& origin)
    : text_(text), symbols_(symbols), origin_(origin) {
  if (after_spaces(0) == text_.size()) origin_.fail("empty; expected a formula or a number with its unit");
  scan();
}

std::string FormulaText::si(const UnitScale& scale) const {
  std::string formula;
  for (const Piece& piece : pieces_)
    formula += piece.quantity
                   ? fmt::format("({:.17g})", piece.quantity->si * scale.of(piece.quantity->dimension))
                   : piece.text;
  return formula;
}

FormulaData FormulaText::data(const UnitScale& scale, bool stand_in) const {
  FormulaData data;
  for (const auto& table : tables_)
    data.tables.push_back(
        {table, scale.of(table->argument().dimension), scale.of(table->value().dimension), stand_in});
  for (const auto& field : fields_)
    data.fields.push_back({field, scale.of(field->value().dimension), stand_in});
  return data;
}

std::string FormulaText::what_tables_take() const {
  std::string text;
  for (const auto& table : tables_)
    text += fmt::format("; the table {} takes {} (\"{}\") and gives {} (\"{}\")", table->name(),
                        named(table->argument().dimension), table->argument().name,
                        named(table->value().dimension), table->value().name);
  for (const auto& field : fields_)
    text += fmt::format("; the field {} gives {} (\"{}\")", field->name(), named(field->value().dimension),
                        field->value().name);
  return text;
}

void FormulaText::scan() {
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (digit(c) || (c == '.' && digit(character(position_ + 1)))) {
      scan_number();
    } else if (!unit_word(text_, position_).empty()) {
      scan_name();
    } else {
      scan_sign();
    }
  }
}

void FormulaText::scan_number() {
  const std::size_t start = position_;
  double number = 0;
  const auto [end, error] = std::from_chars(text_.data() + start, text_.data() + text_.size(), number);
  if (error != std::errc{} || !std::isfinite(number))
    fail(start, "this number is too large or too small to be held");
  position_ = static_cast<std::size_t>(end - text_.data());
  const std::string digits = text_.substr(start, position_ - start);
  const std::size_t next = after_spaces(position_);
  try {
    if (const auto match = match_unit(text_, next)) {
      position_ = next + match->length;
      add({to_si(number, match->unit), match->unit.dimension});
      return;
    }
    check_one_number(digits, next);
  } catch (const std::invalid_argument& wrong) {
    fail(next, wrong.what());
  }
  const std::string_view name = unit_word(text_, next);
  if (name.empty()) {
    pieces_.push_back({digits, {}});
  } else if (const auto length = length_name(name)) {
    position_ = next + name.size();
    check_not_a_power(name);
    add({number * *length, dimension::length});
  } else {
    check_product(number, next);
  }
}

// A name stands after a number and is no unit.
void FormulaText::check_product(double number, std::size_t at) {
  const std::string name(unit_word(text_, at));
  if (contains(symbols_.variables, name) || contains(function_names(), name) || name == "pi" ||
      contains(table_names(), name) || contains(field_names(), name))
    fail(at, fmt::format("a product needs its sign: write \"{}*{}\"", number, name));
  if (name == "dx" || name == "horizon") fail_unknown(name, at);
  fail(at, fmt::format("unknown unit \"{}\"; units are {}{}", name, listed(unit_names()),
                       did_you_mean(name, unit_names())));
}

// "20 1/s": units that begin with a number are written so elsewhere.
void FormulaText::check_one_number(const std::string& digits, std::size_t at) const {
  if (!digit(character(at)) && character(at) != '.') return;
  const std::size_t slash = after_spaces(at + 1);
  if (character(at) == '1' && character(slash) == '/') {
    if (const auto match = match_unit(text_, slash)) {
      const std::string unit = text_.substr(slash, match->length);
      const std::string under = unit.substr(1);
      fail(at, fmt::format("a unit does not begin with a number; write \"{} {}\"{}", digits, unit,
                           is_unit(under) ? fmt::format(" or \"{} {}^-1\"", digits, under) : ""));
    }
  }
  fail(at, "two numbers stand side by side; expected a sign such as + or * between them");
}

// "3 dx^2" could be read in two ways.
void FormulaText::check_not_a_power(std::string_view name) {
  if (character(after_spaces(position_)) == '^')
    fail(position_, fmt::format("write \"3*{0}^2\" or \"(3 {0})^2\" to say what the power belongs to", name));
}

void FormulaText::scan_name() {
  const std::string_view name = unit_word(text_, position_);
  const std::size_t start = position_;
  position_ += name.size();
  if (const auto length = length_name(name)) return add({*length, dimension::length});
  const bool called = character(after_spaces(position_)) == '(';
  const bool known = called ? contains(function_names(), name) || call_table(name)
                            : name == "pi" || contains(symbols_.variables, name) || use_field(name);
  if (!known) fail_unknown(name, start);
  if (called) position_ = after_spaces(position_);  // muParser allows no blank before the bracket
  pieces_.push_back({std::string(name), {}});
}

bool FormulaText::call_table(std::string_view name) {
  const auto found = std::find_if(symbols_.tables.begin(), symbols_.tables.end(),
                                  [&](const auto& table) { return table->name() == name; });
  if (found == symbols_.tables.end()) return false;
  if (std::find(tables_.begin(), tables_.end(), *found) == tables_.end()) tables_.push_back(*found);
  return true;
}

bool FormulaText::use_field(std::string_view name) {
  if (!contains(symbols_.variables, "x")) return false;  // it has values at places alone
  const auto found = std::find_if(symbols_.fields.begin(), symbols_.fields.end(),
                                  [&](const auto& field) { return field->name() == name; });
  if (found == symbols_.fields.end()) return false;
  if (std::find(fields_.begin(), fields_.end(), *found) == fields_.end()) fields_.push_back(*found);
  return true;
}

std::vector<std::string> FormulaText::table_names() const {
  std::vector<std::string> names;
  for (const auto& table : symbols_.tables) names.push_back(table->name());
  return names;
}

std::vector<std::string> FormulaText::field_names() const {
  std::vector<std::string> names;
  for (const auto& field : symbols_.fields) names.push_back(field->name());
  return names;
}

// Everything else goes to muParser as it is, except an assignment: it would change a variable.
void FormulaText::scan_sign() {
  const std::string_view rest = std::string_view(text_).substr(position_);
  for (const std::string_view pair : {"==", "!=", "<=", ">="}) {
    if (!rest.starts_with(pair)) continue;
    pieces_.push_back({std::string(pair), {}});
    position_ += pair.size();
    return;
  }
  if (rest[0] == '=') fail(position_, "\"=\" does not compare; write \"==\", \"<\" or \">\"");
  if (rest[0] == '"') fail(position_, "a formula cannot hold a string");
  pieces_.push_back({std::string(1, rest[0]), {}});
  ++position_;
}

std::string meaning_in_formulas(const std::string& name) {
  if (name == "x" || name == "y" || name == "z" || name == "t" || name == "stretch") return "a variable";
  if (name == "dx" || name == "horizon") return "a length";
  if (name == "pi") return "a number";
  if (contains(function_names(), name)) return "a function";
  return is_unit(name) ? "a unit" : "";
}

std::optional<double> FormulaText::length_name(std::string_view name) const {
  if (name == "dx") return symbols_.dx;
  if (name == "horizon") return symbols_.horizon;
  return std::nullopt;
}

std::size_t FormulaText::after_spaces(std::size_t i) const {
  while (i < text_.size() && std::isspace(static_cast<unsigned char>(text_[i])) != 0) ++i;
  return i;
}

void FormulaText::fail_unknown(std::string_view name, std::size_t at) const {
  if (name == "dx") fail(at, "\"dx\" is known only after [geometry] has given the spacing");
  if (name == "horizon") fail(at, "\"horizon\" is known only after [geometry]");
  if (is_unit(name)) fail(at, fmt::format("the unit \"{0}\" must follow a number, as in \"1 {0}\"", name));
  if (name == "t" || name == "stretch" || name == "x" || name == "y" || name == "z") {
    const std::string known =
        symbols_.variables.empty() ? "expected a constant" : "known are " + listed(symbols_.variables);
    fail(at, fmt::format("\"{}\" is not known here; {}", name, known));
  }
  const std::vector<std::string> tables = table_names();
  if (contains(tables, name))
    fail(at, fmt::format("\"{0}\" is a table; write its argument in brackets, as in \"{0}({1})\"", name,
                         symbols_.variables.empty() ? "2" : symbols_.variables.back()));
  const std::vector<std::string> fields = field_names();
  if (contains(fields, name))
    fail(at,
         fmt::format("\"{0}\" is a field; formulas that know x, y, z read it by its name alone, \"{0}\", at "
                     "their place",
                     name));
  std::vector<std::string> known = symbols_.variables;
  known.emplace_back("pi");
  if (symbols_.dx) known.emplace_back("dx");
  if (symbols_.horizon) known.emplace_back("horizon");
  for (const std::string& table : tables) known.push_back(table + "(...)");
  if (contains(known, "x")) known.insert(known.end(), fields.begin(), fields.end());
  const std::string shown = listed(known);
  known.insert(known.end(), tables.begin(), tables.end());
  known.insert(known.end(), function_names().begin(), function_names().end());
  known.insert(known.end(), unit_names().begin(), unit_names().end());
  fail(at,
       fmt::format(
           "unknown name \"{}\"; known are {}, units after a number, and functions such as abs, sin, sqrt{}",
           name, shown, did_you_mean(name, known)));
}

}  // namespace riven
