// The bond laws of Bang (2016) in homogeneous states of a whole family, whose sums are integrals over the
// directions. Numbers: peridynamics theory, section 12.

#include "peridynamics/bond_law.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <numbers>

namespace riven::testing {
namespace {

constexpr int kDirections = 720;  // trapezoidal rule of a smooth periodic function: exact to rounding

/// Mean over all directions n of visit(n, deformed n).
template <class Visit>
auto mean(double lx, double ly, const Visit& visit) {
  using Value = decltype(visit(Eigen::Vector2d(), Eigen::Vector2d()));
  Value sum = Value(visit(Eigen::Vector2d(1, 0), Eigen::Vector2d(lx, 0)));
  for (int k = 1; k < kDirections; ++k) {
    const double angle = 2 * std::numbers::pi * k / kDirections;
    const Eigen::Vector2d n(std::cos(angle), std::sin(angle)), y(lx * n.x(), ly * n.y());
    sum += visit(n, y);
  }
  return Value(sum / kDirections);
}

double cosine2(const Eigen::Vector2d& n, const Eigen::Vector2d& y) {
  return std::pow(n.dot(y), 2) / y.squaredNorm();
}

/// W / C1: the sum over the family of (delta/xi) is 2 pi h delta^2, so c0 times it is 2 C1.
double energy(const BondLaw& law, double lx, double ly) {
  return 2 * mean(lx, ly, [&](const auto& n, const auto& y) {
           return cosine2(n, y) * law.potential(y.squaredNorm()) + law.e;
         });
}

/// P / C1, half the sum of f times xi: diagonal entries.
Eigen::Vector2d stress(const BondLaw& law, double lx, double ly) {
  return 4 * mean(lx, ly, [&](const auto& n, const auto& y) -> Eigen::Vector2d {
           return cosine2(n, y) * law.response(y.squaredNorm()) * n.cwiseProduct(y);
         });
}

double energy_error(const BondLaw& law, Loading loading, double l) {
  return energy(law, l, lateral_stretch(loading, l)) - neo_hookean_energy(loading, l);
}

TEST(BondLaw, DerivativesAgree) {
  const BondLaw law{.p4 = 0.3, .p2 = 1.1, .m1 = 0.7, .m2 = -0.2, .m4 = 0.4, .m6 = 0.15, .e = 0};
  for (const double s : {0.6, 1.0, 1.7}) {
    const double h = 1e-4;
    const auto derivative = [&](const auto& f) {
      return (f(s - 2 * h) - 8 * f(s - h) + 8 * f(s + h) - f(s + 2 * h)) / (12 * h);
    };
    // Five points: rounding 1e-16 / h times values up to 30.
    EXPECT_NEAR(2 * s * law.response(s * s), derivative([&](double x) { return law.potential(x * x); }),
                1e-9);
    EXPECT_NEAR(law.stiffness(s), derivative([&](double x) { return x * law.response(x * x); }), 1e-9);
  }
}

TEST(BondLaw, PublishedStressesAreThoseOfTheTheoryNote) {
  struct Row {
    double l, planar_x, planar_y, uniaxial_x, uniaxial_y;
  };
  // Printed with four decimals.
  for (const Row& row : {Row{1, 0.2825, 0.2825, -0.0201, -0.0201}, Row{1.1, 0.9109, 0.4816, 0.7235, -0.1910},
                         Row{1.5, 2.6978, 0.9868, 2.6034, -0.8896}, Row{2, 4.2166, 1.2714, 4.0622, -1.7249},
                         Row{4, 8.5649, 1.4195, 8.2688, -4.5584}}) {
    const Eigen::Vector2d planar = stress(published_law(Loading::planar), row.l, 1);
    EXPECT_NEAR(planar.x(), row.planar_x, 6e-5);
    EXPECT_NEAR(planar.y(), row.planar_y, 6e-5);
    const Eigen::Vector2d uniaxial = stress(published_law(Loading::uniaxial), row.l, 1 / std::sqrt(row.l));
    EXPECT_NEAR(uniaxial.x(), row.uniaxial_x, 6e-5);
    EXPECT_NEAR(uniaxial.y(), row.uniaxial_y, 6e-5);
  }
  const BondLaw compression = published_law(Loading::uniaxial_compression);
  for (const auto& [l, printed] : {std::pair{0.9, 0.83}, {0.8, 3.36}, {0.6, 7.16}}) {
    EXPECT_NEAR(stress(compression, l, 1 / std::sqrt(l)).x(), printed, 6e-3);
    EXPECT_LT(2 * (l - 1 / (l * l)), 0) << "while the true stress is a pressure";
  }
  for (const double l : {1.0, 2.0, 4.0})
    EXPECT_NEAR(stress(published_law(Loading::equibiaxial), l, l).x(), 2 * (l - std::pow(l, -5)), 1e-12);
}

TEST(BondLaw, PublishedLawsLeaveAForceAtRest) {
  EXPECT_EQ(published_law(Loading::equibiaxial).force_at_rest(), 0);
  EXPECT_NEAR(published_law(Loading::planar).force_at_rest(), 0.1412, 6e-5);
  EXPECT_NEAR(2 * published_law(Loading::uniaxial).force_at_rest(), -0.0201, 6e-5);
  EXPECT_NEAR(2 * published_law(Loading::uniaxial_compression).force_at_rest(), -1.745, 6e-4);
  for (const Loading loading :
       {Loading::equibiaxial, Loading::planar, Loading::uniaxial, Loading::uniaxial_compression}) {
    EXPECT_NEAR(zero_residual_law(loading).force_at_rest(), 0, 1e-14);
    EXPECT_NEAR(zero_residual_law(loading).energy_at_rest(), 0, 1e-14);
  }
}

TEST(BondLaw, PublishedFitsAreAsGoodAsTheTheoryNoteSays) {
  struct Row {
    Loading loading;
    double low, high, at_rest, largest;
  };
  for (const Row& row :
       {Row{Loading::planar, 1, 4, -4.4e-4, 0.0249}, Row{Loading::uniaxial, 1, 4, 7.9e-4, 0.0047},
        Row{Loading::uniaxial_compression, 0.4, 1, -2.0e-3, 0.0395}}) {
    const BondLaw law = published_law(row.loading);
    EXPECT_NEAR(energy_error(law, row.loading, 1), row.at_rest, 6e-5);
    double largest = 0;
    for (int n = 0; n <= 600; ++n)
      largest = std::max(largest,
                         std::abs(energy_error(law, row.loading, row.low + (row.high - row.low) * n / 600)));
    EXPECT_NEAR(largest, row.largest, 6e-5);
  }
}

TEST(BondLaw, ZeroResidualConstantsAreTheConstrainedLeastSquaresFit) {
  // The fit of the theory note: the squared error over max(W, 0.02 C1), in steps of 0.01 (compression 0.005).
  struct Row {
    Loading loading;
    double low, high;
    Eigen::Index states;
    double largest;
    std::vector<double> powers;
  };
  for (const Row& row : {Row{Loading::planar, 1, 4, 301, 0.036, {2, -2, -6}},
                         Row{Loading::uniaxial, 1, 4, 301, 0.008, {2, -1, -4}},
                         Row{Loading::uniaxial_compression, 0.4, 1, 121, 0.004, {2, -1, -4, 4}}}) {
    const auto terms = static_cast<Eigen::Index>(row.powers.size());
    const auto power = [&](Eigen::Index k) { return row.powers[static_cast<std::size_t>(k)]; };
    Eigen::MatrixXd a(row.states, terms + 1);
    Eigen::VectorXd b(row.states), weight(row.states);
    for (Eigen::Index n = 0; n < row.states; ++n) {
      const double l =
          row.low + (row.high - row.low) * static_cast<double>(n) / static_cast<double>(row.states - 1);
      const double other = lateral_stretch(row.loading, l);
      for (Eigen::Index k = 0; k < terms; ++k)
        a(n, k) = 2 * mean(l, other, [&](const auto& direction, const auto& y) {
                    return cosine2(direction, y) * std::pow(y.norm(), power(k));
                  });
      a(n, terms) = 2;
      b(n) = neo_hookean_energy(row.loading, l);
      weight(n) = 1 / std::sqrt(std::max(b(n), 0.02));
    }
    Eigen::MatrixXd conditions = Eigen::MatrixXd::Ones(2, terms + 1);  // energy and force at rest
    for (Eigen::Index k = 0; k < terms; ++k) conditions(1, k) = power(k);
    conditions(1, terms) = 0;
    const Eigen::MatrixXd free = Eigen::FullPivLU<Eigen::MatrixXd>(conditions).kernel();
    const Eigen::VectorXd fit =
        free *
        (weight.asDiagonal() * a * free).colPivHouseholderQr().solve(Eigen::VectorXd(weight.cwiseProduct(b)));

    const BondLaw law = zero_residual_law(row.loading);
    const std::map<double, double> coefficient = {{4, law.p4},  {2, law.p2},  {-1, law.m1},
                                                  {-2, law.m2}, {-4, law.m4}, {-6, law.m6}};
    // Printed with six decimals; the coefficient of s^2 sums the roundings of the others.
    for (Eigen::Index k = 0; k < terms; ++k) EXPECT_NEAR(coefficient.at(power(k)), fit(k), 4e-6);
    EXPECT_NEAR(law.e, fit(terms), 4e-6);
    EXPECT_NEAR((a * fit - b).cwiseAbs().maxCoeff(), row.largest, 5e-4);
  }
}

}  // namespace
}  // namespace riven::testing
