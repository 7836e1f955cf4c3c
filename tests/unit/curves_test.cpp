// Curves of every law of the table in support/laws.hpp against derivatives of its energy, limits and closed
// forms.

#include "material/curves.hpp"

#include <gtest/gtest.h>

#include "support/differences.hpp"
#include "support/laws.hpp"

namespace riven::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr Deformation kStretched[] = {Deformation::uniaxial, Deformation::planar, Deformation::equibiaxial};

/// The gradient at a stretch or an amount of shear with a free stretch, written out once more.
Matrix3d gradient(Deformation deformation, double at, double free) {
  switch (deformation) {
    case Deformation::uniaxial:
      return Vector3d(at, free, free).asDiagonal();
    case Deformation::planar:
      return Vector3d(at, 1, free).asDiagonal();
    case Deformation::equibiaxial:
      return Vector3d(at, at, free).asDiagonal();
    case Deformation::simple_shear:
      return Matrix3d{{1, at, 0}, {0, 1, 0}, {0, 0, 1}};
    default:
      return std::cbrt(at) * Matrix3d::Identity();
  }
}

/// Without change of volume.
double free_stretch(Deformation deformation, double at) {
  if (deformation == Deformation::uniaxial) return 1 / std::sqrt(at);
  return deformation == Deformation::planar ? 1 / at : 1 / (at * at);
}

/// Directions that the stress works in.
double share(Deformation deformation) {
  return deformation == Deformation::equibiaxial ? 2 : 1;
}

std::optional<HomogeneousState> state_at(const Material& material, Deformation deformation, double at) {
  return follow(material, deformation, rest(material, deformation), at);
}

class CurvesOf : public ::testing::TestWithParam<LawCase> {
 protected:
  const LawCase& law() const { return GetParam(); }
  double mu() const { return law().shear_modulus; }
};
INSTANTIATE_TEST_SUITE_P(Materials, CurvesOf, ::testing::ValuesIn(law_cases()), law_name);

class RubberCurvesOf : public CurvesOf {};
INSTANTIATE_TEST_SUITE_P(Materials, RubberCurvesOf,
                         ::testing::ValuesIn(laws_that([](const LawCase& c) { return c.is_rubber(); })),
                         law_name);

// Free directions do no work, so the stress is the derivative of the energy along the path. The differences'
// error is h^4 W^(5) / 30, below 1e-9 of the tangent here; rounding 1e-16 W / h.
TEST_P(RubberCurvesOf, AreDerivativesOfTheEnergyIfIncompressible) {
  const Material material = law().material();
  for (const Deformation deformation : kStretched)
    for (const double at : {0.55, 0.9, 1.0, 1.4, 2.2}) {
      const auto energy = [&](double l) {
        return law().energy(gradient(deformation, l, free_stretch(deformation, l)));
      };
      const auto state = state_at(material, deformation, at);
      ASSERT_TRUE(state) << name(deformation) << " at " << at;
      const double tolerance = 1e-7 * (mu() + std::abs(state->slope));
      EXPECT_NEAR(state->stress * share(deformation), derivative(energy, at, 1e-3), tolerance)
          << name(deformation) << " at " << at;
      EXPECT_NEAR(state->slope,
                  derivative([&](double l) { return state_at(material, deformation, l)->stress; }, at, 1e-3),
                  tolerance)
          << name(deformation) << " at " << at;
      EXPECT_LT((state->gradient - gradient(deformation, at, free_stretch(deformation, at))).norm(), 1e-13);
    }
  for (const double shear : {-0.8, 0.0, 1.5}) {
    const auto energy = [&](double g) { return law().energy(gradient(Deformation::simple_shear, g, 1)); };
    const auto state = state_at(material, Deformation::simple_shear, shear);
    EXPECT_NEAR(state->stress, derivative(energy, shear, 1e-3), 1e-7 * (mu() + state->slope)) << shear;
  }
}

// Theory note, end of section 2.
TEST_P(RubberCurvesOf, HaveTheClosedFormsOfInvariants) {
  if (!invariant_law(law().law)) return;
  for (const double l : {0.6, 1.7}) {
    const auto expect = [&](Deformation deformation, double i1, double i2, double factor, double weight) {
      const InvariantEnergy e = law().at(i1, i2);
      const double closed = 2 * factor * (e.w1 + weight * e.w2);
      EXPECT_NEAR(state_at(law().material(), deformation, l)->stress, closed, 1e-12 * std::abs(closed));
    };
    const double s = l * l;
    expect(Deformation::uniaxial, s + 2 / l, 2 * l + 1 / s, l - 1 / s, 1 / l);
    expect(Deformation::equibiaxial, 2 * s + 1 / (s * s), s * s + 2 / s, l - std::pow(l, -5), s);
    expect(Deformation::planar, s + 1 + 1 / s, s + 1 + 1 / s, l - std::pow(l, -3), 1);
  }
}

TEST_P(CurvesOf, AreDerivativesOfTheEnergyIfCompressible) {
  const Material material = law().compressible();
  const auto energy_of = [&](const Matrix3d& f) {
    if (!law().is_rubber()) return law().energy(f);
    const double j = f.determinant();
    return law().energy(std::cbrt(1 / j) * f) + 0.5 * material.volumetric->bulk_modulus * (j - 1) * (j - 1);
  };
  const double modulus = material.small_strain().longitudinal();
  for (const Deformation deformation : kStretched)
    for (const double at : {0.8, 1.0, 1.2, 1.4}) {
      const auto state = state_at(material, deformation, at);
      ASSERT_TRUE(state) << name(deformation) << " at " << at;
      const auto along = [&](double l) { return energy_of(gradient(deformation, l, state->free)); };
      const auto across = [&](double q) { return energy_of(gradient(deformation, at, q)); };
      EXPECT_NEAR(state->stress * share(deformation), derivative(along, at, 1e-3), 1e-8 * modulus);
      EXPECT_NEAR(derivative(across, state->free, 1e-3), 0, 1e-8 * modulus) << name(deformation) << at;
      EXPECT_NEAR(state->slope,
                  derivative([&](double l) { return state_at(material, deformation, l)->stress; }, at, 1e-3),
                  1e-7 * modulus);
    }
  const auto pressure_of = [&](double j) {
    return -derivative([&](double x) { return energy_of(gradient(Deformation::volumetric, x, 1)); }, j, 1e-3);
  };
  for (const double j : {0.8, 1.0, 1.3}) {
    const auto state = state_at(material, Deformation::volumetric, j);
    EXPECT_NEAR(state->stress, pressure_of(j), 1e-8 * modulus);
    EXPECT_NEAR(state->slope, derivative(pressure_of, j, 2e-3), 1e-7 * modulus);
  }
  const auto sheared = [&](double g) { return energy_of(gradient(Deformation::simple_shear, g, 1)); };
  EXPECT_NEAR(state_at(material, Deformation::simple_shear, 0.7)->stress, derivative(sheared, 0.7, 1e-3),
              1e-8 * modulus);
}

TEST_P(CurvesOf, StartWithTheModuliAtSmallStrain) {
  for (const Material& material : {law().material(), law().compressible()}) {
    const SmallStrain moduli = material.small_strain();
    const double e = moduli.youngs_modulus(), nu = moduli.poissons_ratio();
    const auto slope = [&](Deformation deformation) { return rest(material, deformation).slope; };
    const double rounding = 1e-13 * (material.incompressible() ? mu() : moduli.bulk);
    EXPECT_NEAR(slope(Deformation::uniaxial), e, rounding);
    EXPECT_NEAR(slope(Deformation::planar), e / (1 - nu * nu), rounding);
    EXPECT_NEAR(slope(Deformation::equibiaxial), e / (1 - nu), rounding);
    EXPECT_NEAR(slope(Deformation::simple_shear), mu(), rounding);
    if (!material.incompressible()) {
      EXPECT_NEAR(slope(Deformation::volumetric), -moduli.bulk, rounding);
    }
  }
}

// The difference is of the order of the stress over the bulk modulus: ten times less at ten times that.
TEST_P(RubberCurvesOf, TendToTheIncompressibleOnes) {
  Material nearly = law().material();
  for (const Deformation deformation : kStretched)
    for (const double at : {0.7, 1.5}) {
      const double limit = state_at(law().material(), deformation, at)->stress;
      const auto error = [&](double bulk) {
        nearly.volumetric = Volumetric{bulk * mu(), Volumetric::Form::quadratic};
        return std::abs(state_at(nearly, deformation, at)->stress - limit);
      };
      EXPECT_LT(error(1e4), 1e-2 * std::abs(limit)) << name(deformation) << " at " << at;
      EXPECT_NEAR(error(1e5), 0.1 * error(1e4), 0.01 * error(1e4)) << name(deformation) << " at " << at;
    }
}

TEST(Curves, OfLawsInClosedForm) {
  const Material hooke{"", LinearElastic{{2.5, 0.25}}, 1}, kirchhoff{"", StVenantKirchhoff{{2.5, 0.25}}, 1};
  for (const double l : {0.7, 1.3}) {
    EXPECT_NEAR(state_at(hooke, Deformation::uniaxial, l)->stress, 2.5 * (l - 1), 1e-13);
    EXPECT_NEAR(state_at(hooke, Deformation::uniaxial, l)->free, 1 - 0.25 * (l - 1), 1e-13);
    // Uniaxial stress is uniaxial in S, too: S = E times Green's strain.
    EXPECT_NEAR(state_at(kirchhoff, Deformation::uniaxial, l)->stress, 2.5 * l * (l * l - 1) / 2, 1e-13);
  }
}

TEST(Curves, EndWhereTheLawSaysNothing) {
  const Material gent{"", Gent{1, 5}, 1};
  const std::vector<double> at = {0.1, 0.2, 0.5, 1.0, 2.0, 2.6, 2.9, 4.0};
  const Curve found = curve(gent, Deformation::uniaxial, at);
  // I1 - 3 = l^2 + 2 / l - 3 reaches 5 at these.
  ASSERT_EQ(found.ends.size(), 2U);
  for (const double end : found.ends) EXPECT_NEAR(end * end + 2 / end - 3, 5, 1e-6);
  EXPECT_LT(found.ends[0], 0.5);
  EXPECT_GT(found.ends[1], 2.6);
  for (std::size_t n = 0; n < at.size(); ++n) {
    const bool inside = at[n] > found.ends[0] && at[n] < found.ends[1];
    EXPECT_EQ(std::isfinite(found.stress[n]), inside) << at[n];
    if (inside) {
      EXPECT_EQ(found.stress[n], state_at(gent, Deformation::uniaxial, at[n])->stress);
    }
  }
  EXPECT_TRUE(curve(gent, Deformation::uniaxial, {1.5, 2}).ends.empty());
  EXPECT_TRUE(std::isnan(curve(gent, Deformation::equibiaxial, {3.0}).stress[0]));
  // A sheet of it collapses where 1 - nu (l^2 - 1) is 0.
  const Curve thin = curve({"", StVenantKirchhoff{{2.5, 0.25}}, 1}, Deformation::uniaxial, {2, 2.5});
  ASSERT_EQ(thin.ends.size(), 1U);
  EXPECT_NEAR(thin.ends[0], std::sqrt(5), 1e-3);
}

}  // namespace
}  // namespace riven::testing
