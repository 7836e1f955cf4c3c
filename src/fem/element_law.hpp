#pragma once

#include <Eigen/LU>
#include <optional>

#include "material/material.hpp"
#include "material/viscoelastic.hpp"
#include "material/volume_energy.hpp"

namespace riven {

/// A material as elements use it: all of its response at every quadrature point, or without U(J), which then
/// is a function of a simpler J of the element: its mean, a linear fit, or that of its mean gradient. Where
/// it relaxes, its response is that of a step from what the point remembers.
struct ElementLaw {
  Material local;
  Kinematics kinematics = Kinematics::solid;
  std::optional<Volumetric> mean{};
  std::optional<Viscoelastic> viscous{};

  ElementLaw(Material material, Kinematics in, bool mean_dilatation)
      : local(std::move(material)), kinematics(in) {
    if (mean_dilatation) {
      mean = local.volumetric.value();
      local.volumetric->bulk_modulus = 0;
    }
    if (!local.relaxation.empty()) viscous.emplace(local);
  }
  using Step = Viscoelastic::Step;
  [[nodiscard]] Step step(const double* memory, double dt) const {
    return viscous ? viscous->step(memory, dt) : Step{};
  }
  /// Energy, stress and tangent at a quadrature point, without what the element's J gives.
  template <int D>
  [[nodiscard]] ResponseIn<D> respond(const Eigen::Matrix<double, D, D>& f, const Step& step) const {
    if constexpr (D == 3) {
      return viscous ? viscous->solid(f, step) : local.solid(f);
    } else {
      if (kinematics == Kinematics::plane_strain)
        return viscous ? viscous->plane_strain(f, step) : local.plane_strain(f);
      return viscous ? viscous->plane_stress(f, step) : local.plane_stress(f);
    }
  }
  /// The deformation gradient with what it is across the plane.
  template <int D>
  [[nodiscard]] Eigen::Matrix3d in_space(const Eigen::Matrix<double, D, D>& f, const Step& step) const {
    Eigen::Matrix3d whole = Eigen::Matrix3d::Identity();
    whole.topLeftCorner<D, D>() = f;
    if constexpr (D == 2) {
      if (kinematics == Kinematics::plane_stress)
        whole(2, 2) = viscous ? viscous->thickness_stretch(f, step) : local.thickness_stretch(f);
    }
    return whole;
  }
  /// Of a law that relaxes, from the deformation gradient in the plane and in space.
  template <int D>
  [[nodiscard]] Eigen::Matrix<double, D, D> viscous_stress(const Eigen::Matrix<double, D, D>& f,
                                                           const Eigen::Matrix3d& whole,
                                                           const Step& step) const {
    if constexpr (D == 2) {
      if (local.incompressible()) return viscous->plane_stress(f, step).stress;
    }
    return viscous->stress(whole, step).template topLeftCorner<D, D>();
  }
  /// What the point has taken up: the law's energy unless it relaxes.
  [[nodiscard]] double energy(double elastic, const Eigen::Matrix3d& f, const double* past,
                              double elapsed) const {
    if (!viscous) return elastic;
    std::vector<double> scratch(viscous->memory());
    return viscous->remember(past, elapsed, f, scratch.data());
  }
};

/// J F^-T, the derivative of J.
template <int D>
Eigen::Matrix<double, D, D> cofactor(const Eigen::Matrix<double, D, D>& f) {
  return f.determinant() * f.inverse().transpose();
}

}  // namespace riven
