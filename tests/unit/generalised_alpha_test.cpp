#include "solver/generalised_alpha.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "support/spring_chain.hpp"
#include "support/stopped_run.hpp"
#include "support/time_dependent_force.hpp"

namespace riven::testing {
namespace {

constexpr double kPi = std::numbers::pi;

GeneralisedAlphaSettings settings_for(double radius, double h, long steps) {
  GeneralisedAlphaSettings settings;
  settings.until = h * static_cast<double>(steps);
  settings.every = settings.history_every = settings.until;
  settings.step = h;
  settings.tolerance = 1e-12;
  settings.spectral_radius = radius;
  return settings;
}

/// An oscillator of frequency 1 (rad/s) from u = 1, v = 0.
State oscillate(const GeneralisedAlphaSettings& given) {
  SpringChain model({1.0}, linear_spring(1), true);
  Constraints constraints(1, 0);
  GeneralisedAlphaSettings settings = given;
  settings.initial_u = {1.0};
  Observer nobody;
  return generalised_alpha(model, constraints, settings, nobody);
}

// Of the space-time theory's table, section 9: displacements of average acceleration are cos(n omega) with
// an angle that is the period's.
TEST(GeneralisedAlpha, IsNewmarksMethodForSpectralRadiusOne) {
  for (const auto& [h_over_period, error] : std::vector<std::array<double, 2>>{
           {0.01, 0.033}, {0.05, 0.817}, {0.1, 3.207}, {0.2, 12.00}, {0.25, 17.97}, {0.3, 24.70}}) {
    const double omega = 2 * kPi * h_over_period;
    const State state = oscillate(settings_for(1, omega, 1));
    const double angle = std::atan2(-state.v[0], state.u[0]);
    EXPECT_NEAR(100 * (omega / angle - 1), error, 0.6e-3 * std::max(1.0, error));
    EXPECT_NEAR(std::hypot(state.u[0], state.v[0]), 1, 1e-12);
  }
}

TEST(GeneralisedAlpha, IsOfSecondOrder) {
  for (const double radius : {1.0, 0.8, 0.3, 0.0}) {
    const auto error = [radius](long steps) {
      const State state = oscillate(settings_for(radius, 2.5 * kPi / static_cast<double>(steps), steps));
      return std::hypot(state.u[0] - std::cos(state.parameter), state.v[0] + std::sin(state.parameter));
    };
    EXPECT_NEAR(std::log2(error(80) / error(160)), 2, 0.05) << radius;
  }
}

// Of what is far faster than the step all three eigenvalues are minus the radius, so that after n steps
// (-r)^n times a parabola of n is left: its third differences are 0.
TEST(GeneralisedAlpha, DampsFastMotionsByItsRadius) {
  struct Path : Observer {
    void reached(const State& state, const Constraints&, bool) override { u.push_back(state.u[0]); }
    std::vector<double> u;
  };
  const auto defect = [](double radius, double expected) {
    const double h = 2 * kPi * 1e4;
    SpringChain model({1.0}, linear_spring(1), true);
    Constraints constraints(1, 0);
    GeneralisedAlphaSettings settings = settings_for(radius, h, 10);
    settings.history_every = h;
    settings.initial_u = {1.0};
    Path path;
    static_cast<void>(generalised_alpha(model, constraints, settings, path));
    std::vector<double> w;
    double largest = 0;
    for (std::size_t n = 0; n <= 10; ++n) {
      w.push_back(path.u[n] / std::pow(-expected, static_cast<double>(n)));
      largest = std::max(largest, std::abs(w.back()));
    }
    double worst = 0;
    for (std::size_t n = 0; n + 3 <= 10; ++n)
      worst = std::max(worst, std::abs(w[n + 3] - 3 * w[n + 2] + 3 * w[n + 1] - w[n]));
    return worst / largest;
  };
  for (const double radius : {0.9, 0.6, 0.3}) {
    EXPECT_LT(defect(radius, radius), 1e-4) << radius;
    EXPECT_GT(defect(radius, 0.9 * radius), 1e-3) << radius;
  }
}

TEST(GeneralisedAlpha, BalancesTheEnergyToItsOrder) {
  const auto worst = [](double h) {
    SpringChain model({1, 2, 1, 0.5, 1}, neo_hookean_spring(10), false);
    Constraints constraints(5, 1);
    constraints.add(
        {.slave = 0, .terms = {{[](const Point&, double t) { return 0.2 * std::sin(t); }, {}, 0, 1, 0}}});
    GeneralisedAlphaSettings settings = settings_for(1, h, std::lround(8 / h));
    settings.every = settings.history_every = 0.13;
    settings.external = {std::make_shared<TimeDependentForce>([](double t) {
      return std::vector<double>{0, 0, std::sin(2 * t), 0, 0};
    })};
    struct Worst : Observer {
      void reached(const State& state, const Constraints&, bool) override {
        error = std::max(error, std::abs(state.energy.error()));
      }
      double error = 0;
    } log;
    static_cast<void>(generalised_alpha(model, constraints, settings, log));
    return log.error;
  };
  const double coarse = worst(0.02), fine = worst(0.01);
  EXPECT_LT(fine, 0.01);
  EXPECT_GT(std::log2(coarse / fine), 1.6);
}

/// Counts how often its tangent is asked for: twice for the pattern, then for each factorisation.
struct CountingChain : SpringChain {
  using SpringChain::SpringChain;
  void tangent(std::span<const double> u, std::size_t first, std::size_t last,
               TangentBlocks& to) const override {
    if (first == 0) ++tangents;
    SpringChain::tangent(u, first, last, to);
  }
  mutable long tangents = 0;
};

// Times of 0.07 n differ by 0.07 but for rounding.
TEST(GeneralisedAlpha, FactorsALinearMotionOnce) {
  CountingChain model({1.0}, linear_spring(1), true);
  Constraints constraints(1, 0);
  GeneralisedAlphaSettings settings = settings_for(0.8, 0.07, 100);
  settings.tolerance = 1e-8;
  settings.initial_u = {1.0};
  Observer nobody;
  static_cast<void>(generalised_alpha(model, constraints, settings, nobody));
  EXPECT_EQ(model.tangents, 2 + 1);
}

// Factors of an earlier step leave other roundings than new ones would.
TEST(GeneralisedAlpha, GoesOnWithTheFactorsItHad) {
  const auto run = [](StopsAt<>& watch, const Snapshot* from) {
    CountingChain model({1, 2, 1, 0.5, 1}, neo_hookean_spring(10), true);
    Constraints constraints(5, 1);
    GeneralisedAlphaSettings settings = settings_for(0.8, 0.02, 60);
    settings.tolerance = 1e-6;
    settings.initial_v = {0, 0.3, 1, 0.5, 0};
    const State state = generalised_alpha(model, constraints, settings, watch, from);
    return std::pair(state, model.tangents);
  };
  StopsAt<> whole;
  const auto [expected, tangents] = run(whole, nullptr);
  EXPECT_LT(tangents, 30);  // of 60 steps
  for (const long stop : {1L, 7L, 29L, 30L, 58L}) {
    StopsAt<> first, second;
    first.stop_at = stop - 1;
    EXPECT_THROW(static_cast<void>(run(first, nullptr)), Stopped);
    const State state = run(second, &first.snapshot).first;
    EXPECT_EQ(state.u, expected.u) << stop;
    EXPECT_EQ(state.v, expected.v) << stop;
    EXPECT_EQ(state.evaluations, expected.evaluations) << stop;
  }
}

TEST(GeneralisedAlpha, NeedsAStep) {
  GeneralisedAlphaSettings settings = settings_for(1, 0.1, 1);
  settings.step.reset();
  EXPECT_THROW(static_cast<void>(oscillate(settings)), InputError);
}

}  // namespace
}  // namespace riven::testing
