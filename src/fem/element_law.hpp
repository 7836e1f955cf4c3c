#pragma once

#include <Eigen/LU>
#include <optional>

#include "material/material.hpp"
#include "material/volume_energy.hpp"

namespace riven {

/// A material as elements use it: all of its response at every quadrature point, or without U(J), which then
/// is a function of a simpler J of the element: its mean, a linear fit, or that of its mean gradient.
struct ElementLaw {
  Material local;
  Kinematics kinematics = Kinematics::solid;
  std::optional<Volumetric> mean{};

  ElementLaw(Material material, Kinematics in, bool mean_dilatation)
      : local(std::move(material)), kinematics(in) {
    if (!mean_dilatation) return;
    mean = local.volumetric.value();
    local.volumetric->bulk_modulus = 0;
  }
  /// Energy, stress and tangent at a quadrature point, without what the element's J gives.
  template <int D>
  [[nodiscard]] ResponseIn<D> respond(const Eigen::Matrix<double, D, D>& f) const {
    if constexpr (D == 3)
      return local.solid(f);
    else
      return kinematics == Kinematics::plane_strain ? local.plane_strain(f) : local.plane_stress(f);
  }
};

/// J F^-T, the derivative of J.
template <int D>
Eigen::Matrix<double, D, D> cofactor(const Eigen::Matrix<double, D, D>& f) {
  return f.determinant() * f.inverse().transpose();
}

}  // namespace riven
