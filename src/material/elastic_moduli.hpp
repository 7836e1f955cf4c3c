#pragma once

#include "material/parameter.hpp"

namespace riven {

/// The two constants of an isotropic elastic solid, as users give them.
struct ElasticModuli {
  double youngs_modulus = 0;  // Pa
  double poissons_ratio = 0;

  [[nodiscard]] double shear() const { return youngs_modulus / (2 * (1 + poissons_ratio)); }
  /// Lame's first constant (Pa).
  [[nodiscard]] double lame() const {
    return youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio));
  }

  template <class Self, class Each>
  static void each_parameter(Self& moduli, const Each& each) {
    each("youngs_modulus", moduli.youngs_modulus,
         {.doc = "Young's modulus.", .range = ParameterKind::Range::positive});
    each("poissons_ratio", moduli.poissons_ratio,
         {.unit = ParameterKind::Unit::none,
          .doc = "Poisson's ratio, above -1 and below 1/2.",
          .range = ParameterKind::Range::poissons_ratio});
  }
};

}  // namespace riven
