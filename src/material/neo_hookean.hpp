#pragma once

#include "material/invariant_energy.hpp"
#include "material/parameter.hpp"

namespace riven {

/// W = C10 (I1 - 3).
struct NeoHookean {
  static constexpr const char* name = "neo-hookean";
  double c10 = 0;  // Pa, half the shear modulus

  template <class Self, class Each>
  static void each_parameter(Self& law, const Each& each) {
    using enum ParameterKind::Range;
    each("youngs_modulus", law.c10,
         {.doc = "Young's modulus if incompressible, 6 C10.", .range = positive, .factor = 1.0 / 6});
    each("shear_modulus", law.c10, {.doc = "Shear modulus, 2 C10.", .range = positive, .factor = 0.5});
    each("c10", law.c10, {.doc = "C10, half the shear modulus.", .factor = 1});
  }

  InvariantEnergy operator()(double i1, double /*i2*/) const { return {.w = c10 * (i1 - 3), .w1 = c10}; }
};

}  // namespace riven
