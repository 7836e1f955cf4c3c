#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace riven {

/// Exponents of the SI base units; angles and percentages have none.
struct Dimension {
  int metre = 0;
  int second = 0;
  int kilogram = 0;
  int kelvin = 0;

  bool operator==(const Dimension&) const = default;
};

namespace dimension {
inline constexpr Dimension none{};
inline constexpr Dimension length{.metre = 1};
inline constexpr Dimension area{.metre = 2};
inline constexpr Dimension time{.second = 1};
inline constexpr Dimension velocity{.metre = 1, .second = -1};
inline constexpr Dimension density{.metre = -3, .kilogram = 1};
inline constexpr Dimension surface_energy{.second = -2, .kilogram = 1};
inline constexpr Dimension pressure{.metre = -1, .second = -2, .kilogram = 1};
}  // namespace dimension

/// One unit in SI: `1 unit = factor` SI units of the dimension.
struct Unit {
  Dimension dimension;
  double factor = 1;
};

/// A unit found at some place of a text, and how many characters it takes.
struct UnitMatch {
  Unit unit;
  std::size_t length = 0;
};

/// The single units that case files may use: "mm", "MPa", ... Compounds join them by * and / and whole
/// powers.
const std::vector<std::string>& unit_names();

/// The unit name that starts at `position` of `text` (letters, "µ" and "%"), known or not; empty if none
/// does.
std::string_view unit_word(std::string_view text, std::size_t position);

bool is_unit(std::string_view word);

/// The longest unit that starts at `position`: "kg/m^3", "MPa / s", "/s". Nothing if no known unit stands
/// there. Throws std::invalid_argument for a power that is no whole number.
std::optional<UnitMatch> match_unit(std::string_view text, std::size_t position);

/// `number` of `unit` in SI, correctly rounded for units that are decimal parts of the SI unit.
double to_si(double number, const Unit& unit);

/// The SI unit of a dimension as Riven writes it: "m", "Pa", "kg/m^3", "1" without dimension.
std::string si_unit(const Dimension& dimension);

/// For messages: "a length", "a pressure", or "a quantity in kg/s".
std::string named(const Dimension& dimension);

/// A unit that users write for this dimension: "mm" for a length.
std::string usual_unit(const Dimension& dimension);

}  // namespace riven
