#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace riven {

/// When bonds break for good. Materials are numbered as in `Body::material`.
struct FailureLimits {
  /// Stretch (r - L) / L beyond which a bond between two materials breaks, row by row, symmetric; infinite:
  /// never. Empty: no bond breaks.
  std::vector<double> stretch;
  /// Damage at which all bonds of a point of a material break; infinite: never. Empty: no such limit.
  std::vector<double> damage;
  /// Strain energy density (J/m^3) of a point of a material at which all its bonds break; infinite: never.
  /// Empty: no such limit.
  std::vector<double> energy_density;

  /// The same limit for all bonds.
  static FailureLimits uniform(double stretch, std::size_t materials = 1) {
    return {std::vector<double>(materials * materials, stretch), {}, {}};
  }
  [[nodiscard]] std::size_t materials() const {
    return static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(stretch.size()))));
  }
  [[nodiscard]] double between(std::size_t a, std::size_t b) const { return stretch[a * materials() + b]; }
};

}  // namespace riven
