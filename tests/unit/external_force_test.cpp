// Forces from outside of the model: what they sum up to, the work they do, and what bodies make of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "body/lattice_body.hpp"
#include "load/distributed_force.hpp"
#include "peridynamics/pmb.hpp"
#include "solver/dynamic_relaxation.hpp"
#include "solver/newton.hpp"
#include "solver/velocity_verlet.hpp"
#include "support/bodies.hpp"
#include "support/pulled_point.hpp"

namespace riven::testing {
namespace {

/// Two points without bonds, of unit mass: what moves them comes from outside.
class FreePoints : public PulledPoint {
 public:
  [[nodiscard]] std::optional<Breakdown> internal_force(std::span<const double>,
                                                        std::span<double> force) override {
    std::fill(force.begin(), force.end(), 0.0);
    return std::nullopt;
  }
  [[nodiscard]] double strain_energy(std::span<const double>) override { return 0; }
  void stiffness_bound(std::span<const double>, std::span<double> bound) override { bound[0] = bound[1] = 1; }
};

/// One share of extent 3 on entry 1.
ExternalForces on_second_point(LoadFunction density) {
  return {std::make_shared<DistributedForce>(DistributedForce::Density{std::move(density)},
                                             std::vector<LoadShare>{{1, {}, 3}}, 2)};
}

VelocityVerletSettings motion(double until, double step) {
  return {.until = until, .every = until, .history_every = until, .step = step};
}

TEST(ExternalForce, MovesAFreePointAsNewtonSays) {
  FreePoints model;
  Constraints constraints(2, 1);
  Observer nobody;
  auto settings = motion(2, 0.01);
  settings.external = on_second_point([](const Point&, double) { return 0.5; });
  const State state = march(model, constraints, settings, nobody);
  EXPECT_EQ(state.u[0], 0);
  EXPECT_NEAR(state.v[1], 3, 1e-12);  // a = 1.5; Verlet is exact for a constant force
  EXPECT_NEAR(state.u[1], 3, 1e-12);
  EXPECT_NEAR(state.energy.external_work, 4.5, 1e-11);
  EXPECT_LT(std::abs(state.energy.error()), 1e-12);
}

TEST(Damping, OfAFreeMotionIsExponentialForAnyValue) {
  for (const double c : {0.3, 5.0, 1e6}) {
    FreePoints model;
    Constraints constraints(2, 1);
    Observer nobody;
    auto settings = motion(1, 0.1);
    settings.initial_v = {0, 2};
    settings.damping = c;
    const State state = march(model, constraints, settings, nobody);
    EXPECT_NEAR(state.v[1], 2 * std::exp(-c), 1e-14) << c;
    EXPECT_NEAR(state.energy.damped, 2 * (1 - std::exp(-2 * c)), 1e-13) << c;
    EXPECT_LT(std::abs(state.energy.error()), 1e-13) << c;
  }
}

TEST(Damping, LeavesTheTerminalVelocityOfAForceToSecondOrder) {
  const auto error = [](double step) {
    FreePoints model;
    Constraints constraints(2, 1);
    Observer nobody;
    auto settings = motion(2, step);
    settings.external = on_second_point([](const Point&, double) { return 1.0; });
    settings.damping = 2;
    const State state = march(model, constraints, settings, nobody);
    return std::abs(state.v[1] - 1.5 * (1 - std::exp(-4.0)));
  };
  EXPECT_NEAR(error(0.1) / error(0.05), 4, 0.1);  // the order shows up to the next one, step^2 / 10
}

TEST(Velocity, MovesAnEntryByItsIntegral) {
  Constraints constraints(1, 1);
  // Simpson's rule is exact for a parabola.
  constraints.add({.slave = 0,
                   .terms = {{[](const Point&, double t) { return 3 * t * t; }, {}, 0, 2, 0, true},
                             {[](const Point&, double t) { return 7 * t; }, {}, 0, 1, 0}}});
  std::vector<double> u(1);
  for (const double t : {0.0, 0.3, 0.4, 1.5}) {
    constraints.set_parameter(t);
    constraints.apply(u);
    EXPECT_NEAR(u[0], 2 * t * t * t + 7 * t, 1e-13);
  }
  constraints.set_parameter(0);
  constraints.apply(u);
  EXPECT_EQ(u[0], 0);
}

/// A bar 1 m x 0.5 m without holes.
Pmb bar(const Defects& defects = {}) {
  return Pmb(make_lattice_body(sheet(40, 20, 0.025, {}, defects)),
             PmbSettings{.youngs_modulus = 1e9, .density = 1000});
}

TEST(Traction, SumsUpToAreaTimesTractionAndLessWhereAHoleCutsTheEdge) {
  const Pmb whole = bar();
  const Body& body = whole.body();
  for (const double layer : {1.0, 3.0}) {
    const auto shares = edge_shares(body, 1, layer * body.spacing);
    EXPECT_EQ(shares.size(), static_cast<std::size_t>(20 * layer));
    const DistributedForce force({[](const Point& x, double s) { return 4e6 * x[0] * s; }, std::nullopt},
                                 shares, body.size());
    EXPECT_NEAR(force.total(2)[0], 8e6 * body.faces[1] * body.face_area(1), 1e-3);
    EXPECT_EQ(force.total(2)[1], 0);
  }
  // A hole of radius 0.125 around the middle of the edge leaves the layer less its mean chord there.
  const Pmb notched = bar({{Disc{{body.faces[1], 0, 0}, 0.125}}, {}, {}});
  const auto left = edge_shares(notched.body(), 1, body.spacing);
  double area = 0;
  for (const LoadShare& share : left) area += share.extent;
  const double r = 0.125, h = body.spacing;
  const double chord = (h * std::sqrt(r * r - h * h) + r * r * std::asin(h / r)) / h;
  EXPECT_NEAR(area, 0.7 * (0.5 - chord), 1e-14);  // cut cells are measured exactly; 1e-16
}

ExternalForces pull(const Body& body, double stress, const std::function<double(double)>& course) {
  ExternalForces forces;
  for (const std::size_t face : {0U, 1U}) {
    const double sign = face == 0 ? -1 : 1;
    forces.push_back(
        std::make_shared<DistributedForce>(DistributedForce::Density{[=](const Point&, double parameter) {
                                             return sign * stress * course(parameter);
                                           }},
                                           edge_shares(body, face, body.spacing), body.size()));
  }
  return forces;
}

/// Holds the point next to the middle, and one beside it against turning.
void hold_middle(const Body& body, Constraints& constraints) {
  const auto nearest = [&](const Point& place) {
    return *std::min_element(body.points.begin(), body.points.end(), [&](std::size_t a, std::size_t b) {
      const auto distance = [&](std::size_t i) {
        return std::hypot(body.position(i)[0] - place[0], body.position(i)[1] - place[1]);
      };
      return distance(a) < distance(b);
    });
  };
  const LoadFunction zero = [](const Point&, double) { return 0.0; };
  const std::size_t middle = nearest({0.001, 0.001, 0}), beside = nearest({0.2, 0.001, 0});
  constraints.add({.slave = middle, .terms = {{zero, {}, 0, 1, 6}}});
  constraints.add({.slave = body.size() + middle, .terms = {{zero, {}, 1, 1, 6}}});
  constraints.add({.slave = body.size() + beside, .terms = {{zero, {}, 1, 1, 6}}});
}

/// Mean strain of the middle half of the bar.
double middle_strain(const Body& body, std::span<const double> u) {
  double xx = 0, xu = 0;
  for (const std::size_t i : body.points) {
    const Point x = body.position(i);
    if (std::abs(x[0]) > 0.25) continue;
    xx += x[0] * x[0];
    xu += x[0] * u[i];
  }
  return xu / xx;
}

TEST(Traction, StretchesABarByStressOverModulusInStatics) {
  for (const auto solve : {relax, newton}) {
    Pmb model = bar();
    Constraints constraints(model.dofs(), 7);
    hold_middle(model.body(), constraints);
    Observer nobody;
    const State state =
        solve(model, constraints,
              {.targets = {2},
               .increment = 1,
               .tolerance = 1e-5,
               .external = pull(model.body(), 1e6, [](double stretch) { return stretch - 1; })},
              nobody, nullptr);
    // Points of free edges lack bonds, which the model makes up for in part: measured 0.5 % too soft.
    EXPECT_NEAR(middle_strain(model.body(), state.u), 1e-3, 1e-5);
    // Nothing needs holding: 1e-5 of the applied forces is left at 800 points, whose sum and moment (over the
    // 0.2 m between the points held) the constraints take; measured 81 N of 3.5e5 N.
    EXPECT_LT(constraints.reaction_norm(), 350);
    EXPECT_LT(std::abs(state.energy.error()), 1e-2);  // the response is all but linear
  }
}

TEST(Start, FromEquilibriumNothingMovesAndTheBalanceCloses) {
  Pmb model = bar();
  Constraints constraints(model.dofs(), 7);
  hold_middle(model.body(), constraints);
  Observer nobody;
  VelocityVerletSettings settings{.until = 1e-3, .every = 1e-3, .history_every = 1e-3};
  settings.external = pull(model.body(), 1e6, [](double) { return 1.0; });
  settings.rest_tolerance = 1e-8;
  const State rest = march(model, constraints, settings, nobody);
  EXPECT_GT(middle_strain(model.body(), rest.u), 1e-3);
  EXPECT_LT(rest.energy.kinetic, 1e-10 * rest.energy.strain);
  settings.rest_tolerance.reset();
  const State shaken = march(model, constraints, settings, nobody);
  EXPECT_GT(shaken.energy.kinetic, 0.01 * shaken.energy.strain);  // without it there is a jump
  EXPECT_LT(std::abs(shaken.energy.error()), 0.01);               // as of Verlet's steps
}

TEST(Start, SaysSoIfTheBodyIsFree) {
  FreePoints model;
  Constraints constraints(2, 1);
  Observer nobody;
  auto settings = motion(1, 0.1);
  settings.external = on_second_point([](const Point&, double) { return 1.0; });
  settings.rest_tolerance = 1e-5;
  try {
    march(model, constraints, settings, nobody);
    FAIL() << "a free body has come to rest under a force";
  } catch (const SolverFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find("free to move"), std::string::npos) << failure.what();
  }
}

}  // namespace
}  // namespace riven::testing
