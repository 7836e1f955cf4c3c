#include "spacetime/slab_operator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "linalg/gmres.hpp"
#include "support/matrices.hpp"
#include "support/random.hpp"

namespace riven::testing {
namespace {

/// A chain of random springs, at one end tied to the ground or free.
Eigen::MatrixXd chain(Random& random, int n, bool grounded) {
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  if (grounded) k(0, 0) = random.between(1, 5);
  for (int i = 1; i < n; ++i) {
    const double spring = random.between(1, 5);
    k(i, i) += spring;
    k(i - 1, i - 1) += spring;
    k(i, i - 1) -= spring;
    k(i - 1, i) -= spring;
  }
  return k;
}

Eigen::MatrixXd kronecker(const Eigen::MatrixXd& time, const Eigen::MatrixXd& space) {
  Eigen::MatrixXd product(time.rows() * space.rows(), time.cols() * space.cols());
  for (Eigen::Index a = 0; a < time.rows(); ++a)
    for (Eigen::Index b = 0; b < time.cols(); ++b)
      product.block(a * space.rows(), b * space.cols(), space.rows(), space.cols()) = time(a, b) * space;
  return product;
}

struct System {
  Eigen::MatrixXd k;
  Eigen::VectorXd m;
  double h;
};

System random_system(unsigned seed, bool grounded) {
  Random random(seed);
  const int n = random.integer(1, 30);
  System system{chain(random, n, grounded), Eigen::VectorXd(n), random.between(0.05, 5)};
  for (double& entry : system.m) entry = random.between(0.5, 2);
  return system;
}

TEST(SlabOperator, SolvesTheMonolithicSystem) {
  for (const SlabScheme& scheme : {single_field_scheme(3), two_field_scheme()})
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const System s = random_system(seed, seed % 2 == 0);  // singular K too
      SlabOperator by_factors(scheme);
      by_factors.analyse(sparse(s.k));
      by_factors.factor(sparse(s.k), {s.m.data(), static_cast<std::size_t>(s.m.size())}, s.h);
      const Eigen::VectorXd b = Eigen::VectorXd::Random(2 * s.m.size());
      Eigen::VectorXd x = b;
      const auto n = static_cast<std::size_t>(s.m.size());
      by_factors.solve({x.data(), n}, {x.data() + n, n});
      const Eigen::MatrixXd whole =
          kronecker(scheme.inertia / (s.h * s.h), s.m.asDiagonal()) + kronecker(scheme.stiffness(), s.k);
      const Eigen::VectorXd expected = whole.fullPivLu().solve(b);
      EXPECT_LT((x - expected).norm(), 1e-12 * expected.norm()) << seed;
    }
}

// The published system of three unknown vectors: the first of them is what the slab starts from, where K is
// regular; where it is not, neither is the system.
TEST(SlabOperator, SolvesThePublishedSystem) {
  const TemporalMatrices time = temporal_matrices(QuadraticLagrange(0.5), gauss_rule(3));
  const SlabScheme scheme = single_field_scheme(3);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const System s = random_system(seed, true);
    const Eigen::Index n = s.m.size();
    const Eigen::VectorXd u = Eigen::VectorXd::Random(n), v = Eigen::VectorXd::Random(n);
    const Eigen::MatrixXd m = s.m.asDiagonal();
    const Eigen::MatrixXd whole = kronecker(time.inertia / (s.h * s.h), m) + kronecker(time.stiffness, s.k);
    Eigen::VectorXd right(3 * n);
    right << -3 / s.h * m * v + s.k * u, 4 / s.h * m * v, -1 / s.h * m * v;
    const Eigen::VectorXd d = whole.fullPivLu().solve(right);
    EXPECT_LT((d.head(n) - u).norm(), 1e-9 * u.norm());
    // Theory (6).
    Eigen::VectorXd x(2 * n);
    x << 4 / s.h * m * v + 12 / (s.h * s.h) * m * u - 4.0 / 6 * s.k * u,
        -1 / s.h * m * v - 7 / (s.h * s.h) * m * u + 1.0 / 6 * s.k * u;
    SlabOperator by_factors(scheme);
    by_factors.analyse(sparse(s.k));
    by_factors.factor(sparse(s.k), {s.m.data(), static_cast<std::size_t>(n)}, s.h);
    by_factors.solve({x.data(), static_cast<std::size_t>(n)}, {x.data() + n, static_cast<std::size_t>(n)});
    EXPECT_LT((x - d.tail(2 * n)).norm(), 1e-9 * x.norm()) << seed;
  }
  const System s = random_system(3, false);
  const Eigen::MatrixXd whole =
      kronecker(time.inertia / (s.h * s.h), s.m.asDiagonal()) + kronecker(time.stiffness, s.k);
  const Eigen::VectorXd values = whole.jacobiSvd().singularValues();
  EXPECT_LT(values.tail(1)(0), 1e-13 * values(0));
}

TEST(SlabOperator, TakesAnEmptySystem) {
  SlabOperator none(two_field_scheme());
  none.analyse({});
  none.factor({}, {}, 1);
  none.solve({}, {});
}

TEST(Gmres, SolvesPreconditionedSystems) {
  Random random(7);
  const Eigen::Index n = 40;
  Eigen::MatrixXd a = Eigen::MatrixXd::Random(n, n) + 8 * Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd near = (a + 0.5 * Eigen::MatrixXd::Random(n, n)).inverse();
  const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
  const auto times = [n](const Eigen::MatrixXd& matrix) {
    return [&matrix, n](std::span<double> x) {
      Eigen::Map<Eigen::VectorXd> v(x.data(), n);
      v = (matrix * v).eval();
    };
  };
  std::size_t before = 0;
  for (const double tolerance : {1e-2, 1e-6, 1e-12}) {
    Eigen::VectorXd x = b;
    const std::size_t iterations =
        gmres(times(a), times(near), tolerance, 60, {x.data(), static_cast<std::size_t>(n)});
    EXPECT_LT((a * x - b).norm(), 1.01 * tolerance * b.norm());
    EXPECT_GT(iterations, before);
    EXPECT_LE(iterations, 40U);
    before = iterations;
  }
  Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
  EXPECT_EQ(gmres(times(a), times(near), 1e-6, 60, {zero.data(), static_cast<std::size_t>(n)}), 0U);
  EXPECT_EQ(zero.norm(), 0);
}

}  // namespace
}  // namespace riven::testing
