#include "linalg/cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "support/matrices.hpp"
#include "support/random.hpp"

namespace riven::testing {
namespace {

/// Symmetric with a few entries per row; eigenvalues of a few units about `middle`.
Eigen::MatrixXd random_matrix(Random& random, int n, double middle) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  for (int entry = 0; entry < 3 * n; ++entry) {
    const int i = random.integer(0, n - 1), j = random.integer(0, n - 1);
    a(i, j) += random.between(-1, 1);
  }
  a = (a + a.transpose()).eval();
  a.diagonal().array() += middle;
  return a;
}

TEST(SparseCholesky, SolvesForManyValuesOfOnePattern) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const int n = random.integer(1, 80);
    const Eigen::MatrixXd first = random_matrix(random, n, 20);
    SymmetricMatrix m = sparse(first);
    SparseCholesky cholesky;
    cholesky.analyse(m);
    for (const double factor : {1.0, 3.0, 0.1}) {
      const Eigen::MatrixXd a = factor * first;
      for (std::size_t k = 0; k < m.value.size(); ++k) m.value[k] = sparse(a).value[k];
      ASSERT_TRUE(cholesky.factor(m)) << seed;
      const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
      Eigen::VectorXd x = b;
      cholesky.solve({x.data(), static_cast<std::size_t>(n)});
      EXPECT_LT((a * x - b).norm(), 1e-13 * b.norm()) << seed;  // condition below 10
    }
  }
}

TEST(SparseCholesky, TellsADefiniteMatrixFromOthers) {
  int definite = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    const Eigen::MatrixXd a = random_matrix(random, random.integer(5, 60), random.between(0, 6));
    const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a).eigenvalues()(0);
    const SymmetricMatrix m = sparse(a);
    SparseCholesky cholesky;
    cholesky.analyse(m);
    EXPECT_EQ(cholesky.factor(m), least > 0) << seed << ", least eigenvalue " << least;
    definite += least > 0 ? 1 : 0;
  }
  EXPECT_GT(definite, 10);
  EXPECT_LT(definite, 50);
}

TEST(SparseCholesky, RefusesWhatHasNoEntries) {
  const SymmetricMatrix zero = sparse(Eigen::MatrixXd::Zero(4, 4));
  SparseCholesky cholesky;
  cholesky.analyse(zero);
  EXPECT_FALSE(cholesky.factor(zero));
}

TEST(SparseCholesky, TakesAnEmptySystem) {
  const SymmetricMatrix none;
  SparseCholesky cholesky;
  cholesky.analyse(none);
  EXPECT_TRUE(cholesky.factor(none));
  cholesky.solve({});
}

TEST(SparseCholesky, WorksBesideAnother) {
  Random random(5);
  const Eigen::MatrixXd a = random_matrix(random, 30, 20), b = random_matrix(random, 40, 25);
  const SymmetricMatrix sparse_a = sparse(a), sparse_b = sparse(b);
  SparseCholesky of_a, of_b;
  of_a.analyse(sparse_a);
  of_b.analyse(sparse_b);
  ASSERT_TRUE(of_a.factor(sparse_a));
  ASSERT_TRUE(of_b.factor(sparse_b));
  Eigen::VectorXd x = Eigen::VectorXd::Ones(30), y = Eigen::VectorXd::Ones(40);
  of_b.solve({y.data(), 40});
  of_a.solve({x.data(), 30});
  EXPECT_LT((a * x - Eigen::VectorXd::Ones(30)).norm(), 1e-12);
  EXPECT_LT((b * y - Eigen::VectorXd::Ones(40)).norm(), 1e-12);
}

}  // namespace
}  // namespace riven::testing
