#pragma once

#include <Eigen/LU>
#include <cmath>

#include "material/elastic_moduli.hpp"
#include "material/response.hpp"

namespace riven {

/// W = mu / 2 (I1 - 3 - 2 ln J) + lambda / 2 (ln J)^2, with I1 = F:F.
struct CompressibleNeoHookean : ElasticModuli {
  static constexpr const char* name = "compressible-neo-hookean";
  static constexpr bool objective = true;

  double operator()(const Eigen::Matrix3d& f, Eigen::Matrix3d& stress, Response::Tangent* tangent) const {
    const double mu = shear(), lambda = lame(), log_j = std::log(f.determinant());
    const Eigen::Matrix3d g = f.inverse().transpose();
    stress = mu * (f - g) + lambda * log_j * g;
    if (tangent != nullptr) {
      const auto flat_g = flat<3>(g);
      *tangent = mu * Response::Tangent::Identity() + lambda * flat_g * flat_g.transpose() +
                 (lambda * log_j - mu) * derivative_of_inverse_transpose<3>(g);
    }
    return 0.5 * mu * (f.squaredNorm() - 3 - 2 * log_j) + 0.5 * lambda * log_j * log_j;
  }
};

}  // namespace riven
