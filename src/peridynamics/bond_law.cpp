#include "peridynamics/bond_law.hpp"

#include <cmath>

namespace riven {

double BondLaw::stiffness(double s) const {
  return p2 + 6 * p4 * s * s + m1 * std::pow(s, -3) + 3 * m2 * std::pow(s, -4) + 10 * m4 * std::pow(s, -6) +
         21 * m6 * std::pow(s, -8);
}

BondLaw published_law(Loading loading) {
  switch (loading) {
    case Loading::equibiaxial:
      return {.p2 = 1, .m4 = 0.5, .e = -1.5};
    case Loading::planar:
      return {.p2 = 31.0 / 25, .m2 = 89.0 / 81, .e = -138.0 / 59};
    case Loading::uniaxial:
      return {.p2 = 64.0 / 49, .m1 = 3.0 / 4, .m4 = 8.0 / 17, .e = -48.0 / 19};
    case Loading::uniaxial_compression:
      return {.p2 = -109.0 / 14, .m1 = -239.0 / 16, .m4 = 5.0 / 18, .e = 202.0 / 9};
  }
  return {};
}

namespace {

/// Sets the coefficient of s^2 and the constant so that force and energy vanish at rest.
BondLaw at_rest(BondLaw law) {
  law.p2 = 0.5 * (law.m1 + 2 * law.m2 + 4 * law.m4 + 6 * law.m6 - 4 * law.p4);
  law.e = -law.potential(1.0);
  return law;
}

}  // namespace

BondLaw zero_residual_law(Loading loading) {
  switch (loading) {
    case Loading::equibiaxial:
      return at_rest({.m4 = 0.5});
    case Loading::planar:
      return at_rest({.m2 = 0.922169, .m6 = 0.102534});
    case Loading::uniaxial:
      return at_rest({.m1 = 0.775530, .m4 = 0.460964});
    case Loading::uniaxial_compression:
      return at_rest({.p4 = 1.791331, .m1 = -8.852616, .m4 = -0.164033});
  }
  return {};
}

double lateral_stretch(Loading loading, double stretch) {
  if (loading == Loading::equibiaxial) return stretch;
  return loading == Loading::planar ? 1.0 : 1 / std::sqrt(stretch);
}

double neo_hookean_energy(Loading loading, double stretch) {
  const double other = lateral_stretch(loading, stretch), thickness = 1 / (stretch * other);
  return stretch * stretch + other * other + thickness * thickness - 3;
}

}  // namespace riven
