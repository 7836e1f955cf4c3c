#pragma once

#include "material/invariant_energy.hpp"
#include "material/parameter.hpp"

namespace riven {

/// W = C10 (I1 - 3) + C01 (I2 - 3).
struct MooneyRivlin {
  static constexpr const char* name = "mooney-rivlin";
  double c10 = 0;  // Pa
  double c01 = 0;  // Pa

  template <class Self, class Each>
  static void each_parameter(Self& law, const Each& each) {
    each("c10", law.c10, {.doc = "Factor of I1 - 3."});
    each("c01", law.c01, {.doc = "Factor of I2 - 3."});
  }

  InvariantEnergy operator()(double i1, double i2) const {
    return {.w = c10 * (i1 - 3) + c01 * (i2 - 3), .w1 = c10, .w2 = c01};
  }
};

}  // namespace riven
