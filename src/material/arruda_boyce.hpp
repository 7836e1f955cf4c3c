#pragma once

#include <array>
#include <cstddef>

#include "material/invariant_energy.hpp"
#include "material/parameter.hpp"

namespace riven {

/// Eight-chain model (Arruda and Boyce 1993), the first five terms of its series:
/// W = mu sum of c_i / lambda_m^(2 i - 2) (I1^i - 3^i).
struct ArrudaBoyce {
  static constexpr const char* name = "arruda-boyce";
  double mu = 0;        // Pa; the shear modulus at rest is a little more
  double lambda_m = 0;  // stretch at which the chains lock

  template <class Self, class Each>
  static void each_parameter(Self& law, const Each& each) {
    using enum ParameterKind::Range;
    each("mu", law.mu,
         {.doc =
              "Modulus of the chains; at rest the shear modulus is mu (1 + 3 / (5 locking_stretch^2) + ...).",
          .range = positive});
    each("locking_stretch", law.lambda_m,
         {.unit = ParameterKind::Unit::none, .doc = "Stretch at which the chains lock.", .range = positive});
  }

  InvariantEnergy operator()(double i1, double /*i2*/) const {
    // The last one is 42039/67375 of the shear modulus (not 42039/67635, a slip in a source).
    constexpr std::array<double, 5> c = {1.0 / 2, 1.0 / 20, 11.0 / 1050, 19.0 / 7000, 519.0 / 673750};
    const double q = 1 / (lambda_m * lambda_m);
    InvariantEnergy e;
    double power = 1, rest = 1, scale = mu;  // i1^(i-1), 3^(i-1), mu / lambda_m^(2 i - 2)
    double below = 0;                        // i1^(i-2)
    for (std::size_t n = 0; n < c.size(); ++n) {
      const double i = static_cast<double>(n + 1), factor = scale * c[n];
      e.w += factor * (power * i1 - rest * 3);
      e.w1 += factor * i * power;
      e.w11 += factor * i * (i - 1) * below;
      below = power;
      power *= i1;
      rest *= 3;
      scale *= q;
    }
    return e;
  }
};

}  // namespace riven
