// Statics of a body with two equilibria, on the Model interface alone: a double well pulled by a spring.

#include <gtest/gtest.h>

#include <cmath>

#include "solver/dynamic_relaxation.hpp"
#include "support/pulled_point.hpp"

namespace riven::testing {
namespace {

/// E = x^2 (x - 2)^2 + (x - p)^2 / 2, where the load moves p = u[0] and x = u[1] is free. At rest in the well
/// at 0; it loses stability where the second derivative vanishes, at x = 1/2 and p = 2, and snaps to the well
/// at 2.
/// `inspect` finds fault with x beyond `sound_to`, as it does with folded sheets: there the forces balance
/// all the same.
class DoubleWell final : public PulledPoint {
 public:
  explicit DoubleWell(double sound_to = 10) : sound_to_(sound_to) {}
  std::optional<Breakdown> internal_force(std::span<const double> u, std::span<double> force) override {
    const double x = u[1], pull = u[0] - x;
    force[0] = -pull;
    force[1] = pull - x * (4 * x * x - 12 * x + 8);
    return std::nullopt;
  }
  [[nodiscard]] double strain_energy(std::span<const double> u) override {
    const double x = u[1], pull = u[0] - x;
    return x * x * (x - 2) * (x - 2) + pull * pull / 2;
  }
  void stiffness_bound(std::span<const double>, std::span<double> bound) override {
    bound[0] = 2;
    bound[1] = 30;  // 12 x^2 - 24 x + 8 + 2 stays below for x in [-0.5, 2.6]
  }
  [[nodiscard]] std::optional<Breakdown> inspect(std::span<const double> u) override {
    if (u[1] <= sound_to_) return std::nullopt;
    return Breakdown{{0.25, 0.5, 0}, "unsound"};
  }

 private:
  double sound_to_;
};

struct Remarks : Observer {
  void reached(const State& state, const Constraints&, bool output) override {
    farthest = std::max(farthest, state.u[1]);
    outputs += output ? 1 : 0;
  }
  void remarked(const std::string& remark) override { list.push_back(remark); }
  std::vector<std::string> list;
  double farthest = 0;
  int outputs = 0;
};

State pull_to(double end, Remarks& remarks, double sound_to = 10) {
  DoubleWell model(sound_to);
  Constraints constraints = pull_point();
  return relax(model, constraints, {.targets = {end}, .increment = 0.1, .tolerance = 1e-8}, remarks);
}

TEST(Snapping, IsSilentBeforeTheBodyLosesStability) {
  Remarks remarks;
  const State state = pull_to(2.9, remarks);  // p = 1.9
  EXPECT_LT(state.u[1], 0.5);
  EXPECT_TRUE(remarks.list.empty());
  // Work of a smooth path by parabolas over steps of 0.1: measured 5.5e-5.
  EXPECT_LT(std::abs(state.energy.error()), 3e-4);
}

TEST(Snapping, IsReportedWithTheLostEnergy) {
  Remarks remarks;
  const State state = pull_to(3.2, remarks);  // p = 2.2, beyond the fold at 2
  EXPECT_GT(state.u[1], 1.9);
  ASSERT_EQ(remarks.list.size(), 1U);
  EXPECT_NE(remarks.list[0].find("jumped to another equilibrium"), std::string::npos);
  // The balance keeps the loss: at the fold E = 9/16 + 9/8, in the other well next to nothing (measured
  // -0.989).
  EXPECT_LT(state.energy.error(), -0.8);
}

TEST(Snapping, IntoAnUnsoundStateIsNoSuccess) {
  Remarks remarks;
  try {
    pull_to(3.2, remarks, 1);
    FAIL() << "no failure";
  } catch (const SolverFailure& failure) {
    const std::string what = failure.what();
    EXPECT_NE(what.find("no equilibrium beyond 2.99"), std::string::npos)
        << what;  // the well ends at p - 1 = 3
    EXPECT_NE(what.find("unsound at (0.25, 0.5, 0) m"), std::string::npos) << what;
  }
  EXPECT_LE(remarks.farthest, 1);  // observers have seen sound states only, and not the one asked for
  EXPECT_EQ(remarks.outputs, 0);
}

}  // namespace
}  // namespace riven::testing
