#pragma once

#include <string>
#include <utility>
#include <vector>

namespace riven {

/// Numbers of an axis or a colour bar as people read them: round ticks, and units with a prefix.

/// From the least to the greatest value; empty (low > high) as long as no value was taken in.
struct Range {
  double low = 1, high = -1;

  [[nodiscard]] bool empty() const { return low > high; }
  [[nodiscard]] double width() const { return high - low; }
  /// Takes in a value; what is not finite is left out.
  void include(double value);
  void include(const Range& other);
};

/// Multiples of 1, 2 or 5 times a power of ten within the range: `most` of them at most, but two at least,
/// unless the range is a single value.
std::vector<double> ticks(const Range& range, int most);

/// Ticks with as many decimals as tell them apart: "0.5", "1.0".
std::vector<std::string> tick_texts(const std::vector<double>& ticks);

/// A unit in which numbers of some size are short: value in SI times `factor` is a number of `unit`.
struct ReadableUnit {
  double factor = 1;
  std::string unit;  // "MJ/m³", "10⁻⁶" for numbers without a unit; empty for plain numbers

  /// `name [unit]`, or only the name. Underscores become blanks.
  [[nodiscard]] std::string label(const std::string& name) const;
};

/// For numbers up to `largest` in size of an SI unit as Riven writes it ("J/m^3", "" or "1" for none).
ReadableUnit readable_unit(const std::string& unit, double largest);

/// One number with its unit: "220.9 N", "12.5 MPa", "3".
std::string readable(double value, const std::string& unit);

/// Name and unit of a column or metric: "force_x [N]" -> force_x, N.
std::pair<std::string, std::string> name_and_unit(const std::string& column);

}  // namespace riven
