#include "input/formula.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "input/formula_text.hpp"

namespace riven {
namespace {

// Columns count characters, and UTF-8 holds some in several bytes.
int characters(std::string_view text) {
  int count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1 : 0;
  return count;
}

// What the formula depends on besides units: lengths x, y, z and the time t may count as quantities or as
// numbers
// ("sin(20*x) * 5 mm").
struct Reading {
  bool scale_position;
  bool scale_time;
};

// Points in all octants, at two distances; no coordinate repeats, so that nothing cancels by chance.
std::array<Variables, 16> samples() {
  std::array<Variables, 16> points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double n = static_cast<double>(i);
    const double size = i < 8 ? 0.7 : 0.003;
    points[i].position = {((i & 1U) != 0U ? -size : size) * (1 + 0.011 * n),
                          ((i & 2U) != 0U ? -size : size) * (0.83 + 0.017 * n),
                          ((i & 4U) != 0U ? -size : size) * (0.61 + 0.013 * n)};
    points[i].t = size * (0.31 + 0.019 * n);
    points[i].stretch = 1.1 + 0.07 * n;
  }
  return points;
}

// Where results tell nothing (all are zero), any power will do.
struct Powers {
  std::array<std::optional<double>, 4> of{};  // metre, second, kilogram, kelvin

  [[nodiscard]] bool agree_with(const Dimension& d) const {
    const std::array<int, 4> wanted{d.metre, d.second, d.kilogram, d.kelvin};
    for (std::size_t i = 0; i < 4; ++i)
      if (of[i] && std::abs(*of[i] - wanted[i]) > 1e-9) return false;
    return true;
  }

  [[nodiscard]] std::optional<Dimension> whole() const {
    std::array<int, 4> power{};
    for (std::size_t i = 0; i < 4; ++i) {
      const double p = of[i].value_or(0);
      power[i] = static_cast<int>(std::lround(p));
      if (std::abs(p - power[i]) > 1e-9) return std::nullopt;
    }
    return Dimension{.metre = power[0], .second = power[1], .kilogram = power[2], .kelvin = power[3]};
  }
};

constexpr std::array scale_members{&UnitScale::metre, &UnitScale::second, &UnitScale::kilogram,
                                   &UnitScale::kelvin};

// The power with which the result follows one base unit; false if there is none, as for "2 MPa + 3 mm".
bool follow(const FormulaText& formula, const Expression& plain, const Reading& reading, std::size_t base,
            std::optional<double>& power) {
  // Powers of two round nothing, and large ones let no small term hide behind a large one.
  for (const double log2_scale : {40.0, -40.0}) {
    UnitScale scale;
    scale.*scale_members[base] = std::exp2(log2_scale);
    const Expression scaled(formula.written(), formula.si(scale), plain.location(),
                            formula.data(scale, true));
    for (const Variables& sample : samples()) {
      Variables moved = sample;
      if (reading.scale_position)
        for (double& x : moved.position) x *= scale.metre;
      if (reading.scale_time) moved.t *= scale.second;
      const double before = plain(sample);
      const double after = scaled(moved);
      if ((before == 0 && after == 0) || (!std::isfinite(before) && !std::isfinite(after))) continue;
      const double found = std::log2(after / before) / log2_scale;
      if (!std::isfinite(found) || std::abs(power.value_or(found) - found) > 1e-9) return false;
      power = found;
    }
  }
  return true;
}

std::optional<Powers> find_powers(const FormulaText& formula, const Expression& plain,
                                  const Reading& reading) {
  Powers powers;
  for (std::size_t base = 0; base < 4; ++base)
    if (!follow(formula, plain, reading, base, powers.of[base])) return std::nullopt;
  return powers;
}

Expression compile(const FormulaText& formula, const Origin& origin) {
  Location at = origin.at;
  try {
    return {formula.written(), formula.si(), at, formula.data({}, false)};
  } catch (const InputError& error) {
    const std::string message = error.what();
    const std::size_t place = at.file.empty() ? 0 : at.text().size() + 2;
    origin.fail(fmt::format("\"{}\": {}", formula.written(), message.substr(place)));
  }
}

// What checks evaluate at places and times where tables and fields may have no value, or only zeros.
Expression for_checks(const FormulaText& formula, const Expression& expression) {
  if (!formula.needs_data()) return expression;
  return {formula.written(), formula.si(), expression.location(), formula.data({}, true)};
}

void check_finite_somewhere(const Expression& value, const Origin& origin) {
  for (const Variables& sample : samples())
    if (std::isfinite(value(sample))) return;
  origin.fail(fmt::format("\"{}\" gives no finite number; expected one", value.written()));
}

void check_dimension(const FormulaText& formula, const Expression& plain, const Dimension& wanted,
                     const Origin& origin) {
  std::optional<Dimension> found;
  for (const Reading& reading :
       {Reading{true, true}, Reading{false, true}, Reading{true, false}, Reading{false, false}}) {
    const std::optional<Powers> powers = find_powers(formula, plain, reading);
    if (!powers) continue;
    if (powers->agree_with(wanted)) return;
    const std::optional<Dimension> whole = powers->whole();
    // "x*sin(20*x)" is no plain number just because it is one when x is.
    if (!found && (reading.scale_position || whole != dimension::none)) found = whole;
  }
  const std::string& text = formula.written();
  if (!found)
    origin.fail(
        fmt::format("\"{}\" joins quantities that do not fit together, such as a length and a pressure, or a "
                    "number without a unit; expected {}{}",
                    text, named(wanted), formula.what_tables_take()));
  if (*found == dimension::none) origin.fail(needs_unit(text, wanted) + formula.what_tables_take());
  const std::string example =
      wanted == dimension::none ? "" : fmt::format(", such as \"10 {}\"", usual_unit(wanted));
  origin.fail(fmt::format("\"{}\" is {} ({}); expected {}{}{}", text, named(*found), si_unit(*found),
                          named(wanted), example, formula.what_tables_take()));
}

}  // namespace

void Origin::fail(const std::string& message) const {
  // The place of an override names the key already.
  throw InputError(at, key.empty() || at.file.ends_with(" " + key) ? message : key + ": " + message);
}

void Origin::fail(std::string_view text, std::size_t offset, const std::string& message) const {
  const std::string quoted = fmt::format("\"{}\": {}", text, message);
  if (text_column == 0 || at.line == 0) fail(quoted);
  Origin exact = *this;
  exact.at.column = text_column + characters(text.substr(0, offset));
  exact.fail(quoted);
}

Expression parse_formula(const std::string& text, const Dimension& dimension, const Symbols& symbols,
                         const Origin& origin) {
  const FormulaText formula(text, symbols, origin);
  Expression expression = compile(formula, origin);
  if (!formula.needs_data()) check_finite_somewhere(expression, origin);
  check_dimension(formula, for_checks(formula, expression), dimension, origin);
  return expression;
}

Expression parse_condition(const std::string& text, const Symbols& symbols, const Origin& origin) {
  const FormulaText formula(text, symbols, origin);
  Expression expression = compile(formula, origin);
  const Expression trial = for_checks(formula, expression);
  for (const Variables& sample : samples()) {
    const double value = trial(sample);
    if (value != 0 && value != 1)
      origin.fail(fmt::format(
          "\"{}\" is {} somewhere; expected true or false, such as \"abs(y) > 20 mm - dx\"", text, value));
  }
  // Here x, y and z are lengths for certain: "x > 20" is a forgotten unit.
  const std::optional<Powers> powers = find_powers(formula, trial, {true, true});
  if (!powers || !powers->agree_with(dimension::none))
    origin.fail(fmt::format(
        "\"{}\" compares quantities that do not fit together; x, y and z are lengths: write \"x > 20 mm\"{}",
        text, formula.what_tables_take()));
  return expression;
}

Quantity parse_quantity(const std::string& text, const Symbols& symbols, const Origin& origin) {
  const FormulaText formula(text, symbols, origin);
  const Expression value = compile(formula, origin);
  if (!formula.needs_data()) check_finite_somewhere(value, origin);
  const std::optional<Powers> powers = find_powers(formula, for_checks(formula, value), {true, true});
  const std::optional<Dimension> found = powers ? powers->whole() : std::nullopt;
  if (!found) origin.fail(fmt::format("\"{}\" joins quantities that do not fit together", text));
  return {value(Variables{}), *found};
}

double parse_quantity(const std::string& text, const Dimension& dimension, const Symbols& symbols,
                      const Origin& origin) {
  return parse_formula(text, dimension, symbols, origin)(Variables{});
}

std::string needs_unit(const std::string& number, const Dimension& dimension) {
  const bool plain = number.find_first_not_of("0123456789.eE+-") == std::string::npos;
  return fmt::format("{} has no unit; write \"{} {}\" ({})", number, plain ? number : "10",
                     usual_unit(dimension), named(dimension));
}

}  // namespace riven
