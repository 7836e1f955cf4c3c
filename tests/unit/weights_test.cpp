#include "peridynamics/weights.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <functional>

#include "support/random.hpp"

namespace riven::testing {
namespace {

constexpr unsigned kSeed = 20240902;
using Family = std::vector<PlaneBond>;

/// The lattice family of reach 3 (28 bonds), or those of its bonds that `keep` accepts.
Family family(const std::function<bool(int, int)>& keep = [](int, int) { return true; }) {
  Family bonds;
  for (int j = -3; j <= 3; ++j)
    for (int i = -3; i <= 3; ++i)
      if (i * i + j * j > 0 && i * i + j * j <= 9 && keep(i, j)) bonds.push_back({0.1 * i, 0.1 * j});
  return bonds;
}

/// Largest error of the sum and of the averages of n n and n n n n against those over all directions.
double moment_error(const Family& bonds, const FamilyWeights& weights) {
  double sum = 0, second[2][2]{}, fourth[2][2][2][2]{};
  for (std::size_t j = 0; j < bonds.size(); ++j) {
    const double length = std::hypot(bonds[j].x, bonds[j].y),
                 n[2] = {bonds[j].x / length, bonds[j].y / length};
    sum += weights.weight[j];
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        second[a][b] += weights.weight[j] * n[a] * n[b];
        for (int c = 0; c < 2; ++c)
          for (int d = 0; d < 2; ++d) fourth[a][b][c][d] += weights.weight[j] * n[a] * n[b] * n[c] * n[d];
      }
  }
  double error = std::abs(sum - 1);
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      error = std::max(error, std::abs(second[a][b] - 0.5 * (a == b)));
      for (int c = 0; c < 2; ++c)
        for (int d = 0; d < 2; ++d) {
          const double exact = ((a == b) * (c == d) + (a == c) * (b == d) + (a == d) * (b == c)) / 8.0;
          error = std::max(error, std::abs(fourth[a][b][c][d] - exact));
        }
    }
  return error;
}

std::vector<double> base_weights(const Family& bonds) {
  std::vector<double> w0;
  double sum = 0;
  for (const PlaneBond& bond : bonds) sum += w0.emplace_back(1 / std::hypot(bond.x, bond.y));
  for (double& w : w0) w /= sum;
  return w0;
}

/// What holds for every family, whatever kind it turns out to be.
void check(const Family& bonds) {
  const FamilyWeights weights = moment_corrected_weights(bonds);
  ASSERT_EQ(weights.weight.size(), bonds.size());
  const std::vector<double> w0 = base_weights(bonds);
  double smallest = 1e9, sum = 0;
  for (std::size_t j = 0; j < bonds.size(); ++j) {
    smallest = std::min(smallest, weights.weight[j] / w0[j]);
    sum += weights.weight[j];
  }
  switch (weights.kind) {
    case FamilyWeights::Kind::smooth: {
      EXPECT_LT(moment_error(bonds, weights),
                1e-10);  // the demand; 1e-15 measured for whole and edge families
      EXPECT_GE(smallest, 0.05);
      EXPECT_NEAR(weights.smallest_ratio, smallest, 1e-10);
      for (std::size_t j = 0; j < bonds.size(); ++j) {
        const Moments f = angular_functions(bonds[j]);
        double combined = 0;
        for (std::size_t m = 0; m < kMoments; ++m) combined += weights.coefficients[m] * f[m];
        EXPECT_NEAR(combined / std::hypot(bonds[j].x, bonds[j].y), weights.weight[j], 1e-10);
      }
      break;
    }
    case FamilyWeights::Kind::listed:
      EXPECT_LT(moment_error(bonds, weights), 1e-12);  // solved once more for the moments; 4e-16 measured
      EXPECT_GE(smallest, 0.05 - 1e-12);
      break;
    case FamilyWeights::Kind::gradient:
      EXPECT_NEAR(sum, 1, 1e-14);
      for (std::size_t j = 0; j < bonds.size(); ++j) EXPECT_NEAR(weights.weight[j], w0[j], 1e-15);
      break;
  }
}

TEST(Weights, OfWholeAndEdgeFamiliesAreExact) {
  // Rows of the whole family, of points on a straight edge and one or two rows in; of those, all stay smooth.
  for (int rows = 0; rows <= 3; ++rows) {
    const Family bonds = family([&](int, int j) { return j >= -rows; });
    check(bonds);
    const FamilyWeights weights = moment_corrected_weights(bonds);
    EXPECT_EQ(weights.kind, FamilyWeights::Kind::smooth) << rows;
    EXPECT_LT(moment_error(bonds, weights), 1e-14) << rows;  // rounding; 1e-16 measured
  }
}

TEST(Weights, OfCutFamiliesAreExactOrPositiveOrLeftToTheGradient) {
  Random random(kSeed);
  std::array<int, 3> kinds{};
  for (int n = 0; n < 3000; ++n) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", family " << n);
    const double keep = random.between(0.15, 1);
    const double angle = random.between(0, 6.3), depth = random.between(-3.5, 1);
    const Family bonds = family([&](int i, int j) {
      return random.chance(keep) && i * std::cos(angle) + j * std::sin(angle) > depth;
    });
    if (bonds.empty()) continue;
    check(bonds);
    ++kinds[static_cast<std::size_t>(moment_corrected_weights(bonds).kind)];
  }
  for (const int kind : kinds) EXPECT_GT(kind, 50);  // the sample reaches every branch
}

/// Closest weights w0 max(l . phi, 0.05) that have the right moments, from the dual of the bounded problem: a
/// concave function of five numbers l, climbed by Newton's method. Returns the moments' error; large if no
/// such weights exist.
double climb_to_bounded_weights(const Family& bonds, std::vector<double>& weight) {
  const std::vector<double> w0 = base_weights(bonds);
  constexpr double floor = 0.05;
  std::vector<Eigen::Matrix<double, 5, 1>> phi;
  for (const PlaneBond& bond : bonds) {
    const double t = std::atan2(bond.y, bond.x);
    phi.emplace_back().col(0) << 1, std::cos(2 * t), std::sin(2 * t), std::cos(4 * t), std::sin(4 * t);
  }
  using Vector = Eigen::Matrix<double, 5, 1>;
  const Vector target = Vector::Unit(0);
  const auto height = [&](const Vector& l) {
    double sum = l(0);
    for (std::size_t j = 0; j < phi.size(); ++j) {
      const double z = phi[j].dot(l), m = std::max(z, floor);
      sum -= w0[j] * (m * z - 0.5 * m * m);
    }
    return sum;
  };
  Vector l = target, slope = target;
  for (int n = 0; n < 300 && slope.cwiseAbs().maxCoeff() > 1e-12; ++n) {
    slope = target;
    Eigen::Matrix<double, 5, 5> curvature = 1e-9 * Eigen::Matrix<double, 5, 5>::Identity();
    for (std::size_t j = 0; j < phi.size(); ++j) {
      slope -= w0[j] * std::max(phi[j].dot(l), floor) * phi[j];
      if (phi[j].dot(l) > floor) curvature += w0[j] * phi[j] * phi[j].transpose();
    }
    const Vector step = curvature.ldlt().solve(slope);
    double share = 1;
    while (share > 1e-10 && height(l + share * step) < height(l) + 1e-4 * share * slope.dot(step))
      share *= 0.5;
    l += share * step;
  }
  weight.clear();
  for (std::size_t j = 0; j < phi.size(); ++j) weight.push_back(w0[j] * std::max(phi[j].dot(l), floor));
  return slope.cwiseAbs().maxCoeff();
}

TEST(Weights, GoByTheGradientOnlyIfNoBoundedWeightsExist) {
  Random random(kSeed + 2);
  int listed = 0;
  for (int n = 0; n < 3000; ++n) {
    const double keep = random.between(0.15, 0.6);
    const Family bonds = family([&](int, int) { return random.chance(keep); });
    if (bonds.empty()) continue;
    const FamilyWeights weights = moment_corrected_weights(bonds);
    if (weights.kind == FamilyWeights::Kind::smooth) continue;
    std::vector<double> closest;
    const double error = climb_to_bounded_weights(bonds, closest);
    if (weights.kind == FamilyWeights::Kind::gradient) {
      EXPECT_GT(error, 1e-8) << "seed " << kSeed + 2 << ", family " << n;
      continue;
    }
    ++listed;
    // The moments of both are exact, the penalty and Newton's last step leave 1.3e-10 in the weights.
    for (std::size_t j = 0; j < bonds.size() && error < 1e-10; ++j)
      EXPECT_NEAR(weights.weight[j], closest[j], 1e-8) << "seed " << kSeed + 2 << ", family " << n;
  }
  EXPECT_GT(listed, 50);
}

TEST(Weights, OfCornersAndSingleBondsAreNeverNegative) {
  for (int a = 0; a <= 3; ++a)
    for (int b = 0; b <= 3; ++b) check(family([&](int i, int j) { return i >= -a && j >= -b; }));
  EXPECT_NE(moment_corrected_weights(family([](int i, int j) { return i >= 0 && j >= 0; })).kind,
            FamilyWeights::Kind::smooth);
  check({{0.3, 0.1}});
  check({{0.3, 0.1}, {-0.3, -0.1}});
  EXPECT_EQ(moment_corrected_weights({}).kind, FamilyWeights::Kind::gradient);
}

TEST(Weights, FollowRotationsByARightAngleAndReflections) {
  Random random(kSeed + 1);
  for (int n = 0; n < 300; ++n) {
    const double keep = random.between(0.4, 1);
    const Family bonds = family([&](int i, int j) { return random.chance(keep) && i + 2 * j > -5; });
    Family rotated, reflected, scaled;
    for (const PlaneBond& b : bonds) {
      rotated.push_back({-b.y, b.x});
      reflected.push_back({-b.x, b.y});
      scaled.push_back({1e-3 * b.x, 1e-3 * b.y});
    }
    const FamilyWeights plain = moment_corrected_weights(bonds);
    for (const Family& other : {rotated, reflected, scaled}) {
      const FamilyWeights moved = moment_corrected_weights(other);
      ASSERT_EQ(moved.kind, plain.kind) << "seed " << kSeed + 1 << ", family " << n;
      // Rounding times the condition of a 5 x 5 system or of the active sets; 3e-16 measured.
      const double tolerance = 1e-11;
      for (std::size_t j = 0; j < bonds.size(); ++j) EXPECT_NEAR(moved.weight[j], plain.weight[j], tolerance);
    }
  }
}

TEST(Weights, OfASmoothFamilyAreTheClosestToTheBaseWeights) {
  // Minimum of sum (w - w0)^2 / w0 under the moment conditions, by Lagrange's equations in all unknowns at
  // once.
  const Family bonds = family([](int, int j) { return j >= -1; });
  const auto n = static_cast<Eigen::Index>(bonds.size());
  const std::vector<double> w0 = base_weights(bonds);
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 5, n + 5);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n + 5);
  for (Eigen::Index j = 0; j < n; ++j) {
    const double t = std::atan2(bonds[static_cast<std::size_t>(j)].y, bonds[static_cast<std::size_t>(j)].x);
    const double phi[] = {1, std::cos(2 * t), std::sin(2 * t), std::cos(4 * t), std::sin(4 * t)};
    system(j, j) = 1 / w0[static_cast<std::size_t>(j)];
    right(j) = 1;
    for (Eigen::Index m = 0; m < 5; ++m) system(j, n + m) = system(n + m, j) = phi[m];
  }
  right(n) = 1;
  const Eigen::VectorXd exact = system.fullPivLu().solve(right);
  const FamilyWeights weights = moment_corrected_weights(bonds);
  for (Eigen::Index j = 0; j < n; ++j)
    EXPECT_NEAR(weights.weight[static_cast<std::size_t>(j)], exact(j), 1e-14);  // 2e-17 measured
}

}  // namespace
}  // namespace riven::testing
