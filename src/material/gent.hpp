#pragma once

#include <cmath>

#include "material/invariant_energy.hpp"
#include "material/parameter.hpp"

namespace riven {

/// W = -mu Jm / 2 ln(1 - (I1 - 3) / Jm) (Gent 1996); not a number where I1 - 3 reaches Jm.
struct Gent {
  static constexpr const char* name = "gent";
  double mu = 0;  // Pa
  double jm = 0;

  template <class Self, class Each>
  static void each_parameter(Self& law, const Each& each) {
    using enum ParameterKind::Range;
    each("shear_modulus", law.mu, {.doc = "Shear modulus at rest.", .range = positive});
    each("limit", law.jm,
         {.unit = ParameterKind::Unit::none, .doc = "Jm, the limit of I1 - 3.", .range = positive});
  }

  InvariantEnergy operator()(double i1, double /*i2*/) const {
    const double left = 1 - (i1 - 3) / jm, w1 = 0.5 * mu / left;
    return {.w = -0.5 * mu * jm * std::log(left), .w1 = w1, .w11 = w1 / (jm * left)};
  }
};

}  // namespace riven
