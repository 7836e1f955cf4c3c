#pragma once

#include "material/elastic_moduli.hpp"
#include "material/response.hpp"

namespace riven {

/// Hooke's law between second Piola-Kirchhoff stress and Green's strain E = (F^T F - 1) / 2: small strain
/// under any rotation. It softens under compression and fails near a stretch of 0.58.
struct StVenantKirchhoff : ElasticModuli {
  static constexpr const char* name = "st-venant-kirchhoff";
  static constexpr bool objective = true;

  double operator()(const Eigen::Matrix3d& f, Eigen::Matrix3d& stress, Response::Tangent* tangent) const {
    const double mu = shear(), lambda = lame();
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(), e = 0.5 * (f.transpose() * f - one);
    const Eigen::Matrix3d s = lambda * e.trace() * one + 2 * mu * e;
    stress = f * s;
    if (tangent != nullptr) {
      const Eigen::Matrix3d b = f * f.transpose();
      for (int i = 0; i < 3; ++i)
        for (int J = 0; J < 3; ++J)
          for (int k = 0; k < 3; ++k)
            for (int L = 0; L < 3; ++L)
              (*tangent)(3 * i + J, 3 * k + L) = one(i, k) * s(J, L) + lambda * f(i, J) * f(k, L) +
                                                 mu * (b(i, k) * one(J, L) + f(i, L) * f(k, J));
    }
    return 0.5 * (s.array() * e.array()).sum();
  }
};

}  // namespace riven
