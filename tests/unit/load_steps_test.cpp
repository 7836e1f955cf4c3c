// Which method takes a load step, and from where, on models of one point and methods that do as they are
// told.

#include "solver/load_steps.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "support/pulled_point.hpp"

namespace riven::testing {
namespace {

/// A spring between the load and the point, that breaks for good, with an energy of 1 J, when the load has
/// gone beyond 0.5.
class BrittleSpring final : public PulledPoint {
 public:
  std::optional<Breakdown> internal_force(std::span<const double> u, std::span<double> force) override {
    force[1] = broken_ ? 0 : u[0] - u[1];
    force[0] = -force[1];
    return std::nullopt;
  }
  [[nodiscard]] Passage advance(std::span<const double> u, std::span<double> force) override {
    broken_ = broken_ || (breaks && u[0] > 0.5);
    return {.breakdown = internal_force(u, force)};
  }
  [[nodiscard]] double dissipated_energy() const override { return broken_ ? 1 : 0; }
  [[nodiscard]] double strain_energy(std::span<const double> u) override {
    return broken_ ? 0 : 0.5 * (u[0] - u[1]) * (u[0] - u[1]);
  }
  void stiffness_bound(std::span<const double>, std::span<double> bound) override { bound[0] = bound[1] = 1; }
  void save(Snapshot& to) const override { to.saving()("spring.broken", broken_); }
  void restore(const Snapshot& from) override { from.restoring()("spring.broken", broken_); }

  bool breaks = false;

 private:
  bool broken_ = false;
};

/// A method whose iterations are a function; it tells where it begins.
class Scripted final : public Equilibrium {
 public:
  using Iterate = std::function<Iteration::Outcome(State&)>;
  Scripted(Model& model, Constraints& constraints, std::string name, std::vector<double>& begun,
           Iterate iterate)
      : forces_(model, constraints, {}),
        name_(std::move(name)),
        begun_(begun),
        iterate_(std::move(iterate)) {}

  void begin(const State& state) override {
    forces_.rescale(state);
    begun_.push_back(state.u[1]);
  }
  Iteration iterate(State& state, long) override {
    static_cast<void>(forces_.evaluate(state));
    return {iterate_(state), "as told"};
  }
  [[nodiscard]] const FreeForces& forces() const override { return forces_; }
  [[nodiscard]] int most_cuts() const override { return 0; }
  [[nodiscard]] std::string name() const override { return name_; }
  void save(Snapshot&) const override {}
  void restore(const Snapshot&) override {}

 private:
  FreeForces forces_;
  std::string name_;
  std::vector<double>& begun_;
  Iterate iterate_;
};

struct Told : Observer {
  void reached(const State& state, const Constraints&, bool) override { steps.push_back(state.parameter); }
  void remarked(const std::string& remark) override { remarks.push_back(remark); }
  std::vector<double> steps;
  std::vector<std::string> remarks;
};

struct Pulled {
  BrittleSpring spring;
  Constraints constraints = pull_point();
  std::vector<double> begun_first, begun_second;
  Told told;

  State operator()(const Scripted::Iterate& first, const Scripted::Iterate& second) {
    LoadSteps::Methods methods;
    methods.push_back(std::make_unique<Scripted>(spring, constraints, "the first", begun_first, first));
    methods.push_back(std::make_unique<Scripted>(spring, constraints, "the second", begun_second, second));
    return LoadSteps(spring, constraints, {.targets = {2}, .increment = 0.1}, std::move(methods), told)
        .run(nullptr);
  }
};

TEST(LoadSteps, GoBackToTheFirstMethodAfterAStepOfTheSecond) {
  Pulled run;
  const auto converge = [](State& state) {
    state.u[1] = state.u[0];
    return Iteration::Outcome::converged;
  };
  run(
      [&](State& state) {
        const bool hard = state.u[0] > 0.35 && state.u[0] < 0.55;  // two of eleven steps
        return hard ? Iteration::Outcome::failed : converge(state);
      },
      converge);
  EXPECT_EQ(run.told.steps.size(), 11U);
  EXPECT_EQ(run.begun_first.size(), 11U);
  EXPECT_EQ(run.begun_second.size(), 2U);
  ASSERT_EQ(run.told.remarks.size(), 2U);
  EXPECT_NE(run.told.remarks[0].find("(as told); going on with the second for this step"), std::string::npos);
}

// Where bonds have broken there is no way back to the start of the step: the next method begins where they
// did.
TEST(LoadSteps, HandOverTheStateInWhichBondsBroke) {
  Pulled run;
  run.spring.breaks = true;
  double at_break = 0;
  const State end = run(
      [&](State& state) {
        if (run.spring.dissipated_energy() == 0) {
          at_break = state.u[1] = 2 * state.u[0];
          return Iteration::Outcome::converged;
        }
        if (run.begun_second.empty()) {
          state.u[1] = 1e3;  // lost on its way
          return Iteration::Outcome::failed;
        }
        return Iteration::Outcome::converged;
      },
      [](State&) { return Iteration::Outcome::converged; });
  ASSERT_EQ(run.begun_second.size(), 1U);
  EXPECT_EQ(run.begun_second[0], at_break);
  // The step that goes beyond 0.5 was cut to an eighth first.
  EXPECT_LE(at_break, 2 * (0.5 + 0.1 / 8));
  EXPECT_GT(at_break, 2 * 0.5);
  // The spring held 0.5 u^2 when it broke, of which it says that 1 J went: the rest went on the way to rest.
  EXPECT_NEAR(end.energy.dissipated, 0.125 * at_break * at_break, 1e-12);
}

}  // namespace
}  // namespace riven::testing
