#include "spacetime/temporal_basis.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>

#include "spacetime/slab_operator.hpp"
#include "spacetime/slab_scheme.hpp"

namespace riven::testing {
namespace {

constexpr double kRounding = 1e-14;

TEST(TemporalBasis, HasTheFunctionsOfTheNote) {
  const QuadraticLagrange basis(0.5);
  for (const double s : {0.0, 0.1, 0.5, 0.77, 1.0}) {
    EXPECT_NEAR(basis.value(0, s), (2 * s - 1) * (s - 1), kRounding);
    EXPECT_NEAR(basis.value(1, s), 4 * s * (1 - s), kRounding);
    EXPECT_NEAR(basis.value(2, s), s * (2 * s - 1), kRounding);
    EXPECT_NEAR(basis.first(0, s), 4 * s - 3, kRounding);
    EXPECT_NEAR(basis.first(1, s), 4 - 8 * s, kRounding);
    EXPECT_NEAR(basis.first(2, s), 4 * s - 1, kRounding);
    EXPECT_NEAR(basis.second(0, s), 4, kRounding);
    EXPECT_NEAR(basis.second(1, s), -8, kRounding);
    EXPECT_NEAR(basis.second(2, s), 4, kRounding);
  }
}

TEST(GaussRule, IntegratesPolynomialsExactly) {
  for (std::size_t n = 1; n <= 8; ++n) {
    const TemporalRule rule = gauss_rule(n);
    for (std::size_t degree = 0; degree <= 2 * n; ++degree) {
      double sum = 0;
      for (std::size_t q = 0; q < n; ++q)
        sum += rule.weight[q] * std::pow(rule.point[q], static_cast<double>(degree));
      const double error = std::abs(sum - 1 / static_cast<double>(degree + 1));
      if (degree < 2 * n)
        EXPECT_LT(error, kRounding) << n << ", " << degree;
      else
        EXPECT_GT(error, 1e-11) << n;  // (n!)^4 / ((2n + 1) (2n)!^2)
    }
  }
}

// Theory (3), from two points on.
TEST(TemporalMatrices, AreThoseOfTheNote) {
  Eigen::Matrix3d a, b;
  a << 5, -4, -1, -12, 16, -4, 7, -12, 5;
  b << 3, -4, 1, 4, 0, -4, -1, 4, 3;
  for (std::size_t points = 2; points <= 6; ++points) {
    const TemporalMatrices matrices = temporal_matrices(QuadraticLagrange(0.5), gauss_rule(points));
    EXPECT_LT((matrices.inertia - a).cwiseAbs().maxCoeff(), 10 * kRounding);
    EXPECT_LT((matrices.stiffness - b / 6).cwiseAbs().maxCoeff(), kRounding);
    for (const double z : {0.1, 1.0, 7.0, 100.0}) {
      const double expected = 4.0 / 9 * z * (z * z + 6 * z + 72);
      EXPECT_NEAR((matrices.inertia + z * matrices.stiffness).determinant() / expected, 1, 1e-12);
    }
    EXPECT_NEAR(matrices.stiffness.determinant(), 4.0 / 9, kRounding);
  }
}

TEST(SlabScheme, HasTheMatricesOfTheNote) {
  const SlabScheme two = two_field_scheme();
  EXPECT_LT((two.inertia - (Eigen::Matrix2d() << 0, 2, -18, 4).finished()).norm(), 10 * kRounding);
  EXPECT_LT((two.start - Eigen::Vector2d(2, -2)).norm(), kRounding);
  EXPECT_LT((two.stiffness() - Eigen::Matrix2d::Identity()).norm(), kRounding);
  for (std::size_t points = 2; points <= 6; ++points) {
    const SlabScheme single = single_field_scheme(points);
    EXPECT_LT((single.inertia - (Eigen::Matrix2d() << 16, -4, -12, 5).finished()).norm(), 20 * kRounding);
    EXPECT_LT((single.start - Eigen::Vector2d(4, -1)).norm(), kRounding);
    EXPECT_LT((6 * single.stiffness() - (Eigen::Matrix2d() << 0, -4, 4, 3).finished()).norm(),
              10 * kRounding);
  }
}

TEST(SlabMode, HasTheEigenvaluesOfTheNote) {
  const SlabMode single = mode_of(single_field_scheme(3)), two = mode_of(two_field_scheme());
  EXPECT_LT(std::abs(single.lambda - std::complex<double>(3, 3 * std::sqrt(7))), 10 * kRounding);
  EXPECT_LT(std::abs(two.lambda - std::complex<double>(2, 4 * std::sqrt(2))), 10 * kRounding);
}

}  // namespace
}  // namespace riven::testing
