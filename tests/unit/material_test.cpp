#include "material/material.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "support/differences.hpp"
#include "support/laws.hpp"
#include "support/random.hpp"

namespace riven::testing {
namespace {

constexpr unsigned kSeed = 20240901;
constexpr int kSamples = 50;

class Law : public ::testing::TestWithParam<LawCase> {
 protected:
  const LawCase& law() const { return GetParam(); }
  double mu() const { return law().shear_modulus; }
};

INSTANTIATE_TEST_SUITE_P(Materials, Law, ::testing::ValuesIn(law_cases()), law_name);

TEST_P(Law, DerivativesAreThoseOfItsEnergy) {
  Random random(kSeed);
  // Five points are exact for polynomials up to degree 4; the rest is rounding of 1e-16 W / h. Measured:
  // 1.3e-13 mu for the first and second derivatives; the bound leaves room for laws that are no polynomials.
  const double h = 1e-2, tolerance = 1e-9 * mu();
  for (int n = 0; n < kSamples; ++n) {
    const double i1 = random.between(3, 12), i2 = random.between(3, 12);
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", I1 " << i1 << ", I2 " << i2);
    const auto along1 = [&](auto member) {
      return derivative([&](double x) { return law().at(x, i2).*member; }, i1, h);
    };
    const auto along2 = [&](auto member) {
      return derivative([&](double x) { return law().at(i1, x).*member; }, i2, h);
    };
    const InvariantEnergy e = law().at(i1, i2);
    EXPECT_NEAR(e.w, law().energy(i1, i2), 1e-13 * (mu() + std::abs(e.w)));  // 2e-16 of it measured
    EXPECT_NEAR(e.w1, along1(&InvariantEnergy::w), tolerance);
    EXPECT_NEAR(e.w2, along2(&InvariantEnergy::w), tolerance);
    EXPECT_NEAR(e.w11, along1(&InvariantEnergy::w1), tolerance);
    EXPECT_NEAR(e.w12, along1(&InvariantEnergy::w2), tolerance);
    EXPECT_NEAR(e.w12, along2(&InvariantEnergy::w1), tolerance);
    EXPECT_NEAR(e.w22, along2(&InvariantEnergy::w2), tolerance);
  }
}

/// Energy, independently of Material: invariants from the eigenvalues of C.
double energy_of(const LawCase& law, const Eigen::Matrix2d& f) {
  const Eigen::Matrix2d c = f.transpose() * f;
  const double mean = 0.5 * (c(0, 0) + c(1, 1)), half = std::hypot(0.5 * (c(0, 0) - c(1, 1)), c(0, 1));
  const double x = mean + half, y = mean - half, z = 1 / (x * y);
  return law.energy(x + y + z, x * y + y * z + z * x);
}

TEST_P(Law, StressAndTangentAreDerivativesOfTheEnergy) {
  Random random(kSeed + 1);
  // The error is h^4 W^(5) / 30, large where det F is small. Measured: 8e-12 of the scale for stress, 9e-11
  // for the tangent.
  const double h = 1e-3, tolerance = 1e-8;
  for (int n = 0; n < kSamples; ++n) {
    const Eigen::Matrix2d f = random.gradient(0.7, 2.5);
    const PlaneResponse response = law().material().plane_stress(f);
    const double scale = mu() + response.tangent.norm();
    EXPECT_NEAR(response.energy, energy_of(law(), f), 1e-12 * (mu() + response.energy))
        << "seed " << kSeed + 1;
    for (int i = 0; i < 2; ++i)
      for (int J = 0; J < 2; ++J) {
        const auto moved = [&](double value) {
          Eigen::Matrix2d g = f;
          g(i, J) = value;
          return g;
        };
        const double stress = derivative([&](double x) { return energy_of(law(), moved(x)); }, f(i, J), h);
        EXPECT_NEAR(response.stress(i, J), stress, tolerance * scale) << "seed " << kSeed + 1 << "\n" << f;
        const Eigen::Matrix2d tangent =
            derivative([&](double x) { return law().material().plane_stress(moved(x)).stress; }, f(i, J), h);
        for (int k = 0; k < 2; ++k)
          for (int L = 0; L < 2; ++L)
            EXPECT_NEAR(response.tangent(2 * k + L, 2 * i + J), tangent(k, L), tolerance * scale);
      }
  }
}

TEST_P(Law, DoesNotSeeRotationsOfTheObserverOrOfTheMaterial) {
  Random random(kSeed + 2);
  for (int n = 0; n < kSamples; ++n) {
    const Eigen::Matrix2d f = random.gradient(0.6, 3), q = random.rotation();
    const Material material = law().material();
    const PlaneResponse plain = material.plane_stress(f), observed = material.plane_stress(q * f),
                        turned = material.plane_stress(f * q);
    // Rounding of products of 2x2 matrices; measured 4e-16 of the scale.
    const double tolerance = 1e-13 * (mu() + plain.stress.norm() + plain.energy) * (1 + f.inverse().norm());
    EXPECT_NEAR(observed.energy, plain.energy, tolerance) << "seed " << kSeed + 2;
    EXPECT_NEAR(turned.energy, plain.energy, tolerance);
    EXPECT_LT((observed.stress - q * plain.stress).norm(), tolerance);
    EXPECT_LT((turned.stress - plain.stress * q).norm(), tolerance);
  }
}

TEST_P(Law, FollowsTheClosedFormsOfIncompressibleSheets) {
  for (const double l : {0.6, 0.9, 1.0, 1.3, 2.0, 3.5}) {
    // Rounding only; measured 3e-16 of the stress scale mu + W1 + W2 l^2 times l.
    const auto check = [&](const Eigen::Vector2d& stretch, double i1, double i2, auto px, auto py) {
      const InvariantEnergy e = law().at(i1, i2);
      const PlaneResponse r = law().material().plane_stress(stretch.asDiagonal());
      const double scale = (mu() + std::abs(e.w1) + std::abs(e.w2) * (1 + l * l)) * (l + std::pow(l, -5));
      EXPECT_NEAR(r.stress(0, 0), px(e), 1e-13 * scale) << "stretch " << l;
      EXPECT_NEAR(r.stress(1, 1), py(e), 1e-13 * scale) << "stretch " << l;
      EXPECT_NEAR(r.stress(0, 1), 0, 1e-13 * scale);
      EXPECT_NEAR(r.stress(1, 0), 0, 1e-13 * scale);
    };
    const double m2 = std::pow(l, -2), m3 = std::pow(l, -3), m4 = std::pow(l, -4), m5 = std::pow(l, -5);
    check(
        {l, 1 / std::sqrt(l)}, l * l + 2 / l, 2 * l + m2,  // uniaxial
        [&](auto& e) { return 2 * (l - m2) * (e.w1 + e.w2 / l); }, [](auto&) { return 0.0; });
    check(
        {l, 1}, l * l + 1 + m2, l * l + 1 + m2,  // planar
        [&](auto& e) { return 2 * (l - m3) * (e.w1 + e.w2); },
        [&](auto& e) { return 2 * (1 - m2) * (e.w1 + l * l * e.w2); });
    const auto equibiaxial = [&](auto& e) { return 2 * (l - m5) * (e.w1 + l * l * e.w2); };
    check({l, l}, 2 * l * l + m4, std::pow(l, 4) + 2 * m2, equibiaxial, equibiaxial);
  }
}

TEST_P(Law, RestsWithoutStressAndHasItsShearModulus) {
  EXPECT_DOUBLE_EQ(shear_modulus(law().law), law().shear_modulus);
  const PlaneResponse rest = law().material().plane_stress(Eigen::Matrix2d::Identity());
  EXPECT_EQ(rest.energy, 0);
  EXPECT_LE(rest.stress.norm(), 1e-15 * mu());  // 0 measured
  // Linear elasticity at nu = 1/2, plane stress: C11 = 4 mu, C12 = 2 mu, C66 = mu; the rotation costs
  // nothing.
  Eigen::Matrix4d linear = Eigen::Matrix4d::Zero();
  linear(0, 0) = linear(3, 3) = 4;
  linear(0, 3) = linear(3, 0) = 2;
  linear(1, 1) = linear(1, 2) = linear(2, 1) = linear(2, 2) = 1;
  EXPECT_LT((rest.tangent / mu() - linear).norm(), 1e-14);  // 0 measured
}

}  // namespace
}  // namespace riven::testing
