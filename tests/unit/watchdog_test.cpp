#include "solver/watchdog.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "solver/dynamic_relaxation.hpp"
#include "solver/velocity_verlet.hpp"

namespace riven::testing {
namespace {

constexpr std::size_t kPoints = 10;
constexpr double kStiffness = 100;  // N/m; with a mass of 1 kg the stable step is 0.1 s
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Points along x, 1 m apart, each held to its place by a spring; entry i is u_x of point i at x = i. A fault
/// changes their forces from some evaluation on.
struct Springs : Model {
  std::function<void(std::span<const double> u, std::span<double> force, long evaluation)> fault;
  bool has_energy = true;
  long evaluations = 0;

  [[nodiscard]] std::size_t dofs() const override { return kPoints; }
  std::optional<Breakdown> internal_force(std::span<const double> u, std::span<double> force) override {
    for (std::size_t i = 0; i < kPoints; ++i) force[i] = -kStiffness * u[i];
    if (fault) fault(u, force, ++evaluations);
    return std::nullopt;
  }
  double strain_energy(std::span<const double> u) override {
    double sum = 0;
    for (const double x : u) sum += 0.5 * kStiffness * x * x;
    return sum;
  }
  [[nodiscard]] bool conservative() const override { return has_energy; }
  void mass(std::span<double> mass) const override { std::fill(mass.begin(), mass.end(), 1.0); }
  void stiffness_bound(std::span<const double>, std::span<double> bound) override {
    std::fill(bound.begin(), bound.end(), kStiffness);
  }
  [[nodiscard]] double spacing() const override { return 1; }
  std::optional<Breakdown> inspect(std::span<const double>) override { return std::nullopt; }
  void move(std::span<double>, const std::array<std::array<double, 3>, 3>&, const Point&) const override {}
  [[nodiscard]] std::vector<Point> positions() const override {
    std::vector<Point> places;
    for (std::size_t i = 0; i < kPoints; ++i) places.push_back(place(i));
    return places;
  }
  [[nodiscard]] std::vector<Point> displacements(std::span<const double> u) const override {
    std::vector<Point> all;
    for (const double x : u) all.push_back({x, 0, 0});
    return all;
  }
  std::vector<ModelField> fields(std::span<const double>) override { return {}; }
  [[nodiscard]] Point place(std::size_t entry) const override { return {static_cast<double>(entry), 0, 0}; }
  [[nodiscard]] std::vector<std::string> describe() const override { return {}; }
  [[nodiscard]] std::size_t points() const override { return kPoints; }
  [[nodiscard]] std::size_t bonds() const override { return 0; }
};

/// All states that observers got, which are those that could be written.
struct Written : Observer {
  void reached(const State& state, const Constraints&, bool) override {
    all_finite =
        all_finite && std::all_of(state.u.begin(), state.u.end(), [](double x) { return std::isfinite(x); });
    ++count;
  }
  void remarked(const std::string& remark) override { remarks.push_back(remark); }
  bool all_finite = true;
  int count = 0;
  std::vector<std::string> remarks;
};

/// Point 0 is moved by `load`; the others are free.
Constraints pushed(const LoadFunction& load) {
  Constraints constraints(kPoints, 1);
  constraints.add({.slave = 0, .terms = {{load, Point{}, 0, 1, 0}}});
  return constraints;
}

/// What a run in time says when it stops, and after how many evaluations; `push` moves all points a little.
struct Stopped {
  std::string what;
  Written written;
};

Stopped stopped_motion(Springs& springs, double every = 100) {
  Constraints constraints = pushed([](const Point&, double t) { return 1e-3 * std::sin(t); });
  Stopped stopped;
  try {
    march(springs, constraints, {.until = 100, .every = every, .history_every = every}, stopped.written);
  } catch (const SolverFailure& failure) {
    stopped.what = failure.what();
  }
  return stopped;
}

Stopped stopped_relaxation(Springs& springs, long max_iterations = 20000) {
  Constraints constraints = pushed([](const Point&, double s) { return s - 1; });
  Stopped stopped;
  try {
    relax(springs, constraints, {.targets = {1.1}, .max_iterations = max_iterations}, stopped.written);
  } catch (const SolverFailure& failure) {
    stopped.what = failure.what();
  }
  return stopped;
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Watchdog, NamesTheFirstPointWithoutANumberInMotion) {
  for (const double every : {100.0, 0.5}) {  // checks by steps, and before each output
    Springs springs;
    springs.fault = [](auto, std::span<double> force, long evaluation) {
      if (evaluation > 30) force[3] = force[7] = kNaN;
    };
    const Stopped stopped = stopped_motion(springs, every);
    EXPECT_TRUE(says(stopped.what, "is not a finite number at (3, 0, 0) m")) << stopped.what;
    EXPECT_TRUE(says(stopped.what, "at t = ")) << stopped.what;
    EXPECT_TRUE(says(stopped.what, "a smaller solver.safety")) << stopped.what;
    EXPECT_TRUE(stopped.written.all_finite);
    EXPECT_LE(springs.evaluations, 30 + 100);
  }
}

TEST(Watchdog, NamesALoadThatIsNoNumber) {
  Springs springs;
  Constraints constraints = pushed([](const Point&, double t) { return std::sqrt(1 - t); });
  Written written;
  try {
    march(springs, constraints, {.until = 10, .every = 0.5, .history_every = 0.5}, written);
    FAIL() << "no failure";
  } catch (const SolverFailure& failure) {
    EXPECT_TRUE(
        says(failure.what(), "the displacement that a load prescribes is not a finite number at (0, 0, 0) m"))
        << failure.what();
  }
  EXPECT_TRUE(written.all_finite);
  EXPECT_EQ(written.count, 3);  // 0, 0.5 and 1 s
}

TEST(Watchdog, NamesThePointThatLeavesAMovingBody) {
  Springs springs;
  // A spring that pushes instead of pulling, with its energy: the balance does not see it.
  springs.has_energy = false;
  springs.fault = [](std::span<const double> u, std::span<double> force, long evaluation) {
    if (evaluation > 20) force[4] = 1e3 * u[4] + 1e-3;
  };
  const Stopped stopped = stopped_motion(springs);
  EXPECT_TRUE(says(stopped.what, "a point has left the body, which measures 10 m")) << stopped.what;
  EXPECT_TRUE(says(stopped.what, " at (4, 0, 0) m")) << stopped.what;
  EXPECT_TRUE(says(stopped.what, " and moves at ")) << stopped.what;
  EXPECT_TRUE(stopped.written.all_finite);
  EXPECT_LE(springs.evaluations, 20 + 200);  // some 20 steps to leave, then up to 100 to the next look
}

TEST(Watchdog, FollowsTheEnergyWhereThereIsOne) {
  const auto fault = [](std::span<const double>, std::span<double> force, long evaluation) {
    if (evaluation > 20) force[6] += 1;  // work that no load does
  };
  Springs springs;
  springs.fault = fault;
  const Stopped stopped = stopped_motion(springs);
  EXPECT_TRUE(says(stopped.what, "the energy runs away")) << stopped.what;
  EXPECT_TRUE(says(stopped.what, "at (6, 0, 0) m")) << stopped.what;
  EXPECT_TRUE(says(stopped.what, "solver.safety")) << stopped.what;
  Springs without;
  without.has_energy = false;
  without.fault = fault;
  EXPECT_EQ(stopped_motion(without).what, "");
}

TEST(Watchdog, NamesTheFirstPointWithoutANumberInStatics) {
  Springs springs;
  springs.fault = [](auto, std::span<double> force, long) { force[5] = force[8] = kNaN; };
  const Stopped stopped = stopped_relaxation(springs);
  EXPECT_TRUE(says(stopped.what, "the force is not a finite number at (5, 0, 0) m")) << stopped.what;
  EXPECT_TRUE(says(stopped.what, "no equilibrium beyond 1 (load step 1)")) << stopped.what;
  EXPECT_TRUE(says(stopped.what, "try a finer lattice, or another load")) << stopped.what;
  EXPECT_FALSE(says(stopped.what, "increment")) << "it was halved 256 times";
  EXPECT_EQ(stopped.written.count, 0);
}

TEST(Watchdog, NamesThePointThatLeavesABodyAtRest) {
  Springs springs;
  springs.fault = [](std::span<const double> u, std::span<double> force, long) {
    force[2] = kStiffness * u[2] + 1e-3;
  };
  const Stopped stopped = stopped_relaxation(springs);
  EXPECT_TRUE(says(stopped.what, "a point has left the body")) << stopped.what;
  EXPECT_TRUE(says(stopped.what, "at (2, 0, 0) m")) << stopped.what;
  EXPECT_FALSE(says(stopped.what, "moves at")) << "there is no time in statics";
}

TEST(Watchdog, NamesWhereTheResidualStalls) {
  Springs springs;
  springs.fault = [](auto, std::span<double> force, long evaluation) {
    force[7] += evaluation % 2 == 0 ? 1 : -1;  // never comes to rest
  };
  const Stopped stopped = stopped_relaxation(springs);
  EXPECT_TRUE(says(stopped.what, "the residual has stalled for 5000 iterations")) << stopped.what;
  EXPECT_TRUE(says(stopped.what, "the largest force at (7, 0, 0) m")) << stopped.what;
  ASSERT_FALSE(stopped.written.remarks.empty());
  EXPECT_LT(springs.evaluations, 9 * 6000);  // nine steps, none of which ran to 20000
}

TEST(Watchdog, NamesWhereARunHasNotConverged) {
  Springs springs;
  springs.fault = [](auto, std::span<double> force, long evaluation) {
    force[7] += evaluation % 2 == 0 ? 1 : -1;
  };
  const Stopped stopped = stopped_relaxation(springs, 300);
  EXPECT_TRUE(says(stopped.what, "not converged in the 300 iterations of solver.max_iterations"))
      << stopped.what;
  EXPECT_TRUE(says(stopped.what, "the largest force at (7, 0, 0) m")) << stopped.what;
}

TEST(Watchdog, LeavesSoundRunsAlone) {
  Springs moving;
  const Stopped motion = stopped_motion(moving, 0.5);
  EXPECT_EQ(motion.what, "");
  EXPECT_EQ(motion.written.count, 201);
  Springs still;
  const Stopped rest = stopped_relaxation(still);
  EXPECT_EQ(rest.what, "");
  EXPECT_TRUE(rest.written.remarks.empty());
  // A load may carry the body a thousand of its sizes away.
  Springs thrown;
  Constraints constraints = pushed([](const Point&, double t) { return 100 * t; });
  Written written;
  EXPECT_NO_THROW(march(thrown, constraints, {.until = 100, .every = 1, .history_every = 1}, written));
}

TEST(StallWatch, ToleratesSlowProgressAndRisesInBetween) {
  StallWatch slow(1000), to_and_fro(1000), stuck(1000);
  for (long n = 0; n < 20000; ++n) {
    // A tenth in 500 iterations; the same under an oscillation; and nothing at all.
    EXPECT_FALSE(slow.stalled(n, std::pow(0.9, static_cast<double>(n) / 500)));
    EXPECT_FALSE(to_and_fro.stalled(
        n, std::pow(0.9, static_cast<double>(n) / 500) * (2 + std::sin(static_cast<double>(n) / 30))));
    EXPECT_EQ(stuck.stalled(n, 1.0), n >= 1000);
  }
}

}  // namespace
}  // namespace riven::testing
