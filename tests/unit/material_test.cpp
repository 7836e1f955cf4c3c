// Every law of the table in support/laws.hpp: derivatives, tangents, objectivity, closed forms, waves.

#include "material/material.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <map>

#include "support/differences.hpp"
#include "support/laws.hpp"
#include "support/random.hpp"

namespace riven::testing {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;

constexpr unsigned kSeed = 20240901;
constexpr int kSamples = 30;

Matrix3d random_rotation(Random& random) {
  return Eigen::Quaterniond(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1),
                            random.between(0.1, 1))
      .normalized()
      .toRotationMatrix();
}

/// Any deformation gradient with stretches in the range.
Matrix3d random_gradient(Random& random, double low, double high) {
  const Eigen::Vector3d l(random.between(low, high), random.between(low, high), random.between(low, high));
  return random_rotation(random) * l.asDiagonal() * random_rotation(random);
}

Matrix3d in_space(const Matrix2d& f, double thickness) {
  Matrix3d whole = Matrix3d::Identity();
  whole.topLeftCorner<2, 2>() = f;
  whole(2, 2) = thickness;
  return whole;
}

/// W of a solid, independently of Material: a rubber's isochoric energy and that of its change of volume.
double energy_of(const LawCase& law, const Matrix3d& f) {
  if (!law.is_rubber()) return law.energy(f);
  const double j = f.determinant(), k = law.compressible().volumetric->bulk_modulus;
  return law.energy(std::cbrt(1 / j) * f) + 0.5 * k * (j - 1) * (j - 1);
}

class InvariantLawOf : public ::testing::TestWithParam<LawCase> {};
INSTANTIATE_TEST_SUITE_P(Materials, InvariantLawOf, ::testing::ValuesIn(invariant_laws()), law_name);

TEST_P(InvariantLawOf, DerivativesAreThoseOfItsEnergy) {
  const LawCase& law = GetParam();
  Random random(kSeed);
  // Five points are exact for polynomials up to degree 4; the rest is rounding of 1e-16 W / h, and for
  // laws that are none h^4 W^(5) / 30.
  const double h = 1e-2, tolerance = 1e-9 * law.shear_modulus;
  for (int n = 0; n < kSamples; ++n) {
    const double i1 = random.between(3, 12), i2 = random.between(3, 12);
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", I1 " << i1 << ", I2 " << i2);
    const auto along1 = [&](auto member) {
      return derivative([&](double x) { return law.at(x, i2).*member; }, i1, h);
    };
    const auto along2 = [&](auto member) {
      return derivative([&](double x) { return law.at(i1, x).*member; }, i2, h);
    };
    const InvariantEnergy e = law.at(i1, i2);
    EXPECT_NEAR(e.w1, along1(&InvariantEnergy::w), tolerance);
    EXPECT_NEAR(e.w2, along2(&InvariantEnergy::w), tolerance);
    EXPECT_NEAR(e.w11, along1(&InvariantEnergy::w1), tolerance);
    EXPECT_NEAR(e.w12, along1(&InvariantEnergy::w2), tolerance);
    EXPECT_NEAR(e.w12, along2(&InvariantEnergy::w1), tolerance);
    EXPECT_NEAR(e.w22, along2(&InvariantEnergy::w2), tolerance);
  }
}

class EveryLaw : public ::testing::TestWithParam<LawCase> {
 protected:
  const LawCase& law() const { return GetParam(); }
  double mu() const { return law().shear_modulus; }
};
INSTANTIATE_TEST_SUITE_P(Materials, EveryLaw, ::testing::ValuesIn(law_cases()), law_name);

class EveryRubber : public EveryLaw {};
INSTANTIATE_TEST_SUITE_P(Materials, EveryRubber,
                         ::testing::ValuesIn(laws_that([](const LawCase& c) { return c.is_rubber(); })),
                         law_name);

class EveryObjectiveLaw : public EveryLaw {};
INSTANTIATE_TEST_SUITE_P(Materials, EveryObjectiveLaw, ::testing::ValuesIn(laws_that([](const LawCase& c) {
                           return c.material().objective();
                         })),
                         law_name);

/// Holds a response to differences of energies and of its own stress.
template <int D, class Respond, class Energy>
void expect_derivatives(const Eigen::Matrix<double, D, D>& f, const Respond& respond, const Energy& energy,
                        double mu, double tolerance) {
  const double h = 1e-3;
  const auto r = respond(f);
  const double scale = mu + r.tangent.norm();
  EXPECT_NEAR(r.energy, energy(f), 1e-12 * (mu + scale)) << f;
  EXPECT_LT((r.tangent - r.tangent.transpose()).norm(), 1e-9 * scale) << f;
  for (int i = 0; i < D; ++i)
    for (int J = 0; J < D; ++J) {
      const auto moved = [&](double value) {
        auto g = f;
        g(i, J) = value;
        return g;
      };
      EXPECT_NEAR(r.stress(i, J), derivative([&](double x) { return energy(moved(x)); }, f(i, J), h),
                  tolerance * scale)
          << f;
      const Eigen::Matrix<double, D, D> column =
          derivative([&](double x) { return respond(moved(x)).stress; }, f(i, J), h);
      for (int k = 0; k < D; ++k)
        for (int L = 0; L < D; ++L)
          EXPECT_NEAR(r.tangent(D * k + L, D * i + J), column(k, L), tolerance * scale) << f;
    }
}

// The error of the differences is h^4 W^(5) / 30. Measured: 2e-9 of the scale at most (nearly incompressible
// laws in space).
TEST_P(EveryLaw, StressAndTangentAreDerivativesInSpace) {
  Random random(kSeed + 1);
  const Material material = law().compressible();
  for (int n = 0; n < kSamples; ++n)
    expect_derivatives<3>(
        random_gradient(random, 0.8, 1.6), [&](const Matrix3d& f) { return material.solid(f); },
        [&](const Matrix3d& f) { return energy_of(law(), f); }, mu(), 1e-7);
}

TEST_P(EveryLaw, StressAndTangentAreDerivativesInPlaneStrain) {
  Random random(kSeed + 2);
  const Material material = law().compressible();
  for (int n = 0; n < kSamples; ++n)
    expect_derivatives<2>(
        random.gradient(0.8, 1.6), [&](const Matrix2d& f) { return material.plane_strain(f); },
        [&](const Matrix2d& f) { return energy_of(law(), in_space(f, 1)); }, mu(), 1e-7);
}

// The energy of a sheet is the least over its thicknesses: the one without stress across.
TEST_P(EveryLaw, StressAndTangentAreDerivativesInPlaneStress) {
  Random random(kSeed + 3);
  const Material material = law().compressible();
  for (int n = 0; n < kSamples; ++n) {
    const Matrix2d f = random.gradient(0.8, 1.6);
    expect_derivatives<2>(
        f, [&](const Matrix2d& g) { return material.plane_stress(g); },
        [&](const Matrix2d& g) { return energy_of(law(), in_space(g, material.thickness_stretch(g))); }, mu(),
        1e-7);
    // Rounding of stresses of the size of the bulk modulus.
    const Response r = material.solid(in_space(f, material.thickness_stretch(f)));
    EXPECT_LT(std::abs(r.stress(2, 2)), 1e-12 * r.tangent.norm()) << f;
    EXPECT_LT((material.plane_stress(f).stress - r.stress.topLeftCorner<2, 2>()).norm(),
              1e-12 * r.tangent.norm())
        << f;
  }
}

// Difference quotients between principal stretches have a limit of their own where these are equal, and lose
// digits where they nearly are.
TEST_P(EveryLaw, StressAndTangentAreDerivativesWhereStretchesMeet) {
  Random random(kSeed + 9);
  const Material material = law().compressible();
  for (const double gap : {0.0, 1e-9, 3e-6, 3e-5, 1e-3}) {
    const Eigen::Vector3d l(1.3, 1.3 + gap, 0.8);
    expect_derivatives<3>(
        random_rotation(random) * l.asDiagonal() * random_rotation(random),
        [&](const Matrix3d& f) { return material.solid(f); },
        [&](const Matrix3d& f) { return energy_of(law(), f); }, mu(), 1e-7);
    if (!law().is_rubber()) continue;
    const Material sheet = law().material();
    expect_derivatives<2>(
        random.rotation() * l.head(2).asDiagonal() * random.rotation(),
        [&](const Matrix2d& f) { return sheet.plane_stress(f); },
        [&](const Matrix2d& f) { return law().energy(in_space(f, 1 / f.determinant())); }, mu(), 1e-7);
  }
}

TEST_P(EveryRubber, IncompressibleSheetHasTheDerivativesOfItsEnergy) {
  Random random(kSeed + 4);
  const Material material = law().material();
  for (int n = 0; n < kSamples; ++n)
    expect_derivatives<2>(
        random.gradient(0.7, 2), [&](const Matrix2d& f) { return material.plane_stress(f); },
        [&](const Matrix2d& f) { return law().energy(in_space(f, 1 / f.determinant())); }, mu(), 1e-7);
}

TEST_P(EveryRubber, IsTheIncompressibleSheetForALargeBulkModulus) {
  Random random(kSeed + 5);
  Material nearly = law().material();
  for (int n = 0; n < kSamples; ++n) {
    const Matrix2d f = random.gradient(0.8, 1.5);
    const PlaneResponse limit = law().material().plane_stress(f);
    const auto error = [&](double bulk) {
      nearly.volumetric = Volumetric{bulk * mu(), Volumetric::Form::logarithmic};
      return (nearly.plane_stress(f).stress - limit.stress).norm();
    };
    // The pressure over the bulk modulus: a hundredth when that is a hundred times larger.
    EXPECT_LT(error(1e6), 1e-5 * limit.tangent.norm());
    EXPECT_LT(error(1e6), 0.02 * error(1e4) + 1e-9 * limit.tangent.norm());
  }
}

TEST_P(EveryObjectiveLaw, DoesNotSeeRotations) {
  Random random(kSeed + 6);
  const Material material = law().compressible();
  for (int n = 0; n < kSamples; ++n) {
    const Matrix3d f = random_gradient(random, 0.7, 2), q = random_rotation(random);
    const Response plain = material.solid(f), observed = material.solid(q * f),
                   turned = material.solid(f * q);
    const double tolerance = 1e-12 * (mu() + plain.tangent.norm());  // rounding
    EXPECT_NEAR(observed.energy, plain.energy, tolerance) << "seed " << kSeed + 6;
    EXPECT_NEAR(turned.energy, plain.energy, tolerance);
    EXPECT_LT((observed.stress - q * plain.stress).norm(), tolerance);
    EXPECT_LT((turned.stress - plain.stress * q).norm(), tolerance);
  }
}

TEST(LinearElasticLaw, IsNotObjective) {
  const Material material{"", LinearElastic{{2.5, 0.25}}, 1};
  const Matrix3d turned = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  // The strain cos(t) - 1 = -t^2 / 2 along two axes: 2 (lambda + mu) times it.
  EXPECT_NEAR(material.solid(turned).stress(0, 0), -4 * 0.5e-4, 1e-7);
  EXPECT_FALSE(material.objective());
}

TEST_P(EveryLaw, RestsWithoutStressAndHasItsModuli) {
  const Material material = law().compressible();
  const SmallStrain moduli = material.small_strain();
  EXPECT_NEAR(moduli.shear, mu(), 1e-14 * mu());
  if (!law().is_rubber()) {
    EXPECT_NEAR(moduli.bulk, law().bulk_modulus, 1e-14 * moduli.bulk);
  }
  const Response rest = material.solid(Matrix3d::Identity());
  EXPECT_NEAR(rest.energy, 0, 1e-15 * mu());
  EXPECT_LE(rest.stress.norm(), 1e-14 * moduli.bulk);
  Response::Tangent hooke = Response::Tangent::Zero();
  const double lambda = moduli.bulk - 2.0 / 3 * moduli.shear;
  for (int i = 0; i < 3; ++i)
    for (int J = 0; J < 3; ++J)
      for (int k = 0; k < 3; ++k)
        for (int L = 0; L < 3; ++L)
          hooke(3 * i + J, 3 * k + L) =
              lambda * (i == J && k == L ? 1 : 0) +
              moduli.shear * ((i == k && J == L ? 1 : 0) + (i == L && J == k ? 1 : 0));
  EXPECT_LT((rest.tangent - hooke).norm(), 1e-12 * hooke.norm());  // rounding
  const double e = moduli.youngs_modulus(), nu = moduli.poissons_ratio();
  EXPECT_NEAR(moduli.shear, e / (2 * (1 + nu)), 1e-14 * mu());
  EXPECT_NEAR(moduli.bulk, e / (3 * (1 - 2 * nu)), 1e-12 * moduli.bulk);
  // Plane stress: E / (1 - nu^2) along, nu of it across.
  const PlaneResponse sheet = material.plane_stress(Matrix2d::Identity());
  EXPECT_NEAR(sheet.tangent(0, 0), e / (1 - nu * nu), 1e-12 * moduli.bulk);
  EXPECT_NEAR(sheet.tangent(0, 3), nu * e / (1 - nu * nu), 1e-12 * moduli.bulk);
}

// Five digits are given.
TEST_P(EveryLaw, FollowsTheCurvesOfItsSource) {
  for (const NominalStresses& row : law().curves) {
    const double l = row.stretch;
    const auto stress = [&](double across) {
      return law().material().plane_stress(Eigen::Vector2d(l, across).asDiagonal()).stress(0, 0);
    };
    const double digits = 6e-6 * mu();
    EXPECT_NEAR(stress(1 / std::sqrt(l)), row.uniaxial, digits + 1e-5 * std::abs(row.uniaxial)) << l;
    EXPECT_NEAR(stress(l), row.equibiaxial, digits + 1e-5 * std::abs(row.equibiaxial)) << l;
    EXPECT_NEAR(stress(1), row.planar, digits + 1e-5 * std::abs(row.planar)) << l;
  }
}

TEST_P(EveryLaw, CarriesWavesAtTheSpeedsOfItsAcousticTensor) {
  Random random(kSeed + 7);
  const Material material = law().compressible(1100);
  const SmallStrain moduli = material.small_strain();
  const Eigen::Vector3d rest = wave_speeds(material, Matrix3d::Identity(), {0.6, 0, 0.8});
  EXPECT_NEAR(rest(0), std::sqrt(moduli.shear / 1100), 1e-12 * rest(2));
  EXPECT_NEAR(rest(1), std::sqrt(moduli.shear / 1100), 1e-12 * rest(2));
  EXPECT_NEAR(rest(2), std::sqrt(moduli.longitudinal() / 1100), 1e-12 * rest(2));
  // The trace of the acoustic tensor is the sum of second differences of the energy under shears along n.
  for (int n = 0; n < kSamples; ++n) {
    const Matrix3d f = random_gradient(random, 0.8, 1.5);
    const Eigen::Vector3d direction = random_rotation(random).col(0);
    double trace = 0;
    const double h = 1e-3;
    for (int i = 0; i < 3; ++i) {
      const Matrix3d step = h * Eigen::Vector3d::Unit(i) * direction.transpose();
      trace += (energy_of(law(), f + step) - 2 * energy_of(law(), f) + energy_of(law(), f - step)) / (h * h);
    }
    const Eigen::Vector3d speeds = wave_speeds(material, f, direction);
    double sum = 0;
    for (const double speed : speeds) sum += 1100 * speed * std::abs(speed);
    // h^2 W'''' / 12
    EXPECT_NEAR(sum, trace, 2e-5 * (trace + material.solid(f).tangent.norm()));
  }
}

TEST_P(EveryLaw, AnswersManyGradientsAsItDoesOne) {
  Random random(kSeed + 8);
  const Material material = law().compressible();
  constexpr std::size_t n = 9;
  std::vector<std::vector<double>> f(9, std::vector<double>(n)), p = f;
  std::vector<double> energy(n);
  std::vector<Matrix3d> gradients;
  for (std::size_t i = 0; i < n; ++i) {
    gradients.push_back(random_gradient(random, 0.8, 1.5));
    if (i == 4 && material.objective()) gradients.back().col(0) *= -1;  // turned over
    for (std::size_t c = 0; c < 9; ++c)
      f[c][i] = gradients[i](static_cast<int>(c / 3), static_cast<int>(c % 3));
  }
  const double* from[9];
  double* to[9];
  for (std::size_t c = 0; c < 9; ++c) {
    from[c] = f[c].data();
    to[c] = p[c].data();
  }
  EXPECT_EQ(material.stress(Kinematics::solid, n, from, to, energy.data()), material.objective() ? 1U : 0U);
  for (std::size_t i = 0; i < n; ++i) {
    const Response r = material.solid(gradients[i]);
    if (i == 4 && material.objective()) {
      EXPECT_TRUE(std::isnan(energy[i]));
      continue;
    }
    EXPECT_EQ(energy[i], r.energy);
    for (std::size_t c = 0; c < 9; ++c)
      EXPECT_EQ(p[c][i], r.stress(static_cast<int>(c / 3), static_cast<int>(c % 3)));
  }
}

// The case format has one key for laws that use the same name: it must be the same kind of number, and a
// default of one law must not fill in where another law wants the key, or one of several, to be given.
TEST(ParametersOfLaws, AgreeWhereTheyShareAName) {
  struct Use {
    std::string law;
    bool is_list;
    ParameterKind kind;
  };
  std::map<std::string, std::vector<Use>> uses;
  for_each_law([&]<class L>(L law) {
    L::each_parameter(law, [&]<class Member>(const char* name, Member&, const ParameterKind& kind) {
      uses[name].push_back({L::name, !std::is_same_v<Member, double>, kind});
    });
  });
  for (const auto& [name, laws] : uses)
    for (const Use& a : laws)
      for (const Use& b : laws) {
        SCOPED_TRACE(name + " of " + a.law + " and " + b.law);
        EXPECT_EQ(a.is_list, b.is_list);
        EXPECT_EQ(a.kind.unit, b.kind.unit);
        EXPECT_EQ(a.kind.range, b.kind.range);
        EXPECT_FALSE(a.kind.fallback && b.kind.factor);
        EXPECT_TRUE(!a.kind.fallback || !b.kind.fallback || *a.kind.fallback == *b.kind.fallback);
      }
}

// Theory note, "Numbers to test against"; the digits given.
TEST(MooneyRivlinLaw, HasTheNumbersOfItsSource) {
  const Material material{"", MooneyRivlin{1, 0.5}, 1, Volumetric{500, Volumetric::Form::quadratic}};
  const Matrix3d f{{1.2, 0.1, 0}, {0, 0.95, 0.05}, {0.1, 0, 0.9}};
  const Response r = material.solid(f);
  EXPECT_NEAR(r.energy, 0.349489, 1e-6);
  const Matrix3d s = f.inverse() * r.stress;
  EXPECT_NEAR(s(0, 0), 10.259797, 1e-6);
  EXPECT_NEAR(s(1, 1), 14.642840, 1e-6);
  EXPECT_NEAR(s(0, 1), -0.951903, 1e-6);
  const PlaneResponse sheet = material.plane_stress(Matrix2d{{1.6, 0.3}, {-0.1, 0.9}});
  EXPECT_NEAR(material.thickness_stretch(Matrix2d{{1.6, 0.3}, {-0.1, 0.9}}), 0.683762, 1e-6);
  EXPECT_LT((sheet.stress - Matrix2d{{3.689025, 0.710258}, {-0.164741, 1.779715}}).norm(), 2e-6);
  EXPECT_NEAR(sheet.tangent(0, 0), 4.257424, 1e-6);
  EXPECT_NEAR(sheet.tangent(1, 1), 2.464029, 1e-6);
  EXPECT_NEAR(sheet.tangent(0, 3), 4.053917, 1e-6);
}

// 1 + 2 E33 = 1 - 2 nu / (1 - nu) (E11 + E22) is below 0: no thickness is free of stress.
TEST(StVenantKirchhoffLaw, HasNoSheetThatIsThinnerThanNothing) {
  const Material material{"", StVenantKirchhoff{{1, 0.3}}, 1};
  EXPECT_TRUE(std::isnan(material.plane_stress(Matrix2d{{1.48, 0}, {0, 1.48}}).energy));
  const double l = 1.2, e = 0.5 * (l * l - 1);
  EXPECT_NEAR(material.thickness_stretch(Matrix2d{{l, 0}, {0, l}}), std::sqrt(1 - 4 * 0.3 / 0.7 * e), 1e-12);
}

TEST(GentLaw, SaysNothingBeyondItsLimit) {
  const Material material{"", Gent{1, 5}, 1};
  EXPECT_TRUE(std::isfinite(material.plane_stress(Matrix2d{{2.5, 0}, {0, 0.7}}).energy));
  EXPECT_TRUE(std::isnan(material.plane_stress(Matrix2d{{3.5, 0}, {0, 0.7}}).stress(0, 0)));
}

}  // namespace
}  // namespace riven::testing
