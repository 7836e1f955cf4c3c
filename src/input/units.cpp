#include "input/units.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace riven {
namespace {

struct Word {
  std::string_view name;     // as users write it
  std::string_view udunits;  // what UDUNITS reads: its own short names for some of these mean something else
};

constexpr std::array words = std::to_array<Word>({
    {"m", "m"},     {"mm", "mm"},   {"cm", "cm"},      {"um", "um"},          {"µm", "um"},
    {"nm", "nm"},   {"km", "km"},   {"s", "s"},        {"ms", "ms"},          {"us", "us"},
    {"µs", "us"},   {"ns", "ns"},   {"min", "minute"}, {"kg", "kg"},          {"g", "gram"},
    {"mg", "mg"},   {"N", "N"},     {"mN", "mN"},      {"kN", "kN"},          {"MN", "MN"},
    {"Pa", "Pa"},   {"kPa", "kPa"}, {"MPa", "MPa"},    {"GPa", "GPa"},        {"J", "J"},
    {"mJ", "mJ"},   {"kJ", "kJ"},   {"W", "W"},        {"Hz", "Hz"},          {"kHz", "kHz"},
    {"MHz", "MHz"}, {"K", "K"},     {"rad", "radian"}, {"deg", "arc_degree"}, {"%", "percent"},
});

const Word* find_word(std::string_view name) {
  const auto* const word =
      std::find_if(words.begin(), words.end(), [&](const Word& w) { return w.name == name; });
  return word == words.end() ? nullptr : word;
}

using System = std::unique_ptr<ut_system, decltype(&ut_free_system)>;
using Parsed = std::unique_ptr<ut_unit, decltype(&ut_free)>;

ut_system* unit_system() {
  static const System system = [] {
    ut_set_error_message_handler(ut_ignore);
    return System(ut_read_xml(nullptr), &ut_free_system);
  }();
  if (!system)
    throw std::runtime_error("the database of units (UDUNITS-2) cannot be read; is libudunits2-data there?");
  return system.get();
}

ut_status add_base(const ut_unit* base, int power, Unit& unit) {
  const char* symbol = ut_get_symbol(base, UT_ASCII);
  const std::string_view name = symbol == nullptr ? "" : symbol;
  if (name == "m")
    unit.dimension.metre += power;
  else if (name == "s")
    unit.dimension.second += power;
  else if (name == "kg")
    unit.dimension.kilogram += power;
  else if (name == "K")
    unit.dimension.kelvin += power;
  else if (ut_is_dimensionless(base) == 0)
    return UT_MEANINGLESS;
  return UT_SUCCESS;
}

ut_status visit_basic(const ut_unit* unit, void* to) {
  return add_base(unit, 1, *static_cast<Unit*>(to));
}

ut_status visit_product(const ut_unit*, int count, const ut_unit* const* bases, const int* powers, void* to) {
  for (int i = 0; i < count; ++i) {
    const ut_status status = add_base(bases[i], powers[i], *static_cast<Unit*>(to));
    if (status != UT_SUCCESS) return status;
  }
  return UT_SUCCESS;
}

ut_status accept(const ut_unit* unit, Unit& to);

ut_status visit_galilean(const ut_unit*, double scale, const ut_unit* under, double, void* to) {
  static_cast<Unit*>(to)->factor *= scale;
  return accept(under, *static_cast<Unit*>(to));
}

ut_status visit_timestamp(const ut_unit*, const ut_unit*, double, void*) {
  return UT_MEANINGLESS;
}
ut_status visit_logarithmic(const ut_unit*, double, const ut_unit*, void*) {
  return UT_MEANINGLESS;
}

ut_status accept(const ut_unit* unit, Unit& to) {
  static const ut_visitor visitor{visit_basic, visit_product, visit_galilean, visit_timestamp,
                                  visit_logarithmic};
  return ut_accept_visitor(unit, &visitor, &to);
}

Unit from_udunits(const std::string& text) {
  const Parsed parsed(ut_parse(unit_system(), text.c_str(), UT_ASCII), &ut_free);
  Unit unit;
  if (!parsed || accept(parsed.get(), unit) != UT_SUCCESS)
    throw std::runtime_error("UDUNITS-2 does not know \"" + text + "\"");
  return unit;
}

std::size_t skip_spaces(std::string_view text, std::size_t i) {
  while (i < text.size() && text[i] == ' ') ++i;
  return i;
}

// Reads "^3" or "^-3" at `i`, moving it on; 1 when there is none.
int read_power(std::string_view text, std::size_t& i) {
  const std::size_t caret = skip_spaces(text, i);
  if (caret >= text.size() || text[caret] != '^') return 1;
  const std::size_t digits = skip_spaces(text, caret + 1);
  int power = 0;
  const auto [end, error] = std::from_chars(text.data() + digits, text.data() + text.size(), power);
  i = static_cast<std::size_t>(end - text.data());
  if (error != std::errc{} || std::abs(power) > 9 || (i < text.size() && text[i] == '.'))
    throw std::invalid_argument("the power of a unit must be a whole number such as m^2 or s^-1");
  return power;
}

// The known unit word at `i`; none if it is the name of a function, as in 1/min(x, y).
const Word* word_at(std::string_view text, std::size_t i) {
  const std::string_view name = unit_word(text, i);
  const std::size_t next = skip_spaces(text, i + name.size());
  if (name.empty() || (next < text.size() && text[next] == '(')) return nullptr;
  return find_word(name);
}

struct NamedDimension {
  Dimension dimension;
  std::string_view name;
  std::string_view si;
  std::string_view usual;
};

constexpr std::array named_dimensions = std::to_array<NamedDimension>({
    {dimension::none, "a number", "1", ""},
    {dimension::length, "a length", "m", "mm"},
    {dimension::area, "an area", "m^2", "mm^2"},
    {dimension::time, "a time", "s", "ms"},
    {dimension::density, "a density", "kg/m^3", "kg/m^3"},
    {dimension::pressure, "a pressure", "Pa", "MPa"},
    {{.kilogram = 1}, "a mass", "kg", "kg"},
    {{.kelvin = 1}, "a temperature", "K", "K"},
    {{.second = -1}, "a rate", "1/s", "/s"},
    {dimension::velocity, "a velocity", "m/s", "m/s"},
    {{.metre = 1, .second = -2, .kilogram = 1}, "a force", "N", "N"},
    {{.metre = 2, .second = -2, .kilogram = 1}, "an energy", "J", "J"},
    {{.metre = 2, .second = -3, .kilogram = 1}, "a power", "W", "W"},
    {{.second = -2, .kilogram = 1}, "an energy per area", "J/m^2", "J/m^2"},
});

const NamedDimension* find_named(const Dimension& dimension) {
  const auto* const found = std::find_if(named_dimensions.begin(), named_dimensions.end(),
                                         [&](const NamedDimension& n) { return n.dimension == dimension; });
  return found == named_dimensions.end() ? nullptr : found;
}

}  // namespace

const std::vector<std::string>& unit_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Word& word : words) list.emplace_back(word.name);
    return list;
  }();
  return names;
}

std::string_view unit_word(std::string_view text, std::size_t position) {
  constexpr std::string_view micro = "µ";
  std::size_t end = position;
  if (end < text.size() && text[end] == '%') return text.substr(position, 1);
  if (text.substr(end).starts_with(micro)) end += micro.size();
  if (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) return {};
  while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_'))
    ++end;
  return text.substr(position, end - position);
}

bool is_unit(std::string_view word) {
  return find_word(word) != nullptr;
}

std::optional<UnitMatch> match_unit(std::string_view text, std::size_t position) {
  std::string udunits;
  std::size_t end = position;
  const auto take = [&](const Word* word, std::size_t at, int sign) {
    end = at + word->name.size();
    const int power = sign * read_power(text, end);
    udunits += fmt::format("{}{}^{}", udunits.empty() ? "" : ".", word->udunits, power);
  };
  if (const Word* word = word_at(text, position)) take(word, position, 1);
  while (true) {
    const std::size_t sign = skip_spaces(text, end);
    if (sign >= text.size() || (text[sign] != '/' && (text[sign] != '*' || udunits.empty()))) break;
    const std::size_t next = skip_spaces(text, sign + 1);
    const Word* word = word_at(text, next);
    if (word == nullptr) break;
    take(word, next, text[sign] == '/' ? -1 : 1);
  }
  if (udunits.empty()) return std::nullopt;
  return UnitMatch{from_udunits(udunits), end - position};
}

double to_si(double number, const Unit& unit) {
  // 43 us is 43 / 1e6, not 43 * 1e-6, which rounds twice.
  const double inverse = std::round(1 / unit.factor);
  if (unit.factor < 1 && std::abs(inverse * unit.factor - 1) < 1e-14) return number / inverse;
  return number * unit.factor;
}

std::string si_unit(const Dimension& dimension) {
  if (const NamedDimension* found = find_named(dimension)) return std::string(found->si);
  std::string above, below;
  const auto add = [&](std::string_view name, int power) {
    const std::string factor =
        std::abs(power) > 1 ? fmt::format("{}^{}", name, std::abs(power)) : std::string(name);
    if (power > 0) above += fmt::format("{}{}", above.empty() ? "" : "*", factor);
    if (power < 0) below += fmt::format("/{}", factor);
  };
  add("kg", dimension.kilogram);
  add("m", dimension.metre);
  add("s", dimension.second);
  add("K", dimension.kelvin);
  return (above.empty() ? "1" : above) + below;
}

std::string named(const Dimension& dimension) {
  const NamedDimension* found = find_named(dimension);
  return found != nullptr ? std::string(found->name) : "a quantity in " + si_unit(dimension);
}

std::string usual_unit(const Dimension& dimension) {
  const NamedDimension* found = find_named(dimension);
  if (found != nullptr) return std::string(found->usual);
  const std::string unit = si_unit(dimension);
  return unit.starts_with("1/") ? unit.substr(1) : unit;  // "2 /s^2", not "2 1/s^2"
}

}  // namespace riven
