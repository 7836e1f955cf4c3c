#include "report/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace riven {

namespace {

/// 1, 2 or 5 times a power of ten.
struct Step {
  int digit = 1, power = 0;

  /// Multiple n; one operation on whole numbers and a power of ten, so that it is the number nearest to what
  /// is meant.
  [[nodiscard]] double times(double n) const {
    const double scale = std::pow(10, std::abs(power));
    return power < 0 ? n * digit / scale : n * digit * scale;
  }
  [[nodiscard]] Step smaller() const {
    return digit == 1 ? Step{5, power - 1} : Step{digit == 5 ? 2 : 1, power};
  }
};

std::vector<double> multiples(const Range& range, const Step& step) {
  constexpr double kSlack = 1e-9;  // ends that are ticks but for rounding
  const double first = std::ceil(range.low / step.times(1) - kSlack);
  const double last = std::floor(range.high / step.times(1) + kSlack);
  std::vector<double> all;
  for (int n = 0; first + n <= last; ++n) all.push_back(step.times(first + n));
  return all;
}

std::string superscript(std::string_view digits) {
  static constexpr std::array<std::string_view, 10> kRaised = {"⁰", "¹", "²", "³", "⁴",
                                                               "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string raised;
  for (const char c : digits) raised += c == '-' ? "⁻" : kRaised[static_cast<std::size_t>(c - '0')];
  return raised;
}

/// "kg/m^3" -> "kg/m³", "N*m" -> "N·m".
std::string typeset(const std::string& unit) {
  std::string text;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (unit[i] == '^') {
      const std::size_t end = std::min(unit.find_first_not_of("-0123456789", i + 1), unit.size());
      text += superscript(std::string_view(unit).substr(i + 1, end - i - 1));
      i = end - 1;
    } else {
      text += unit[i] == '*' ? "·" : std::string(1, unit[i]);
    }
  }
  return text;
}

/// Whether "kilo" before the unit means a thousand of it: not so for m^2, kg and 1/s.
bool takes_prefix(const std::string& unit) {
  const std::string first = unit.substr(0, unit.find_first_of("/*"));
  return !first.empty() && first != "1" && first != "kg" && first.find('^') == std::string::npos;
}

}  // namespace

void Range::include(double value) {
  if (!std::isfinite(value)) return;
  const bool first = empty();
  low = first ? value : std::min(low, value);
  high = first ? value : std::max(high, value);
}

void Range::include(const Range& other) {
  if (other.empty()) return;
  include(other.low);
  include(other.high);
}

std::vector<double> ticks(const Range& range, int most) {
  if (range.empty()) return {};
  // What is all but one value, or wider than any number, has no steps.
  constexpr double kNarrowest = 1e-290, kRounding = 1e-12;
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  if (!(range.width() > std::max(kNarrowest, kRounding * largest)) || !std::isfinite(range.width()))
    return {range.low};
  Step step{1, static_cast<int>(std::ceil(std::log10(range.width()))) + 1};
  while (multiples(range, step.smaller()).size() <= static_cast<std::size_t>(std::max(most, 2)))
    step = step.smaller();
  const std::vector<double> all = multiples(range, step);
  return all.size() > 1 ? all : multiples(range, step.smaller());
}

std::vector<std::string> tick_texts(const std::vector<double>& ticks) {
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 0;
  double largest = 0;
  for (const double tick : ticks) largest = std::max(largest, std::abs(tick));
  std::vector<std::string> texts;
  if (step == 0 || largest >= 1e6 || largest < 1e-4) {
    for (const double tick : ticks) texts.push_back(fmt::format("{:.6g}", tick));
    return texts;
  }
  constexpr double kSlack = 1e-6;  // steps are powers of ten but for rounding
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - kSlack)));
  for (const double tick : ticks) texts.push_back(fmt::format("{:.{}f}", tick + 0.0, decimals));
  return texts;
}

std::string ReadableUnit::label(const std::string& name) const {
  std::string text = name;
  std::replace(text.begin(), text.end(), '_', ' ');
  if (name.empty() || unit.empty()) return name.empty() ? unit : text;
  return fmt::format("{} [{}]", text, unit);
}

ReadableUnit readable_unit(const std::string& unit, double largest) {
  const std::string plain = unit == "1" ? "" : unit;
  if (!(largest > 0) || !std::isfinite(largest)) return {1, typeset(plain)};
  constexpr double kRounding = 1e-12;  // 1000 m that are 999.9999999999999 m are a kilometre
  const int thousands = static_cast<int>(std::floor(std::log10(largest * (1 + kRounding)) / 3));
  if (takes_prefix(plain)) {
    static constexpr std::array<std::string_view, 10> kPrefixes = {"p", "n", "µ", "m", "",
                                                                   "k", "M", "G", "T", "P"};
    constexpr int kNone = 4;
    const int chosen = std::clamp(thousands + kNone, 0, static_cast<int>(kPrefixes.size()) - 1);
    return {std::pow(10, -3 * (chosen - kNone)),
            typeset(std::string(kPrefixes[static_cast<std::size_t>(chosen)]) + plain)};
  }
  if (largest >= 1e-3 && largest < 1e4) return {1, typeset(plain)};  // read as they are
  const std::string power = fmt::format("10{}", superscript(std::to_string(3 * thousands)));
  return {std::pow(10, -3 * thousands), plain.empty() ? power : fmt::format("{} {}", power, typeset(plain))};
}

std::string readable(double value, const std::string& unit) {
  const ReadableUnit in = takes_prefix(unit) ? readable_unit(unit, std::abs(value)) : readable_unit(unit, 1);
  return fmt::format("{:.4g}{}{}", value * in.factor, in.unit.empty() ? "" : " ", in.unit);
}

std::pair<std::string, std::string> name_and_unit(const std::string& column) {
  const std::size_t bracket = column.ends_with(']') ? column.rfind(" [") : std::string::npos;
  if (bracket == std::string::npos) return {column, ""};
  return {column.substr(0, bracket), column.substr(bracket + 2, column.size() - bracket - 3)};
}

}  // namespace riven
