#pragma once

#include "material/invariant_energy.hpp"

namespace riven {

/// W = C10 (I1 - 3) + C20 (I1 - 3)^2 + C30 (I1 - 3)^3.
struct Yeoh {
  double c10 = 0;  // Pa
  double c20 = 0;
  double c30 = 0;

  InvariantEnergy operator()(double i1, double /*i2*/) const {
    const double x = i1 - 3;
    return {.w = x * (c10 + x * (c20 + x * c30)),
            .w1 = c10 + x * (2 * c20 + 3 * x * c30),
            .w11 = 2 * c20 + 6 * x * c30};
  }
};

}  // namespace riven
