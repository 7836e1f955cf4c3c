#pragma once

#include "material/invariant_energy.hpp"
#include "material/parameter.hpp"

namespace riven {

/// W = C10 (I1 - 3) + C20 (I1 - 3)^2 + C30 (I1 - 3)^3 (Yeoh 1993).
struct Yeoh {
  static constexpr const char* name = "yeoh";
  double c10 = 0;  // Pa
  double c20 = 0;
  double c30 = 0;

  template <class Self, class Each>
  static void each_parameter(Self& law, const Each& each) {
    each("c10", law.c10, {.doc = "Factor of I1 - 3."});
    each("c20", law.c20, {.doc = "Factor of (I1 - 3)^2.", .fallback = 0});
    each("c30", law.c30, {.doc = "Factor of (I1 - 3)^3.", .fallback = 0});
  }

  InvariantEnergy operator()(double i1, double /*i2*/) const {
    const double x = i1 - 3;
    return {.w = x * (c10 + x * (c20 + x * c30)),
            .w1 = c10 + x * (2 * c20 + 3 * x * c30),
            .w11 = 2 * c20 + 6 * x * c30};
  }
};

}  // namespace riven
