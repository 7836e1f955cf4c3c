#pragma once

#include "material/invariant_energy.hpp"

namespace riven {

/// Strain energy density of an incompressible sheet as a function of the family averages a = <s^2> and b =
/// <s^4>, with its derivatives. Peridynamics theory, eq. (7) and (8).
struct FamilyEnergy {
  double w = 0;
  double wa = 0, wb = 0;
  double waa = 0, wab = 0, wbb = 0;
};

/// Square of the area ratio, J^2 = 3 a^2 - 2 b.
inline double area_ratio_squared(double a, double b) {
  return 3 * a * a - 2 * b;
}

// Below this share of a^2 the squared area ratio says that the family has collapsed: far above rounding, and
// far below what sound states reach. Uniaxial stretch l has the share 4/l^3, so the 1e-3 of theory section 5
// would stop at l = 16, which points at the corners of a slot pass on fine lattices.
inline constexpr double kCollapse = 1e-7;

inline bool collapsed(double a, double b) {
  return !(area_ratio_squared(a, b) > kCollapse * a * a);
}

template <class Law>
FamilyEnergy family_energy(const Law& law, double a, double b) {
  const double j2 = area_ratio_squared(a, b);
  const double q = 1 / j2, q2 = q * q, q3 = q2 * q;
  const InvariantEnergy e = law(2 * a + q, j2 + 2 * a * q);
  const double i1a = 2 - 6 * a * q2, i1b = 2 * q2;
  const double i2a = 6 * a + 2 * q - 12 * a * a * q2, i2b = -2 + 4 * a * q2;
  const double i1aa = -6 * q2 + 72 * a * a * q3, i1ab = -24 * a * q3, i1bb = 8 * q3;
  const double i2aa = 6 - 36 * a * q2 + 144 * a * a * a * q3, i2ab = 4 * q2 - 48 * a * a * q3,
               i2bb = 16 * a * q3;
  return {
      .w = e.w,
      .wa = e.w1 * i1a + e.w2 * i2a,
      .wb = e.w1 * i1b + e.w2 * i2b,
      .waa = e.w1 * i1aa + e.w2 * i2aa + e.w11 * i1a * i1a + 2 * e.w12 * i1a * i2a + e.w22 * i2a * i2a,
      .wab =
          e.w1 * i1ab + e.w2 * i2ab + e.w11 * i1a * i1b + e.w12 * (i1a * i2b + i2a * i1b) + e.w22 * i2a * i2b,
      .wbb = e.w1 * i1bb + e.w2 * i2bb + e.w11 * i1b * i1b + 2 * e.w12 * i1b * i2b + e.w22 * i2b * i2b,
  };
}

/// Growth of the stabilisation under compression. A choice: the slot of uniaxial-crack reaches stretch 3 with
/// 1, 2, 3 and 10 as well (without growth it folds at 2.4), but with 10 some random sheets with short slits
/// no longer settle.
inline constexpr double kStiffening = 3;

/// How compressed a family is, r = a / J^4: 1 at rest, less in tension.
inline double compression(double a, double b) {
  const double j2 = area_ratio_squared(a, b);
  return a / (j2 * j2);
}
/// In the uniaxial compression (0.63) where a family without stabilisation loses stability.
inline constexpr double kUnstableCompression = 2.5;

/// Modulus of the stabilisation (Pa) as a function of the family averages: `kappa` at rest and in any
/// tension, and more where compression makes short waves unstable.
inline FamilyEnergy stiffened_modulus(double kappa, double a, double b) {
  const double q = 1 / area_ratio_squared(a, b), q2 = q * q, q3 = q2 * q, q4 = q3 * q;
  const double excess = a * q2 - 1;
  if (excess <= 0) return {.w = kappa};
  const double ra = q2 - 12 * a * a * q3, rb = 4 * a * q3;
  const double raa = -36 * a * q3 + 216 * a * a * a * q4, rab = 4 * q3 - 72 * a * a * q4, rbb = 24 * a * q4;
  const double c = 2 * kStiffening * kappa;
  return {.w = kappa * (1 + kStiffening * excess * excess),
          .wa = c * excess * ra,
          .wb = c * excess * rb,
          .waa = c * (ra * ra + excess * raa),
          .wab = c * (ra * rb + excess * rab),
          .wbb = c * (rb * rb + excess * rbb)};
}

}  // namespace riven
