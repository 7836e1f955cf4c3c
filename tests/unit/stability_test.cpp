// Where laws lose their stability: closed forms, and energies along all rank-one changes of the gradient.

#include "material/stability.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "support/laws.hpp"
#include "support/random.hpp"

namespace riven::testing {
namespace {

using Kind = Instability::Kind;

/// The one instability of a kind on one side, if any.
std::optional<double> found(const Material& material, Deformation deformation, Kind kind, double to) {
  std::optional<double> at;
  for (const Instability& i : instabilities(material, std::min(to, 1.0), std::max(to, 1.0)))
    if (i.deformation == deformation && i.kind == kind) {
      EXPECT_FALSE(at);
      at = i.stretch;
    }
  return at;
}

/// The root of a function that falls from `low` to `high`.
double root(const std::function<double(double)>& f, double low, double high) {
  EXPECT_GT(f(low), 0);
  EXPECT_LT(f(high), 0);
  for (int n = 0; n < 60; ++n) (f(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
  return low;
}

/// The least second difference of the energy along sampled a (x) n, in D dimensions.
template <int D>
double least_curvature(const std::function<double(const Eigen::Matrix<double, D, D>&)>& energy,
                       const Eigen::Matrix<double, D, D>& f) {
  constexpr double h = 1e-3;
  constexpr int kAngles = 60;
  const auto unit = [](double polar, double around) {
    if constexpr (D == 2) {
      return Eigen::Vector2d(std::cos(polar), std::sin(polar));
    } else {
      return Eigen::Vector3d(std::cos(polar), std::sin(polar) * std::cos(around),
                             std::sin(polar) * std::sin(around));
    }
  };
  double least = INFINITY;
  const double rest = energy(f);
  for (int i = 0; i <= kAngles; ++i)
    for (int j = 0; j < kAngles; ++j)
      for (const double around : {0.0, 0.8, 1.571}) {
        const double n = 0.5 * std::numbers::pi * i / kAngles, a = std::numbers::pi * j / kAngles;
        const Eigen::Matrix<double, D, D> step = h * unit(a, around) * unit(n, around).transpose();
        least = std::min(least, (energy(f + step) - 2 * rest + energy(f - step)) / (h * h));
      }
  return least;
}

// Found independently, to four digits, by the acoustic tensor in another program.
TEST(Stability, OfAMooneyRivlinSolidWithANegativeConstant) {
  const Material material{"", MooneyRivlin{1000, -700}, 1, Volumetric{500, Volumetric::Form::quadratic}};
  EXPECT_NEAR(found(material, Deformation::uniaxial, Kind::ellipticity, 2).value(), 1.2908, 6e-5);
  EXPECT_NEAR(found(material, Deformation::uniaxial, Kind::ellipticity, 0.5).value(), 0.7539, 6e-5);
  EXPECT_FALSE(found(material, Deformation::uniaxial, Kind::ellipticity, 1.29));
  EXPECT_FALSE(found(material, Deformation::uniaxial, Kind::ellipticity, 0.755));
}

TEST(Stability, IsNotLostByLawsThatAreSound) {
  for (const LawCase& law : law_cases())
    if (law.name == "ogden" || law.name.starts_with("neo_hookean") || law.name == "mooney_rivlin" ||
        law.name == "arruda_boyce" || law.name == "gent") {
      EXPECT_TRUE(instabilities(law.material(), 0.5, 3).empty()) << law.name;
    }
}

// Uniaxial, planar and equibiaxial stress are so in S = (a modulus) (l^2 - 1) / 2, too: P = l S falls until
// 3 l^2 = 1. In tension the free stretch vanishes where its Green's strain is -1/2.
TEST(Stability, OfStVenantKirchhoffInClosedForm) {
  const double nu = 0.25;
  const Material material{"", StVenantKirchhoff{{2.5, nu}}, 1};
  for (const Deformation d : {Deformation::uniaxial, Deformation::planar, Deformation::equibiaxial}) {
    EXPECT_NEAR(found(material, d, Kind::stress, 0.4).value(), 1 / std::sqrt(3), 1e-8) << name(d);
    EXPECT_FALSE(found(material, d, Kind::stress, 0.58)) << name(d);
    const double contraction = d == Deformation::uniaxial ? nu
                               : d == Deformation::planar ? nu / (1 - nu)
                                                          : 2 * nu / (1 - nu);
    // The last root is a double one: half of the digits.
    EXPECT_NEAR(found(material, d, Kind::end, 3).value(), std::sqrt(1 + 1 / contraction), 1e-4) << name(d);
  }
  // The acoustic tensor in the plane of the axis and of n = (c, s), x = c^2, with S, the free stretch q and
  // a = lambda + mu: Q = x S 1 + a (F n) (x) (F n) + mu F F^T. Its determinant is a quadratic in x.
  const double mu = 1, a = 2;
  const auto least_determinant = [&](double l) {
    const double s = 2.5 * (l * l - 1) / 2, q = 1 - nu * (l * l - 1), p = l * l;
    double least = INFINITY;
    for (int n = 0; n <= 100000; ++n) {
      const double x = n * 1e-5;
      least = std::min(least, (x * s + a * p * x + mu * p) * (x * s + a * q * (1 - x) + mu * q) -
                                  a * a * p * q * x * (1 - x));
    }
    return -least;
  };
  const double expected = 1 - root([&](double c) { return -least_determinant(1 - c); }, 0.1, 0.6);
  EXPECT_NEAR(found(material, Deformation::uniaxial, Kind::ellipticity, 0.4).value(), expected, 1e-6);
}

TEST(Stability, OfSheetsWhoseStressTurnsBack) {
  const auto rises_to = [](const auto& stress) {
    return root([&](double l) { return stress(l + 1e-6) - stress(l - 1e-6); }, 1.01, 3);
  };
  // Theory note, end of section 2. Differences of h = 1e-6: rounding of 1e-16 / 1e-6.
  const double yeoh =
      rises_to([](double l) { return 2 * (l - 1 / (l * l)) * (1 - 0.2 * (l * l + 2 / l - 3)); });
  EXPECT_NEAR(found({"", Yeoh{1, -0.1, 0}, 1}, Deformation::uniaxial, Kind::stress, 3).value(), yeoh, 1e-6);
  const double mooney = rises_to([](double l) { return 2 * (l - std::pow(l, -5)) * (1 - 0.1 * l * l); });
  EXPECT_NEAR(found({"", MooneyRivlin{1, -0.1}, 1}, Deformation::equibiaxial, Kind::stress, 3).value(),
              mooney, 1e-6);
}

// 1 lies outside of the range; from rest the states beyond it are reached nevertheless, and told once.
TEST(Stability, OfARangeOnOneSide) {
  const Material material{"", Yeoh{1, -0.1, 0}, 1};
  EXPECT_EQ(instabilities(material, 1.5, 3).size(), instabilities(material, 1, 3).size());
  EXPECT_EQ(instabilities(material, 0.4, 0.6).size(), instabilities(material, 0.4, 1).size());
  EXPECT_TRUE(instabilities(material, 1.2, 1.3).empty());
}

// Strong ellipticity says that the energy is convex along every a (x) n. Coarse directions: 1 % beside the
// border.
TEST(Stability, IsLostWhereTheEnergyCeasesToBeConvexAlongRankOne) {
  const LawCase cases[] = {
      {"yeoh", Yeoh{1, -0.1, 0},
       of_invariants([](double i1, double) { return i1 - 3 - 0.1 * std::pow(i1 - 3, 2); }), 2},
      {"mooney", MooneyRivlin{1, -0.15},
       of_invariants([](double i1, double i2) { return i1 - 3 - 0.15 * (i2 - 3); }), 1.7},
  };
  int borders = 0;
  for (const LawCase& law : cases)
    for (const bool sheet : {true, false}) {
      Material material = law.material();
      if (!sheet) material.volumetric = Volumetric{3, Volumetric::Form::quadratic};
      const auto curvature = [&](Deformation deformation, double at) {
        const Eigen::Matrix3d f =
            follow(material, deformation, rest(material, deformation), at).value().gradient;
        if (sheet)
          return least_curvature<2>(
              [&](const Eigen::Matrix2d& g) {
                Eigen::Matrix3d whole = Eigen::Matrix3d::Zero();
                whole.topLeftCorner<2, 2>() = g;
                whole(2, 2) = 1 / g.determinant();
                return law.energy(whole);
              },
              Eigen::Matrix2d(f.topLeftCorner<2, 2>()));
        return least_curvature<3>(
            [&](const Eigen::Matrix3d& g) {
              const double j = g.determinant();
              return law.energy(std::cbrt(1 / j) * g) + 1.5 * (j - 1) * (j - 1);
            },
            f);
      };
      for (const Instability& i : instabilities(material, 0.45, 3)) {
        if (i.kind != Kind::ellipticity) continue;
        SCOPED_TRACE(law.name + ": " + instability_text(i));
        const double away = 0.01 * (i.stretch - 1);
        EXPECT_GT(curvature(i.deformation, i.stretch - away), 0);
        EXPECT_LT(curvature(i.deformation, i.stretch + away), 0);
        ++borders;
      }
    }
  EXPECT_GE(borders, 8);
}

TEST(Stability, LooksAtAllDirections) {
  Random random(20240917);
  const Material solid{"", MooneyRivlin{1, -0.6}, 1, Volumetric{2, Volumetric::Form::quadratic}};
  for (int n = 0; n < 20; ++n) {
    const Eigen::Vector3d l(random.between(0.7, 1.5), random.between(0.7, 1.5), random.between(0.7, 1.5));
    const double least = least_acoustic_eigenvalue(solid, l.asDiagonal());
    double sampled = INFINITY;
    for (int k = 0; k < 3000; ++k) {
      const Eigen::Vector3d direction =
          Eigen::Vector3d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)).normalized();
      const double speed = wave_speeds(solid, l.asDiagonal(), direction)(0);
      sampled = std::min(sampled, speed * std::abs(speed));
    }
    EXPECT_LE(least, sampled + 1e-12);
    EXPECT_NEAR(least, sampled, 0.02);  // of so many samples one comes this near
  }
}

TEST(Stability, IsToldInWords) {
  EXPECT_EQ(instability_text({Deformation::uniaxial, Kind::ellipticity, 1.29083}),
            "in uniaxial tension from a stretch of 1.291 upwards strong ellipticity is lost: deformation may "
            "localise in bands");
  EXPECT_EQ(
      instability_text({Deformation::planar, Kind::stress, 0.57735}),
      "in planar compression from a stretch of 0.5774 downwards the nominal stress does not fall as the "
      "stretch falls");
  EXPECT_EQ(instability_text({Deformation::equibiaxial, Kind::end, 2.5}),
            "in equibiaxial tension from a stretch of 2.5 upwards the law has no answer");
}

}  // namespace
}  // namespace riven::testing
