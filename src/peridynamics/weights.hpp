#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace riven {

/// A bond in the reference configuration (m).
struct PlaneBond {
  double x = 0;
  double y = 0;
};

/// Number of angular functions 1, cos 2t, sin 2t, cos 4t, sin 4t whose family averages are corrected.
inline constexpr std::size_t kMoments = 5;
using Moments = std::array<double, kMoments>;

/// The angular functions of a bond's direction.
Moments angular_functions(const PlaneBond& bond);

/// Weights of a family, sum 1, whose averages of the angular functions vanish, so that averages over the
/// family are those over all directions. Peridynamics theory, eq. (10).
struct FamilyWeights {
  enum class Kind {
    smooth,    // w0 times a combination of the angular functions
    listed,    // found by non-negative least squares; no formula
    gradient,  // no non-negative weights have the right moments: w0 itself, normalised
  };
  Kind kind = Kind::smooth;
  Moments coefficients{};      // of the combination, for `smooth`
  std::vector<double> weight;  // one per bond
  double smallest_ratio = 0;   // min weight / w0 before any repair (w0 normalised)
};

/// `bonds`: the family (any number, also none); base weight w0 = 1/length.
FamilyWeights moment_corrected_weights(std::span<const PlaneBond> bonds);
/// The base weights, normalised: of kind `gradient`.
FamilyWeights base_weights(std::span<const PlaneBond> bonds);
/// Sum of the base weights (1/m), before they are normalised.
double total_weight(std::span<const PlaneBond> bonds);

}  // namespace riven
