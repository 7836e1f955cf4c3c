#pragma once

#include <variant>

#include "material/mooney_rivlin.hpp"
#include "material/neo_hookean.hpp"
#include "material/yeoh.hpp"

namespace riven {

/// Any strain energy density W(I1, I2) of an incompressible material. A new law is one header with the same
/// call, and one more name here.
using InvariantLaw = std::variant<NeoHookean, MooneyRivlin, Yeoh>;

/// Shear modulus 2 (W1 + W2) of the undeformed material (Pa).
inline double shear_modulus(const InvariantLaw& law) {
  const InvariantEnergy rest = std::visit([](const auto& w) { return w(3.0, 3.0); }, law);
  return 2 * (rest.w1 + rest.w2);
}

}  // namespace riven
