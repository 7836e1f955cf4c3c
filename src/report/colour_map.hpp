#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace riven {

using Colour = std::array<std::uint8_t, 3>;  // red, green, blue

/// Colours of a field from its lowest to its highest value: equally spaced anchors, linear in between.
struct ColourMap {
  std::string_view name;   // as users write it
  std::string_view label;  // what it is good for
  bool diverging = false;  // its middle is a value of its own: zero, as a rule
  std::span<const Colour> anchors;

  /// At `fraction` of the range; what is outside takes the colour of the end. NaN is grey.
  [[nodiscard]] Colour at(double fraction) const;
};

/// All of them, the default first. Each is legible to colour-blind readers.
std::span<const ColourMap> colour_maps();

/// By name. Throws InputError that lists the names and the nearest one.
const ColourMap& colour_map(const std::string& name);

}  // namespace riven
