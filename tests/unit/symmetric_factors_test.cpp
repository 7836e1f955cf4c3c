#include "linalg/symmetric_factors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "support/matrices.hpp"
#include "support/random.hpp"

namespace riven::testing {
namespace {

/// Symmetric with a few entries per row, many on the diagonal near zero: pivots of two rows are needed.
Eigen::MatrixXd random_matrix(Random& random, int n, double middle) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  for (int entry = 0; entry < 4 * n; ++entry) {
    const int i = random.integer(0, n - 1), j = random.integer(0, n - 1);
    if (i != j) a(i, j) += random.between(-1, 1);
  }
  a = (a + a.transpose()).eval();
  a.diagonal().array() += middle;
  return a;
}

TEST(SymmetricFactors, CountNegativeEigenvaluesAndSolve) {
  int both = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    const int n = random.integer(1, 80);
    const Eigen::MatrixXd a = random_matrix(random, n, random.between(-3, 3) * (seed % 3 == 0 ? 1e-9 : 1));
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a).eigenvalues();
    const double least = values.cwiseAbs().minCoeff();
    if (least < 1e-6) continue;  // singular, nearly
    const SymmetricMatrix m = sparse(a);
    SymmetricFactors factors;
    factors.analyse(m);
    ASSERT_TRUE(factors.factor(m)) << seed;
    const auto negative = (values.array() < 0).count();
    EXPECT_EQ(factors.negative(), negative) << seed;
    both += negative > 0 && negative < n ? 1 : 0;
    const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
    Eigen::VectorXd x = b;
    factors.solve({x.data(), static_cast<std::size_t>(n)});
    // Rounding times the condition.
    EXPECT_LT((a * x - b).norm(), 1e-13 * b.norm() * values.cwiseAbs().maxCoeff() / least) << seed;
  }
  EXPECT_GT(both, 30);
}

TEST(SymmetricFactors, TellSingularMatrices) {
  const SymmetricMatrix zero = sparse(Eigen::MatrixXd::Zero(4, 4));
  SymmetricFactors factors;
  factors.analyse(zero);
  EXPECT_FALSE(factors.factor(zero));
}

TEST(SymmetricFactors, TakeAnEmptySystem) {
  const SymmetricMatrix none;
  SymmetricFactors factors;
  factors.analyse(none);
  EXPECT_TRUE(factors.factor(none));
  EXPECT_EQ(factors.negative(), 0);
  factors.solve({});
}

}  // namespace
}  // namespace riven::testing
