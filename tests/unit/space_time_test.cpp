#include "solver/space_time.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "support/spring_chain.hpp"
#include "support/time_dependent_force.hpp"

namespace riven::testing {
namespace {

constexpr double kPi = std::numbers::pi;

/// An oscillator of frequency 1 (rad/s).
SpringChain oscillator() {
  return {{1.0}, linear_spring(1), true};
}

SpaceTimeSettings settings_for(SlabKind scheme, double h, long slabs) {
  SpaceTimeSettings settings;
  settings.until = h * static_cast<double>(slabs);
  settings.every = settings.history_every = settings.until;
  settings.step = h;
  settings.tolerance = 1e-13;
  settings.scheme = scheme;
  return settings;
}

/// One slab's map of (u, h v).
Eigen::Matrix2d amplification(SlabKind scheme, double h) {
  Eigen::Matrix2d t;
  for (Eigen::Index column = 0; column < 2; ++column) {
    SpringChain model = oscillator();
    Constraints constraints(1, 0);
    SpaceTimeSettings settings = settings_for(scheme, h, 1);
    settings.initial_u = {column == 0 ? 1.0 : 0.0};
    settings.initial_v = {column == 1 ? 1 / h : 0.0};
    Observer nobody;
    const State state = march_slabs(model, constraints, settings, nobody);
    t.col(column) << state.u[0], h * state.v[0];
  }
  return t;
}

struct Row {
  double h_over_period, radius, damping, period_error;  // error in per cent; 0: not given
};

void check(SlabKind scheme, const Row& row) {
  const double omega = 2 * kPi * row.h_over_period;
  const Eigen::Vector2cd values = amplification(scheme, omega).eigenvalues();
  EXPECT_NEAR(values.cwiseAbs().maxCoeff(), row.radius, 0.6e-6) << row.h_over_period;
  if (row.period_error == 0) return;
  const double angle = std::abs(std::arg(values(0)));
  EXPECT_NEAR(100 * (omega / angle - 1), row.period_error, 0.6e-3 * std::max(1.0, row.period_error))
      << row.h_over_period;
  if (row.damping > 0) {
    EXPECT_NEAR(-std::log(std::abs(values(0))) / angle / row.damping, 1, 5e-3) << row.h_over_period;
  }
}

// The table of the space-time theory, section 9, to its digits.
TEST(SpaceTime, AmplifiesAsTheSingleFieldSchemeDoes) {
  for (const Row& row : std::vector<Row>{{0.01, 1.000000, 1.72e-6, 0.0000},
                                         {0.05, 0.999933, 2.14e-4, 0.0013},
                                         {0.10, 0.998954, 1.67e-3, 0.0213},
                                         {0.20, 0.985039, 1.20e-2, 0.318},
                                         {0.25, 0.966675, 2.17e-2, 0.730},
                                         {0.30, 0.938530, 3.41e-2, 1.386},
                                         {0.5, 0.887663, 0, 0},
                                         {1, 0.406694, 0, 210.3},
                                         {2, 0.526663, 0, 0},
                                         {5, 0.927013, 0, 0},
                                         {10, 0.981762, 0, 0},
                                         {100, 0.999818, 0, 0}})
    check(SlabKind::single_field, row);
}

TEST(SpaceTime, AmplifiesAsTheTwoFieldSchemeDoes) {
  for (const Row& row : std::vector<Row>{{0.05, 0.999866, 0, 0.0036},
                                         {0.1, 0.997933, 0, 0.0567},
                                         {0.2, 0.971777, 0, 0.846},
                                         {0.5, 0.660738, 0, 0},
                                         {1, 0.332644, 0, 0},
                                         {10, 0.031851, 0, 0},
                                         {100, 0.003183, 0, 0}})
    check(SlabKind::two_field, row);
}

TEST(SpaceTime, TakesOneSlabOfTheNote) {
  SpringChain model({1.0}, linear_spring(0.49), true);  // Omega = 0.7
  Constraints constraints(1, 0);
  SpaceTimeSettings settings = settings_for(SlabKind::single_field, 1, 1);
  settings.initial_u = {0.4};
  settings.initial_v = {0.1};
  Observer nobody;
  const State state = march_slabs(model, constraints, settings, nobody);
  EXPECT_NEAR(state.u[0], 0.398005, 0.5e-6);
  EXPECT_NEAR(state.v[0], -0.103827, 0.5e-6);
}

/// Errors of u and v after 1.25 periods from u = 1, v = 0.
std::array<double, 2> errors(SlabKind scheme, long slabs_per_period) {
  SpringChain model = oscillator();
  Constraints constraints(1, 0);
  const double h = 2 * kPi / static_cast<double>(slabs_per_period);
  SpaceTimeSettings settings = settings_for(scheme, h, slabs_per_period * 5 / 4);
  settings.initial_u = {1.0};
  Observer nobody;
  const State state = march_slabs(model, constraints, settings, nobody);
  return {std::abs(state.u[0] - std::cos(state.parameter)), std::abs(state.v[0] + std::sin(state.parameter))};
}

TEST(SpaceTime, IsOfThirdOrder) {
  const std::vector<std::array<double, 3>> table = {
      {20, 3.22e-4, 1.68e-3}, {40, 3.36e-5, 2.11e-4}, {80, 3.78e-6, 2.64e-5}, {160, 4.47e-7, 3.30e-6}};
  for (const auto& [slabs, u, v] : table) {
    const auto error = errors(SlabKind::single_field, static_cast<long>(slabs));
    EXPECT_NEAR(error[0] / u, 1, 0.005) << slabs;
    EXPECT_NEAR(error[1] / v, 1, 0.005) << slabs;
  }
  // Damping, of third order in the velocity here, hides the phase, of fourth order in the displacement.
  const auto coarse = errors(SlabKind::two_field, 80), fine = errors(SlabKind::two_field, 160);
  EXPECT_NEAR(std::log2(coarse[1] / fine[1]), 3, 0.05);
  EXPECT_NEAR(std::log2(coarse[0] / fine[0]), 4, 0.05);
}

struct Balance {
  double defect = 0;      // largest error of the energy balance
  double iterations = 0;  // mean per slab
};

Balance chain_balance(SlabKind scheme, std::size_t points, double h, double until) {
  std::vector<double> masses(20, 1.0);
  masses.back() = 0.5;
  SpringChain model(masses, neo_hookean_spring(50), true);
  Constraints constraints(20, 0);
  SpaceTimeSettings settings = settings_for(scheme, h, std::lround(until / h));
  settings.gauss_points = points;
  settings.tolerance = 1e-11;
  for (std::size_t i = 1; i <= 20; ++i) settings.initial_v.push_back(8 * static_cast<double>(i) / 20);
  struct Worst : Observer {
    void reached(const State& state, const Constraints&, bool) override {
      worst = std::max(worst, std::abs(state.energy.error()));
    }
    double worst = 0;
  } worst;
  settings.every = settings.history_every = h;
  const State state = march_slabs(model, constraints, settings, worst);
  return {worst.worst, static_cast<double>(state.iterations) / static_cast<double>(state.steps)};
}

// Theory (13): what is missing in the balance is the error of the quadrature in time. The note's numbers, of
// the same chain, over ten seconds.
TEST(SpaceTime, KeepsTheEnergyLawToTheQuadrature) {
  struct Defect {
    double h;
    std::size_t points;
    double defect, iterations;
  };
  // The note has defects of 2.5e-5, 1.3e-7, 6.6e-10, 1e-14 and 8.4e-3, 2.5e-4, 9.1e-6, 9.7e-9 over a time
  // that it does not say; a factor of 3 leaves room for that. Below 1e-12 rounding counts.
  for (const Defect& row : std::vector<Defect>{{0.2, 2, 2.5e-5, 8},
                                               {0.2, 3, 1.3e-7, 8},
                                               {0.2, 4, 6.6e-10, 8},
                                               {0.2, 6, 1e-12, 8},
                                               {1, 2, 8.4e-3, 15},
                                               {1, 3, 2.5e-4, 15},
                                               {1, 4, 9.1e-6, 15},
                                               {1, 6, 9.7e-9, 15}}) {
    const Balance balance = chain_balance(SlabKind::single_field, row.points, row.h, 10);
    EXPECT_LT(balance.defect, 3 * row.defect) << row.h << ", " << row.points;
    if (row.defect > 1e-12) {
      EXPECT_GT(balance.defect, row.defect / 3) << row.h << ", " << row.points;
    }
    // The note makes an operator per slab and takes 8 at h = 0.2, 15 at 0.5. One that is kept until it leaves
    // 0.3 of the residual takes half as many more, of far fewer factors.
    EXPECT_LT(balance.iterations, 1.5 * row.iterations) << row.h;
  }
}

// The two-field scheme has no such law; what it takes is known to second order in its jumps.
TEST(SpaceTime, BalancesTheTwoFieldSchemeToItsOrder) {
  const double coarse = chain_balance(SlabKind::two_field, 0, 0.1, 10).defect,
               fine = chain_balance(SlabKind::two_field, 0, 0.05, 10).defect;
  EXPECT_LT(fine, 1e-5);  // measured 4.7e-6
  EXPECT_GT(std::log2(coarse / fine), 2.5);
}

/// Five masses in a row; the first one is moved by a load.
struct DrivenChain {
  DrivenChain(Spring spring, LoadFunction motion) : model({1, 2, 1, 0.5, 1}, std::move(spring), false) {
    constraints.add({.slave = 0, .terms = {{std::move(motion), {}, 0, 1, 0}}});
  }
  SpringChain model;
  Constraints constraints{5, 1};
};

constexpr auto kSchemes = {SlabKind::two_field, SlabKind::single_field};

// All masses move by t^2 under the forces that it takes: a motion that slabs hold.
TEST(SpaceTime, IsExactForParabolasOfTime) {
  for (const SlabKind scheme : kSchemes) {
    DrivenChain chain(neo_hookean_spring(50), [](const Point&, double t) { return t * t - 0.3 * t; });
    SpaceTimeSettings settings = settings_for(scheme, 0.3, 5);
    settings.initial_v.assign(5, -0.3);
    settings.external = {std::make_shared<TimeDependentForce>([](double) {
      return std::vector<double>{2, 4, 2, 1, 2};
    })};
    Observer nobody;
    const State state = march_slabs(chain.model, chain.constraints, settings, nobody);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_NEAR(state.u[i], 1.5 * 1.5 - 0.3 * 1.5, 1e-12);
      EXPECT_NEAR(state.v[i], 2 * 1.5 - 0.3, 1e-12);
    }
  }
}

struct WorstBalance : Observer {
  void reached(const State& state, const Constraints&, bool) override {
    worst = std::max(worst, std::abs(state.energy.error()));
    damped = state.energy.damped;
  }
  double worst = 0, damped = 0;
};

// In linear bodies what schemes take is known exactly, and so is the work of loads that move and that push.
TEST(SpaceTime, ClosesTheBalanceOfALinearBody) {
  for (const SlabKind scheme : kSchemes) {
    DrivenChain chain(linear_spring(30), [](const Point&, double t) { return 0.1 * std::sin(3 * t); });
    SpaceTimeSettings settings = settings_for(scheme, 0.2, 40);
    settings.every = settings.history_every = 0.2;
    settings.initial_u = {0, 0.1, 0, 0.05, 0};
    settings.external = {std::make_shared<TimeDependentForce>([](double t) {
      return std::vector<double>{0.4, 0, std::cos(2 * t), 0, t > 1 ? 0.5 : 0.0};
    })};
    WorstBalance balance;
    static_cast<void>(march_slabs(chain.model, chain.constraints, settings, balance));
    EXPECT_LT(balance.worst, 1e-11);
    EXPECT_GT(balance.damped, 1e-3);
  }
}

TEST(SpaceTime, MarchesABodyThatNothingHolds) {
  for (const SlabKind scheme : kSchemes) {
    SpringChain model(std::vector<double>(6, 1.0), linear_spring(20), false);
    Constraints constraints(6, 0);
    SpaceTimeSettings settings = settings_for(scheme, 0.5, 20);
    settings.initial_v = {3, 1, 2, 2, 2, 2};
    Observer nobody;
    const State state = march_slabs(model, constraints, settings, nobody);
    double place = 0, momentum = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      place += state.u[i];
      momentum += state.v[i];
    }
    EXPECT_NEAR(place, 12 * 10, 1e-10);
    EXPECT_NEAR(momentum, 12, 1e-11);
  }
}

struct Path : Observer {
  void reached(const State& state, const Constraints&, bool output) override {
    time.push_back(state.parameter);
    u.push_back(state.u[0]);
    v.push_back(state.v[0]);
    outputs += output ? 1 : 0;
  }
  std::vector<double> time, u, v;
  int outputs = 0;
};

// Between the ends of slabs the solution is a parabola: of third order too.
TEST(SpaceTime, TellsTheSolutionInsideSlabs) {
  for (const SlabKind scheme : kSchemes) {
    const auto worst = [scheme](double h) {
      SpringChain model = oscillator();
      Constraints constraints(1, 0);
      SpaceTimeSettings settings = settings_for(scheme, h, std::lround(6.4 / h));
      settings.every = 1.7;
      settings.history_every = 0.11;
      settings.initial_u = {1.0};
      Path path;
      static_cast<void>(march_slabs(model, constraints, settings, path));
      EXPECT_EQ(path.outputs, 1 + 3 + 1);
      EXPECT_EQ(path.time.size(), 1U + 58 + 3 + 1);
      std::array<double, 2> error{};
      for (std::size_t n = 0; n < path.time.size(); ++n) {
        if (n > 0) {
          EXPECT_GT(path.time[n], path.time[n - 1]);
        }
        error[0] = std::max(error[0], std::abs(path.u[n] - std::cos(path.time[n])));
        error[1] = std::max(error[1], std::abs(path.v[n] + std::sin(path.time[n])));
      }
      return error;
    };
    const auto coarse = worst(0.2), fine = worst(0.1);
    EXPECT_GT(std::log2(coarse[0] / fine[0]), 2.7);
    EXPECT_GT(std::log2(coarse[1] / fine[1]), scheme == SlabKind::two_field ? 2.7 : 1.7);
    EXPECT_LT(fine[0], 1e-3);
  }
}

TEST(SpaceTime, ChoosesItsStep) {
  SpringChain model = oscillator();
  Constraints constraints(1, 0);
  SpaceTimeSettings settings = settings_for(SlabKind::two_field, 1, 50);
  settings.step.reset();
  settings.initial_u = {1.0};
  std::vector<long> steps;
  for (const double tolerance : {1e-4, 1e-6}) {
    settings.step_tolerance = tolerance;
    Observer nobody;
    const State state = march_slabs(model, constraints, settings, nobody);
    steps.push_back(state.steps);
    // A slab takes Omega^4 / 36 of the energy; between the tolerance and a sixteenth of it.
    const double longest = std::pow(36 * tolerance, 0.25);
    EXPECT_GT(state.steps, 50 / longest);
    EXPECT_LT(state.steps, 2 * 50 / longest + 20);
    // A period loses 2 pi Omega^3 / 36 of it, and there are eight.
    EXPECT_NEAR(state.energy.total() / state.energy.external_work, 1, 1e-9);
    EXPECT_LT(state.energy.damped, 50 * std::pow(longest, 3) / 36 * 0.5);
  }
  EXPECT_GE(steps[1], 2 * steps[0]);  // a fourth root of 100, in powers of two
}

// A load that comes late finds a step that has grown while nothing happened.
TEST(SpaceTime, ShortensStepsForALoadThatComesSuddenly) {
  SpringChain model = oscillator();
  Constraints constraints(1, 0);
  SpaceTimeSettings settings = settings_for(SlabKind::two_field, 1, 30);
  settings.step.reset();
  settings.external = {std::make_shared<TimeDependentForce>([](double t) {
    const double x = std::max(0.0, t - 20);
    return std::vector<double>{0.01 * x * x * x};
  })};
  Observer nobody;
  const State state = march_slabs(model, constraints, settings, nobody);
  // u'' + u = x^3 from rest: x^3 - 6 x + 6 sin x.
  EXPECT_NEAR(state.u[0], 0.01 * (1000 - 60 + 6 * std::sin(10.0)), 5e-3);
}

// An operator that leaves half of the residual in an iteration would take 37 for eleven digits.
TEST(SpaceTime, SolvesSlabsThatNeedTheExactTangents) {
  for (const SlabKind scheme : kSchemes)
    for (const double h : {0.5, 2.0}) EXPECT_LT(chain_balance(scheme, 3, h, 10).iterations, 20) << h;
}

TEST(SpaceTime, SaysWhereItCannotGoOn) {
  DrivenChain chain(neo_hookean_spring(50), [](const Point&, double t) { return 2 * t; });
  chain.constraints.add({.slave = 1, .terms = {}});  // held: the first spring is crushed at t = 0.5
  SpaceTimeSettings settings = settings_for(SlabKind::two_field, 0.1, 10);
  settings.tolerance = 1e-9;
  Path path;
  settings.every = settings.history_every = 0.1;
  try {
    static_cast<void>(march_slabs(chain.model, chain.constraints, settings, path));
    FAIL() << "no failure";
  } catch (const SolverFailure& failure) {
    const std::string what = failure.what();
    EXPECT_NE(what.find("at t = 0.4999"), std::string::npos) << what;
    EXPECT_NE(what.find("a spring is crushed"), std::string::npos) << what;
    EXPECT_NE(what.find("solver.step"), std::string::npos) << what;
  }
  EXPECT_NEAR(path.time.back(), 0.4, 1e-9);
}

}  // namespace
}  // namespace riven::testing
