#include "report/colour_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "base/nearest_name.hpp"

namespace riven {

namespace {

constexpr Colour kNotANumber = {150, 150, 150};

// Ten samples each of viridis, cividis and inferno (matplotlib, CC0), the even ones of ColorBrewer's PuOr.
constexpr Colour kViridis[] = {{68, 1, 84},    {72, 40, 120},  {62, 74, 137},  {49, 104, 142},
                               {38, 130, 142}, {31, 158, 137}, {53, 183, 121}, {110, 206, 88},
                               {181, 222, 43}, {253, 231, 37}};
constexpr Colour kCividis[] = {{0, 34, 78},     {18, 53, 112},   {59, 73, 108},   {87, 93, 109},
                               {112, 113, 115}, {138, 134, 120}, {165, 156, 116}, {195, 179, 105},
                               {225, 204, 85},  {254, 232, 56}};
constexpr Colour kInferno[] = {{0, 0, 4},     {27, 12, 65},   {74, 12, 107}, {120, 28, 109}, {165, 44, 96},
                               {207, 68, 70}, {237, 105, 37}, {251, 155, 6}, {247, 209, 61}, {252, 255, 164}};
constexpr Colour kPurpleOrange[] = {{45, 0, 75},     {84, 39, 136},   {128, 115, 172}, {178, 171, 210},
                                    {216, 218, 235}, {247, 247, 247}, {254, 224, 182}, {253, 184, 99},
                                    {224, 130, 20},  {179, 88, 6},    {127, 59, 8}};
constexpr Colour kGrey[] = {{25, 25, 25}, {240, 240, 240}};

constexpr ColourMap kMaps[] = {{"viridis", "for most fields", false, kViridis},
                               {"cividis", "the same to all eyes", false, kCividis},
                               {"inferno", "dark to bright", false, kInferno},
                               {"purple-orange", "for values of both signs", true, kPurpleOrange},
                               {"grey", "for print", false, kGrey}};

}  // namespace

Colour ColourMap::at(double fraction) const {
  if (std::isnan(fraction)) return kNotANumber;
  const double place = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(anchors.size() - 1);
  const std::size_t left = std::min(static_cast<std::size_t>(place), anchors.size() - 2);
  const double part = place - static_cast<double>(left);
  Colour mixed{};
  for (std::size_t c = 0; c < mixed.size(); ++c)
    mixed[c] =
        static_cast<std::uint8_t>(std::lround((1 - part) * anchors[left][c] + part * anchors[left + 1][c]));
  return mixed;
}

std::span<const ColourMap> colour_maps() {
  return kMaps;
}

const ColourMap& colour_map(const std::string& name) {
  std::vector<std::string> names;
  for (const ColourMap& map : kMaps) {
    if (map.name == name) return map;
    names.emplace_back(map.name);
  }
  throw InputError(
      fmt::format("{}: no such colour map; known are {}{}", name, listed(names), did_you_mean(name, names)));
}

}  // namespace riven
