#pragma once

#include "material/invariant_energy.hpp"
#include "material/parameter.hpp"

namespace riven {

/// General polynomial (Rivlin 1951) to the third degree, no further: W = sum of Cij (I1 - 3)^i (I2 - 3)^j, 1
/// <= i + j
/// <= 3.
struct Polynomial {
  static constexpr const char* name = "polynomial";
  double c10 = 0, c01 = 0, c20 = 0, c11 = 0, c02 = 0, c30 = 0, c21 = 0, c12 = 0, c03 = 0;  // Pa

  template <class Self, class Each>
  static void each_parameter(Self& law, const Each& each) {
    const ParameterKind coefficient{.doc = "Factor of (I1 - 3)^i (I2 - 3)^j, for the key cij.",
                                    .fallback = 0};
    each("c10", law.c10, {.doc = coefficient.doc});
    each("c01", law.c01, coefficient);
    each("c20", law.c20, coefficient);
    each("c11", law.c11, coefficient);
    each("c02", law.c02, coefficient);
    each("c30", law.c30, coefficient);
    each("c21", law.c21, coefficient);
    each("c12", law.c12, coefficient);
    each("c03", law.c03, coefficient);
  }

  InvariantEnergy operator()(double i1, double i2) const {
    const double x = i1 - 3, y = i2 - 3;
    return {.w = x * (c10 + x * (c20 + x * c30)) + y * (c01 + y * (c02 + y * c03)) +
                 x * y * (c11 + x * c21 + y * c12),
            .w1 = c10 + x * (2 * c20 + 3 * x * c30) + y * (c11 + 2 * x * c21 + y * c12),
            .w2 = c01 + y * (2 * c02 + 3 * y * c03) + x * (c11 + x * c21 + 2 * y * c12),
            .w11 = 2 * c20 + 6 * x * c30 + 2 * y * c21,
            .w12 = c11 + 2 * x * c21 + 2 * y * c12,
            .w22 = 2 * c02 + 6 * y * c03 + 2 * x * c12};
  }
};

}  // namespace riven
