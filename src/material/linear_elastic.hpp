#pragma once

#include "material/elastic_moduli.hpp"
#include "material/response.hpp"

namespace riven {

/// Hooke's law for small strain: P = lambda tr(e) 1 + 2 mu e with e = sym(F) - 1. Not objective: a rotation
/// by the angle t gives stresses of the order of t^2 E.
struct LinearElastic : ElasticModuli {
  static constexpr const char* name = "linear-elastic";
  static constexpr bool objective = false;

  double operator()(const Eigen::Matrix3d& f, Eigen::Matrix3d& stress, Response::Tangent* tangent) const {
    const double mu = shear(), lambda = lame();
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(), e = 0.5 * (f + f.transpose()) - one;
    stress = lambda * e.trace() * one + 2 * mu * e;
    if (tangent != nullptr) {
      for (int i = 0; i < 3; ++i)
        for (int J = 0; J < 3; ++J)
          for (int k = 0; k < 3; ++k)
            for (int L = 0; L < 3; ++L)
              (*tangent)(3 * i + J, 3 * k + L) =
                  lambda * one(i, J) * one(k, L) + mu * (one(i, k) * one(J, L) + one(i, L) * one(J, k));
    }
    return 0.5 * (stress.array() * e.array()).sum();
  }
};

}  // namespace riven
