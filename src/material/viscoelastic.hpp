#pragma once

#include <cstddef>

#include "material/material.hpp"

namespace riven {

/// Whether a material's law leaves its volume to an energy of its own, so that it can relax in shape alone.
[[nodiscard]] bool has_isochoric_part(const Material& material);

/// A material with a Prony series at finite strain (Simo 1987; rubber materials theory, eq. (12) to (14)).
/// Of the isochoric stress D = DEV[2 dW/dCbar] each branch carries a share of an H that follows it and
/// relaxes, dH/dt + H/tau = dD/dt; the volume is elastic.
///
/// A step over which D is linear in time is exact, H = e^-x H_n + beta (D - D_n) with x = dt/tau and beta =
/// (1 - e^-x)/x. In such a step the stress has a potential, g W(F) + U(J) + X : Cbar / 2 with constants g and
/// X, so that tangents are consistent and symmetric and sheets are as thick as those of any law.
class Viscoelastic {
 public:
  /// Of a material with a law of invariants or stretches.
  explicit Viscoelastic(Material material);

  /// How many numbers a point remembers: D, Cbar, the work that relaxation has spared, H of every branch.
  [[nodiscard]] std::size_t memory() const { return kOwn + kTensor * material_.relaxation.size(); }
  /// What a point remembers that has been at rest for ever.
  void forget(double* memory) const;

  /// What a step makes of a point's past.
  struct Step {
    double scale = 1;                                  // g
    Eigen::Matrix3d frozen = Eigen::Matrix3d::Zero();  // X (Pa)
  };
  /// `dt` (s) after what is remembered; 0 for a jump, whose response is instantaneous.
  [[nodiscard]] Step step(const double* memory, double dt) const;

  /// As those of Material; energies are the step's potential.
  [[nodiscard]] Response solid(const Eigen::Matrix3d& f, const Step& step) const;
  [[nodiscard]] PlaneResponse plane_strain(const Eigen::Matrix2d& f, const Step& step) const;
  [[nodiscard]] PlaneResponse plane_stress(const Eigen::Matrix2d& f, const Step& step) const;
  /// Stress of a solid alone.
  [[nodiscard]] Eigen::Matrix3d stress(const Eigen::Matrix3d& f, const Step& step) const;
  [[nodiscard]] double thickness_stretch(const Eigen::Matrix2d& f, const Step& step) const;

  /// What is remembered at the end of a step in `f`, into `after`. Returns the work (J/m^3) that the point
  /// has taken up since it was at rest, stored or dissipated, to second order in the step.
  double remember(const double* before, double dt, const Eigen::Matrix3d& f, double* after) const;

 private:
  /// W of the shape, and its stress.
  double isochoric(const Eigen::Matrix3d& f, Eigen::Matrix3d& stress) const;

  static constexpr std::size_t kTensor = 6, kOwn = 2 * kTensor + 1;

  Material material_;   // its instantaneous response
  Material isochoric_;  // the same, any volume without stress
};

}  // namespace riven
