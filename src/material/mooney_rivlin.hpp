#pragma once

#include "material/invariant_energy.hpp"

namespace riven {

/// W = C10 (I1 - 3) + C01 (I2 - 3).
struct MooneyRivlin {
  double c10 = 0;  // Pa
  double c01 = 0;  // Pa

  InvariantEnergy operator()(double i1, double i2) const {
    return {.w = c10 * (i1 - 3) + c01 * (i2 - 3), .w1 = c10, .w2 = c01};
  }
};

}  // namespace riven
