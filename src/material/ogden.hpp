#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "material/parameter.hpp"

namespace riven {

/// A function f of one principal stretch l, with its logarithmic derivatives l f' and l (l f')' (Pa).
struct StretchEnergy {
  double f = 0, t = 0, d = 0;
};

/// W = sum of mu_n / alpha_n (l1^alpha_n + l2^alpha_n + l3^alpha_n - 3) of the principal stretches (Ogden
/// 1972), any number of terms. Neo-Hookean with alpha = 2, mu = 2 C10; Mooney-Rivlin with alpha = (2, -2), mu
/// = (2 C10, -2 C01). Some programs write 2 mu_n / alpha_n^2 for mu_n / alpha_n.
struct Ogden {
  static constexpr const char* name = "ogden";
  std::vector<double> mu;  // Pa
  std::vector<double> alpha;

  template <class Self, class Each>
  static void each_parameter(Self& law, const Each& each) {
    each("moduli", law.mu, {.doc = "Moduli of the terms; the shear modulus is half the sum of mu alpha."});
    each("exponents", law.alpha,
         {.unit = ParameterKind::Unit::none, .doc = "Exponents of the terms, as many."});
  }

  /// W is the sum of this over the principal stretches.
  StretchEnergy operator()(double stretch) const {
    StretchEnergy e;
    const double log = std::log(stretch);
    for (std::size_t n = 0; n < mu.size(); ++n) {
      const double power = std::exp(alpha[n] * log);
      e.f += mu[n] / alpha[n] * (power - 1);
      e.t += mu[n] * power;
      e.d += mu[n] * alpha[n] * power;
    }
    return e;
  }
};

}  // namespace riven
