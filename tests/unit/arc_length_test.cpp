// Paths of equilibria through limit points: a truss of two bars, whose paths are known in closed form, and
// arches of a few elements.

#include "solver/arc_length.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "load/distributed_force.hpp"
#include "solver/newton.hpp"
#include "support/bodies.hpp"
#include "support/finite_element_bodies.hpp"
#include "support/loads.hpp"
#include "support/pulled_point.hpp"
#include "support/random.hpp"
#include "support/stopped_run.hpp"

namespace riven::testing {
namespace {

/// Two bars from (-a, 0) and (a, 0) to an apex at (0, h), of stiffness 1 times their rest length l0, with the
/// energy e^2 / 2 per length of the strain e = (l^2 / l0^2 - 1) / 2. The apex is pulled down by a spring, if
/// one is given: to entry 2, which is prescribed. Entries 0 and 1: displacements of the apex to the right and
/// down. Far from symmetry it has an energy that grows, so that all states are sound.
class Truss final : public PulledPoint {
 public:
  Truss(double a, double h, double spring) : a_(a), h_(h), spring_(spring), l02_(a * a + h * h) {}

  [[nodiscard]] std::size_t dofs() const override { return 3; }
  std::optional<Breakdown> internal_force(std::span<const double> u, std::span<double> force) override {
    force[0] = force[1] = 0;
    for (const double side : {-1.0, 1.0}) {
      const auto [e, x, y] = bar(u, side);
      force[0] -= e * x / std::sqrt(l02_);
      force[1] += e * y / std::sqrt(l02_);
    }
    force[2] = -spring_ * (u[2] - u[1]);
    force[1] -= force[2];
    return std::nullopt;
  }
  [[nodiscard]] double strain_energy(std::span<const double> u) override {
    double sum = 0.5 * spring_ * (u[2] - u[1]) * (u[2] - u[1]);
    for (const double side : {-1.0, 1.0}) sum += 0.5 * std::sqrt(l02_) * std::pow(bar(u, side).strain, 2);
    return sum;
  }
  void mass(std::span<double> mass) const override { std::fill(mass.begin(), mass.end(), 1.0); }
  void stiffness_bound(std::span<const double>, std::span<double> bound) override {
    std::fill(bound.begin(), bound.end(), 4 + spring_);
  }
  [[nodiscard]] std::size_t tangent_parts() const override { return 1; }
  void tangent(std::span<const double> u, std::size_t first, std::size_t last,
               TangentBlocks& to) const override {
    if (first == last) return;
    double xx = 0, xy = 0, yy = 0;
    for (const double side : {-1.0, 1.0}) {
      const auto [e, x, y] = bar(u, side);
      xx += (x * x / l02_ + e) / std::sqrt(l02_);
      xy -= x * y / l02_ / std::sqrt(l02_);
      yy += (y * y / l02_ + e) / std::sqrt(l02_);
    }
    for (const std::size_t entry : {0U, 1U, 2U}) to.dofs.push_back(entry);
    to.begin.push_back(to.dofs.size());
    const double k = spring_;
    to.values.insert(to.values.end(), {xx, xy, 0, xy, yy + k, -k, 0, -k, k});
  }

  /// The force down that holds the apex w below where it was, on the way straight down.
  [[nodiscard]] double force_at(double w) const {
    const double y = h_ - w;
    return y * (h_ * h_ - y * y) / std::pow(l02_, 1.5);
  }

 private:
  struct Bar {
    double strain, x, y;  // from its foot to the apex
  };
  [[nodiscard]] Bar bar(std::span<const double> u, double side) const {
    const double x = u[0] - side * a_, y = h_ - u[1];
    return {0.5 * ((x * x + y * y) / l02_ - 1), x, y};
  }
  double a_, h_, spring_, l02_;
};

/// A force down on the apex, (p - 1) times `unit`, and p - 1 times `aside` to the right.
class ApexForce final : public ExternalForce {
 public:
  explicit ApexForce(double unit, double aside = 0) : unit_(unit), aside_(aside) {}
  void add(std::span<const double>, std::span<const double>, double p, std::span<double> force) override {
    force[0] += aside_ * (p - 1);
    force[1] += unit_ * (p - 1);
  }
  [[nodiscard]] double work(std::span<const double> before, double p0, std::span<const double> u,
                            double p) const override {
    return 0.5 * (p0 + p - 2) * (unit_ * (u[1] - before[1]) + aside_ * (u[0] - before[0]));
  }

 private:
  double unit_, aside_;
};

struct PathLog : Observer {
  void progressed(const SolverProgress& progress) override {
    if (progress.iteration == 0 || residuals.empty()) residuals.emplace_back();
    residuals.back().push_back(progress.residual);
  }
  void reached(const State& state, const Constraints& constraints, bool output) override {
    states.push_back(state);
    pulls.push_back(constraints.reaction(0)[1]);
    if (output) outputs.push_back(state.parameter);
  }
  void remarked(const std::string& remark) override { remarks.push_back(remark); }
  /// The stretches of remarks that contain some words.
  [[nodiscard]] std::vector<double> stretches(const std::string& words) const {
    std::vector<double> list;
    for (const std::string& remark : remarks)
      if (remark.find(words) != std::string::npos)
        list.push_back(std::stod(remark.substr(remark.find("stretch ") + 8)));
    return list;
  }
  std::vector<State> states;
  std::vector<double> pulls;  // of load 0, along y (N)
  std::vector<double> outputs;
  std::vector<std::string> remarks;
  std::vector<std::vector<double>> residuals;
};

/// Nothing moves entry 2 of a truss without a spring.
Constraints hold_spring() {
  Constraints constraints(3, 1);
  constraints.add({.slave = 2, .terms = {{[](const Point&, double) { return 0.0; }, {}, 1, 1, 0}}});
  return constraints;
}

ArcLengthSettings settings_of(std::vector<double> targets, double increment, long steps,
                              ExternalForces external = {}) {
  return {{.targets = std::move(targets),
           .increment = increment,
           .tolerance = 1e-10,
           .external = std::move(external)},
          steps};
}

// A shallow truss under a force snaps through: the path goes over the maximum of the load, down to its
// opposite and up again, to the load asked for on the other side.
TEST(ArcLength, FollowsATrussThroughItsLimitPoints) {
  const double h = 0.3, unit = 0.01;
  Truss truss(1, h, 0);
  Constraints constraints = hold_spring();
  PathLog log;
  const State state = follow_path(truss, constraints,
                                  settings_of({1.2, 3}, 0.1, 1000, {std::make_shared<ApexForce>(unit)}), log);
  double before = 0;
  for (const State& s : log.states) {
    EXPECT_EQ(s.u[0], 0);
    EXPECT_GT(s.u[1], before);                                             // the apex never goes back
    EXPECT_NEAR(unit * (s.parameter - 1), truss.force_at(s.u[1]), 1e-14);  // measured 9e-17
    before = s.u[1];
  }
  EXPECT_EQ(state.parameter, 3);
  EXPECT_GT(state.u[1], 2 * h);
  EXPECT_EQ(log.outputs, (std::vector<double>{1.2, 3}));
  const auto limits = log.stretches("limit point");
  ASSERT_EQ(limits.size(), 2U);
  const double greatest = truss.force_at(h * (1 - 1 / std::sqrt(3))) / unit;
  EXPECT_NEAR(limits[0], 1 + greatest, 1e-5);  // of the cubic: measured 3e-6
  EXPECT_NEAR(limits[1], 1 - greatest, 1e-5);
  EXPECT_TRUE(log.stretches("branch").empty());
  EXPECT_EQ(log.remarks[0].find("unstable in 1 way") == std::string::npos, false) << log.remarks[0];
  EXPECT_NE(log.remarks[1].find(", stable"), std::string::npos) << log.remarks[1];
}

// With a soft spring between the load and the apex it is the load's displacement that turns back.
TEST(ArcLength, FollowsPrescribedDisplacementsThatTurnBack) {
  const double h = 0.4, spring = 0.02;
  Truss truss(1, h, spring);
  Constraints constraints(3, 1);
  constraints.add({.slave = 2, .terms = {{[](const Point&, double p) { return p - 1; }, {}, 1, 1, 0}}});
  PathLog log;
  const State state = follow_path(truss, constraints, settings_of({3.5}, 0.05, 1000), log);
  EXPECT_EQ(state.parameter, 3.5);
  for (const State& s : log.states) {
    const double w = s.u[1];
    EXPECT_NEAR(s.parameter - 1, w + truss.force_at(w) / spring, 1e-12);
    EXPECT_EQ(s.u[2], s.parameter - 1);
  }
  // The force over w has the slope (3 y^2 - h^2) / l0^3 with y = h - w, which is -spring where the load
  // turns.
  const double l03 = std::pow(1 + h * h, 1.5), y = std::sqrt((h * h - spring * l03) / 3);
  const auto limits = log.stretches("limit point");
  ASSERT_EQ(limits.size(), 2U);
  for (const std::size_t n : {0U, 1U}) {
    const double w = n == 0 ? h - y : h + y;
    EXPECT_NEAR(limits[n], 1 + w + truss.force_at(w) / spring, 1e-5);  // measured 3e-6
  }
  // Springs lose no energy; parabolas of the force over steps of some hundredths of the path.
  EXPECT_LT(std::abs(state.energy.error()), 2e-4);  // measured 4e-5
}

// A steep truss gives way to the side before its load is greatest. The path straight down goes on.
TEST(ArcLength, TellsWhereABranchLeaves) {
  const double a = 0.5, h = 1.2, unit = 0.1, l0 = std::hypot(a, h);
  Truss truss(a, h, 0);
  Constraints constraints = hold_spring();
  PathLog log;
  follow_path(truss, constraints, settings_of({100}, 0.1, 90, {std::make_shared<ApexForce>(unit)}), log);
  const auto branches = log.stretches("branch leaves");
  const double y = std::sqrt(h * h - 2 * a * a);
  ASSERT_GT(y, h / std::sqrt(3));
  ASSERT_GE(branches.size(), 1U);
  EXPECT_NEAR(branches[0], 1 + y * 2 * a * a / std::pow(l0, 3) / unit, 1e-4);  // 2e-5
  const auto limits = log.stretches("limit point");
  ASSERT_GE(limits.size(), 1U);
  EXPECT_NEAR(limits[0], 1 + truss.force_at(h * (1 - 1 / std::sqrt(3))) / unit, 1e-5);
  EXPECT_NE(log.remarks[0].find("unstable in 1 way"), std::string::npos) << log.remarks[0];
  EXPECT_NE(log.remarks[1].find("unstable in 2 ways"), std::string::npos) << log.remarks[1];
}

// To find the place of a branch the state before is looked at once more; observers see the forces of this
// one.
TEST(ArcLength, ShowsTheForcesOfEveryState) {
  const double a = 0.5, h = 1.2, spring = 5;
  Truss truss(a, h, spring);
  Constraints constraints(3, 1);
  constraints.add({.slave = 2, .terms = {{[](const Point&, double p) { return p - 1; }, {}, 1, 1, 0}}});
  PathLog log;
  follow_path(truss, constraints, settings_of({1.5}, 0.02, 1000), log);
  const auto branches = log.stretches("branch leaves");
  ASSERT_EQ(branches.size(), 1U);
  const double w = h - std::sqrt(h * h - 2 * a * a);
  EXPECT_NEAR(branches[0], 1 + w + truss.force_at(w) / spring, 1e-4);  // of second order in the step
  for (std::size_t n = 0; n < log.states.size(); ++n)
    EXPECT_NEAR(log.pulls[n], spring * (log.states[n].u[2] - log.states[n].u[1]), 1e-12);
}

// A small force to one side takes the paths apart: the load then leads along the side's one.
TEST(ArcLength, GoesToTheSideWithAnImperfection) {
  const double a = 0.5, h = 1.2, unit = 0.1;
  Truss truss(a, h, 0);
  Constraints constraints = hold_spring();
  PathLog log;
  follow_path(truss, constraints, settings_of({100}, 0.1, 60, {std::make_shared<ApexForce>(unit, 1e-4)}),
              log);
  EXPECT_GT(log.states.back().u[0], 0.2);
  EXPECT_TRUE(log.stretches("branch").empty());
}

// The end of a step lies where the plane says: in the first one, changes of load and of displacement, both in
// terms of the first response, add up to twice the increment. All steps are as long at the most.
TEST(ArcLength, TakesStepsOfTheLengthAskedFor) {
  const double h = 0.3, unit = 0.01, increment = 0.02;
  Truss truss(1, h, 0);
  Constraints constraints = hold_spring();
  PathLog log;
  follow_path(truss, constraints, settings_of({9}, increment, 40, {std::make_shared<ApexForce>(unit)}), log);
  const double softness = unit * std::pow(1 + h * h, 1.5) / (2 * h * h);  // dw/dp at rest
  ASSERT_EQ(log.states.size(), 40U);
  EXPECT_NEAR(log.states[0].u[1] / softness + log.states[0].parameter - 1, 2 * increment, 1e-12);
  for (std::size_t n = 1; n < log.states.size(); ++n) {
    const double length = std::hypot((log.states[n].u[1] - log.states[n - 1].u[1]) / softness,
                                     log.states[n].parameter - log.states[n - 1].parameter);
    EXPECT_LT(length, 1.05 * std::sqrt(2) * increment);
    EXPECT_GT(length, 0.2 * std::sqrt(2) * increment);
  }
}

// Steps far longer than what the path turns in are halved until they follow it, and are long again where it
// is straight: the same limit points, no more steps than it takes.
TEST(ArcLength, ShortensStepsWhereThePathTurns) {
  const double h = 0.3, unit = 0.01;
  Truss truss(1, h, 0);
  Constraints constraints = hold_spring();
  PathLog log;
  const State state =
      follow_path(truss, constraints, settings_of({40}, 3, 1000, {std::make_shared<ApexForce>(unit)}), log);
  ASSERT_EQ(log.stretches("limit point").size(), 2U);
  double longest = 0, shortest = 1e9;
  const double softness = unit * std::pow(1 + h * h, 1.5) / (2 * h * h);
  for (std::size_t n = 1; n < log.states.size(); ++n) {
    const double length = std::hypot((log.states[n].u[1] - log.states[n - 1].u[1]) / softness,
                                     log.states[n].parameter - log.states[n - 1].parameter);
    longest = std::max(longest, length);
    if (log.states[n].parameter < 40) shortest = std::min(shortest, length);
  }
  EXPECT_LT(shortest, 1.1);                    // a turn of 35 degrees takes about that
  EXPECT_GT(longest, 0.9 * 3 * std::sqrt(2));  // the longest step
  EXPECT_LT(state.steps, 60);
}

// Before a limit point, at it, where the tangent is singular, and behind it.
TEST(ArcLength, ConvergesQuadratically) {
  Truss truss(1, 0.3, 0);
  Constraints constraints = hold_spring();
  PathLog log;
  follow_path(truss, constraints, settings_of({3}, 0.2, 1000, {std::make_shared<ApexForce>(0.01)}), log);
  int judged = 0;
  for (const std::vector<double>& r : log.residuals)
    for (std::size_t n = 1; n + 1 < r.size(); ++n)
      if (r[n - 1] < 0.1 && r[n] > 1e-6 && r[n + 1] > 1e-14) {
        EXPECT_GT(std::log(r[n + 1] / r[n]) / std::log(r[n] / r[n - 1]), 1.6);
        ++judged;
      }
  EXPECT_GT(judged, 10);
}

MeshBody arch_mesh(double rise) {
  return make_mesh(ElementShape::q8, {12, 1}, 1, arch_map({10, rise, 0.25}));
}

/// A clamped shallow arch of rubber, and the number of the node that its crown is loaded at.
struct ShallowArch {
  ShallowArch() : model(elements_of(arch_mesh(0.5), unit_laws()[0].material(), Plane::stress)) {
    const auto& nodes = model->mesh().node;
    for (std::size_t n = 0; n < nodes.size(); ++n)
      if (std::abs(nodes[n][0]) < 1e-9 && nodes[n][1] > nodes[crown][1]) crown = n;
    for (const std::size_t face : {0U, 1U})
      for (const std::size_t node : model->mesh().nodes_on(face))
        for (const std::size_t axis : {0U, 1U}) hold(node, axis, 0);
  }
  void hold(std::size_t node, std::size_t axis, double rate) {
    const LoadFunction displacement = [rate](const Point&, double p) { return rate * (p - 1); };
    constraints.add(
        {.slave = axis * model->points() + node,
         .terms = {{displacement, model->place(node), static_cast<int>(axis), 1, rate == 0 ? 0U : 1U}}});
  }
  [[nodiscard]] std::size_t entry() const { return model->points() + crown; }

  std::unique_ptr<FiniteElements> model;
  std::size_t crown = 0;
  Constraints constraints{model->dofs(), 2};
};

// Behind the limit point a force finds the states that a displacement of the crown does, where it is the
// displacement that is given: two methods, two problems, one path.
TEST(ArcLength, FindsTheForcesOfDisplacementControl) {
  ShallowArch loaded, moved;
  const ExternalForces force{std::make_shared<DistributedForce>(
      DistributedForce::Density{std::nullopt, [](const Point&, double p) { return -1e-3 * (p - 1); }},
      std::vector<LoadShare>{{loaded.crown, {}, 1}}, loaded.model->points())};
  PathLog log;
  const State state = follow_path(*loaded.model, loaded.constraints, settings_of({50}, 0.2, 60, force), log);
  ASSERT_EQ(log.stretches("limit point").size(), 2U) << state.parameter;
  moved.hold(moved.crown, 1, -1);
  int compared = 0;
  for (const State& s : log.states) {
    if (compared * 0.15 > -s.u[loaded.entry()]) continue;
    ++compared;
    ShallowArch at;
    at.hold(at.crown, 1, -1);
    Observer nobody;
    static_cast<void>(newton(*at.model, at.constraints,
                             {.targets = {1 - s.u[loaded.entry()]}, .increment = 0.05, .tolerance = 1e-10},
                             nobody));
    EXPECT_NEAR(at.constraints.reaction(1)[1], -1e-3 * (s.parameter - 1), 1e-12);  // measured 6e-15
  }
  EXPECT_GE(compared, 5);
  EXPECT_LT(std::abs(state.energy.error()), 1e-3);
}

using Stopper = StopsAt<PathLog>;

TEST(ArcLength, ResumesToTheSameBits) {
  const auto run = [](Stopper& observer, const Snapshot* from) {
    Truss truss(0.5, 1.2, 0.5);
    Constraints constraints(3, 1);
    constraints.add({.slave = 2, .terms = {{[](const Point&, double p) { return p - 1; }, {}, 1, 1, 0}}});
    return follow_path(truss, constraints,
                       settings_of({1.3, 2, 4}, 0.1, 70, {std::make_shared<ApexForce>(0.1, 1e-3)}), observer,
                       from);
  };
  Stopper whole;
  const State expected = run(whole, nullptr);
  ASSERT_GT(whole.points, 60);
  for (long stop = 0; stop < whole.points; stop += 29) {
    Stopper first, rest;
    first.stop_at = stop;
    EXPECT_THROW(run(first, nullptr), Stopped);
    const State state = run(rest, &first.snapshot);
    EXPECT_EQ(state.u, expected.u) << stop;
    EXPECT_EQ(state.energy.external_work, expected.energy.external_work) << stop;
    EXPECT_EQ(state.evaluations, expected.evaluations) << stop;
    EXPECT_EQ(first.outputs.size() + rest.outputs.size(), whole.outputs.size()) << stop;
    EXPECT_EQ(first.remarks.size() + rest.remarks.size(), whole.remarks.size()) << stop;
  }
}

// Rollers let the sheet slide along its loaded edges; nothing pushes it there, and it must stay.
TEST(ArcLength, KeepsStillWhatNothingHolds) {
  Membrane membrane(make_lattice_body(sheet(20, 14, 0.05, Faces(0b0011))), unit_laws()[1].material(), 4);
  Constraints constraints = constrain(membrane, uniaxial());
  PathLog log;
  ArcLengthSettings settings = settings_of({1.5}, 0.1, 100);
  settings.loads.tolerance = 1e-6;  // below that slides by rounding count
  const State state = follow_path(membrane, constraints, settings, log);
  double mean = 0;
  for (const std::size_t i : membrane.body().points) mean += state.u[membrane.body().size() + i];
  mean /= static_cast<double>(membrane.body().points.size());
  EXPECT_LT(std::abs(mean), 1e-5);  // as in the test of Newton's method
  EXPECT_TRUE(log.remarks.empty());
}

TEST(ArcLength, RefusesLoadsThatStandStill) {
  Truss truss(1, 0.3, 0);
  Constraints constraints = hold_spring();
  Observer nobody;
  EXPECT_THROW(follow_path(truss, constraints, settings_of({2}, 0.1, 10), nobody), SolverFailure);
}

TEST(ArcLength, EndsAfterTheStepsAskedForAndSaysSo) {
  Truss truss(1, 0.3, 0);
  Constraints constraints = hold_spring();
  PathLog log;
  const State state =
      follow_path(truss, constraints, settings_of({3}, 0.1, 7, {std::make_shared<ApexForce>(0.01)}), log);
  EXPECT_EQ(state.steps, 7);
  EXPECT_EQ(log.states.size(), 7U);
  EXPECT_EQ(log.outputs.size(), 1U);
  EXPECT_EQ(log.stretches("max_steps").size(), 1U);
}

/// A bar that nothing holds together beyond a stretch: energy u - u^2 / 2 ends at u = 1... the force falls to
/// nothing, and beyond the state is refused.
TEST(ArcLength, GivesUpWhereThePathEnds) {
  class Brittle final : public PulledPoint {
   public:
    std::optional<Breakdown> internal_force(std::span<const double> u, std::span<double> force) override {
      if (u[1] > 0.5) return Breakdown{{0.25, 0, 0}, "torn"};
      force[0] = 0;
      force[1] = -u[1];
      return std::nullopt;
    }
    [[nodiscard]] double strain_energy(std::span<const double> u) override { return 0.5 * u[1] * u[1]; }
    void stiffness_bound(std::span<const double>, std::span<double> bound) override {
      bound[0] = bound[1] = 1;
    }
    [[nodiscard]] std::size_t tangent_parts() const override { return 1; }
    void tangent(std::span<const double>, std::size_t first, std::size_t last,
                 TangentBlocks& to) const override {
      if (first == last) return;
      to.dofs.push_back(1);
      to.begin.push_back(to.dofs.size());
      to.values.push_back(1);
    }
  };
  class Pull final : public ExternalForce {
   public:
    void add(std::span<const double>, std::span<const double>, double p, std::span<double> force) override {
      force[1] += p - 1;
    }
    [[nodiscard]] double work(std::span<const double>, double, std::span<const double>,
                              double) const override {
      return 0;
    }
  };
  Brittle model;
  Constraints constraints = pull_point();
  PathLog log;
  try {
    follow_path(model, constraints, settings_of({2}, 0.2, 1000, {std::make_shared<Pull>()}), log);
    FAIL() << "no failure";
  } catch (const SolverFailure& failure) {
    const std::string what = failure.what();
    EXPECT_NE(what.find("lost beyond stretch 1."), std::string::npos) << what;
    EXPECT_NE(what.find("torn at (0.25, 0, 0) m"), std::string::npos) << what;
  }
  EXPECT_NEAR(log.states.back().parameter, 1.5, 1e-3);
}

}  // namespace
}  // namespace riven::testing
