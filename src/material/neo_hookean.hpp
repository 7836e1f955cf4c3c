#pragma once

#include "material/invariant_energy.hpp"

namespace riven {

/// W = C10 (I1 - 3).
struct NeoHookean {
  double c10 = 0;  // Pa, half the shear modulus

  InvariantEnergy operator()(double i1, double /*i2*/) const { return {.w = c10 * (i1 - 3), .w1 = c10}; }
};

}  // namespace riven
