#pragma once

#include <cmath>
#include <string>

namespace riven {

/// The loading whose energy a bond law was fitted to.
enum class Loading { equibiaxial, planar, uniaxial, uniaxial_compression };

/// A bond-based law of an incompressible neo-Hookean membrane: peridynamics theory, eq. (2). With influence
/// delta/xi, bond stretch s and the cosine L between the undeformed and the deformed bond,
///   W = c0 sum_j (delta/xi) (L^2 P(s) + e) V_j,  P(s) = sum of c_n s^n,  c0 = C1 / (pi h delta^2),
///   f = c0 (4 delta/xi^3) L^2 R(s) Y,  R(s) = P'(s) / (2 s):  pair force per volume squared (N/m^6).
/// L is held fixed in P', so that f is the gradient of W only where bonds do not turn.
struct BondLaw {
  double p4 = 0, p2 = 0, m1 = 0, m2 = 0, m4 = 0, m6 = 0;  // coefficients of s^4, s^2, 1/s, ...
  double e = 0;

  /// P of a squared stretch.
  [[nodiscard]] double potential(double s2) const {
    const double q = 1 / s2;
    return (p4 * s2 + p2) * s2 + m1 * std::sqrt(q) + (m2 + (m4 + m6 * q) * q) * q;
  }
  /// R of a squared stretch.
  [[nodiscard]] double response(double s2) const {
    const double q = 1 / s2;
    return p2 + 2 * p4 * s2 - q * (0.5 * m1 * std::sqrt(q) + q * (m2 + q * (2 * m4 + 3 * m6 * q)));
  }
  /// Derivative of the force s R(s) in s.
  [[nodiscard]] double stiffness(double s) const;

  /// Force s R(s) and energy P(s) + e that the law leaves in a bond at rest; 0 in a sound law.
  [[nodiscard]] double force_at_rest() const { return response(1.0); }
  [[nodiscard]] double energy_at_rest() const { return potential(1.0) + e; }
};

/// The constants printed by Bang (2016), eq. (35), (58), (77).
BondLaw published_law(Loading loading);

/// Constants fitted by least squares to the energy of the loading (stretch 1 to 4, for compression 0.4 to 1)
/// under the condition that force and energy vanish at rest: peridynamics theory, section 2.
BondLaw zero_residual_law(Loading loading);

/// Strain energy density of an incompressible neo-Hookean sheet under a loading, over C1.
double neo_hookean_energy(Loading loading, double stretch);

/// Stretch along y (in the plane) that goes with a stretch along x under a loading.
double lateral_stretch(Loading loading, double stretch);

}  // namespace riven
