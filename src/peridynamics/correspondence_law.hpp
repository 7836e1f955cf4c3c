#pragma once

#include <cstddef>
#include <limits>

#include "material/material.hpp"

namespace riven {

/// A material in the kinematics of a body.
struct Constitution {
  Material material;
  Kinematics kinematics = Kinematics::solid;

  /// As `Material::stress`.
  std::size_t stress(std::size_t n, const double* const* f, double* const* p, double* energy) const {
    return material.stress(kinematics, n, f, p, energy);
  }
  template <int D>
  [[nodiscard]] ResponseIn<D> respond(const Eigen::Matrix<double, D, D>& f) const {
    if constexpr (D == 3) {
      return material.solid(f);
    } else {
      return kinematics == Kinematics::plane_strain ? material.plane_strain(f) : material.plane_stress(f);
    }
  }
};

/// The linear law P = a (H + g (tr(H) 1 - H^T)) of H = F - 1, in D dimensions. The second term is the
/// gradient of a null Lagrangian, which has no energy in waves: there a law's longitudinal modulus is a. It
/// makes the law an upper bound of isotropic Hooke's with the same a and shear modulus, at g = 1 - 2 mu / a,
/// which is sharp.
template <int D>
struct Majorant {
  using Tangent = typename ResponseIn<D>::Tangent;
  double a = 0;      // Pa
  double gamma = 0;  // g

  std::size_t stress(std::size_t n, const double* const* f, double* const* p, double* /*energy*/) const {
    for (std::size_t i = 0; i < n; ++i) {
      double trace = -D;
      for (int d = 0; d < D; ++d) trace += f[(D + 1) * d][i];
      for (int r = 0; r < D; ++r)
        for (int c = 0; c < D; ++c) {
          const double one = r == c ? 1 : 0;
          p[D * r + c][i] = a * (f[D * r + c][i] - one + gamma * (one * trace - (f[D * c + r][i] - one)));
        }
    }
    return 0;
  }
  /// dP/dF at a = 1.
  [[nodiscard]] Tangent unit() const {
    Tangent t = Tangent::Identity();
    for (int r = 0; r < D; ++r)
      for (int c = 0; c < D; ++c) {
        t(D * r + c, D * c + r) -= gamma;
        t((D + 1) * r, (D + 1) * c) += gamma;
      }
    return t;
  }
};

}  // namespace riven
