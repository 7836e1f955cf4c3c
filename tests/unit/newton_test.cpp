#include "solver/newton.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>

#include "peridynamics/lps.hpp"
#include "solver/dynamic_relaxation.hpp"
#include "support/bodies.hpp"
#include "support/laws.hpp"
#include "support/loads.hpp"
#include "support/states.hpp"

namespace riven::testing {
namespace {

struct Log : Observer {
  void progressed(const SolverProgress& progress) override {
    if (progress.iteration == 0) residuals.emplace_back();
    residuals.back().push_back(progress.residual);
  }
  void reached(const State& state, const Constraints&, bool) override { steps.push_back(state.parameter); }
  void remarked(const std::string& remark) override { remarks.push_back(remark); }
  std::vector<std::vector<double>> residuals;  // of each load step
  std::vector<double> steps;
  std::vector<std::string> remarks;
};

/// A sheet with a hole and an inclusion.
struct Problem {
  explicit Problem(const LawCase& law = unit_laws()[1], const FaceLoads& loads = planar(),
                   Faces mirrored = all_edges(), double stabilisation = 4)
      : membrane(make_lattice_body(sheet(20, 20, 0.05, mirrored,
                                         {{Disc{{0.2, 0.15, 0}, 0.13}}, {}, {Disc{{-0.2, -0.2, 0}, 0.1}}})),
                 law.material(), stabilisation),
        constraints(constrain(membrane, loads)) {}

  State solve(const LoadStepSettings& settings) { return newton(membrane, constraints, settings, log); }

  Membrane membrane;
  Constraints constraints;
  Log log;
};

double distance(const State2& a, const State2& b) {
  double worst = 0;
  for (std::size_t e = 0; e < a.size(); ++e) worst = std::max(worst, std::abs(a[e] - b[e]));
  return worst;
}

TEST(Newton, ReachesTheStatesOfRelaxation) {
  for (const LawCase& law : unit_laws()) {
    Problem by_newton(law), by_relaxation(law);
    const State state = by_newton.solve({.targets = {1.2, 1.5}});
    const State expected = relax(by_relaxation.membrane, by_relaxation.constraints,
                                 {.targets = {1.2, 1.5}, .tolerance = 1e-8}, by_relaxation.log);
    // Relaxation's tolerance times the softness of the slowest motion.
    EXPECT_LT(distance(state.u, expected.u), 1e-6) << law.name;
    EXPECT_NEAR(state.energy.strain / expected.energy.strain, 1, 1e-9) << law.name;
    EXPECT_TRUE(by_newton.log.remarks.empty()) << law.name;
    EXPECT_LT(state.iterations, expected.iterations / 20);
  }
}

// The ratio of a residual to the square of the one before stays where it is, until rounding.
TEST(Newton, ConvergesQuadratically) {
  Problem problem;
  static_cast<void>(problem.solve({.targets = {1.3}, .increment = 0.3, .tolerance = 1e-12}));
  const std::vector<double>& r = problem.log.residuals.back();
  ASSERT_GE(r.size(), 4U);
  std::vector<double> orders;
  for (std::size_t n = 1; n + 1 < r.size(); ++n)
    if (r[n - 1] < 0.1 && r[n + 1] > 1e-13)
      orders.push_back(std::log(r[n + 1] / r[n]) / std::log(r[n] / r[n - 1]));
  ASSERT_FALSE(orders.empty());
  EXPECT_GT(orders.back(), 1.7);
}

TEST(Newton, StretchesAUniformSheetExactly) {
  const LawCase law = unit_laws()[1];
  Membrane membrane(make_lattice_body(sheet(16, 12, 0.05, all_edges())), law.material(), 4);
  Constraints constraints = constrain(membrane, planar());
  Log log;
  const State state = newton(membrane, constraints, {.targets = {1.7}}, log);
  EXPECT_LT(distance(state.u, affine_state(membrane, Eigen::Matrix2d{{1.7, 0}, {0, 1}})), 1e-12);
}

// Rollers let the sheet slide along its loaded edges; nothing pushes it there, and it must stay.
TEST(Newton, KeepsStillWhatNothingHolds) {
  Membrane membrane(make_lattice_body(sheet(20, 14, 0.05, Faces(0b0011))), unit_laws()[1].material(), 4);
  Constraints constraints = constrain(membrane, uniaxial());
  Log log;
  const State state = newton(membrane, constraints, {.targets = {2}}, log);
  double mean = 0;
  for (const std::size_t i : membrane.body().points) mean += state.u[membrane.body().size() + i];
  mean /= static_cast<double>(membrane.body().points.size());
  // Solutions err by rounding over the shift of the tangent, 1e-16 / 1e-10 of the steps, all of which
  // together are of the size of the stretched sheet, 2 m.
  EXPECT_LT(std::abs(mean), 1e-5);
}

TEST(Newton, CarriesAFreeBlockWithOneEdge) {
  LatticeBodyInput in;
  in.dimension = 3;
  in.shape = Box{{}, {0.3, 0.2, 0.2}};
  in.spacing = 0.1;
  in.horizon = 0.21;
  in.mirrored = Faces(0b000001);
  Lps block(make_lattice_body(in), {.youngs_modulus = 3, .poissons_ratio = 0.3, .density = 1});
  FaceLoads loads;
  loads[0] = FaceLoad{.displacement = {[](const Point&, double p) { return p - 1; }, {}, {}}, .load = 0};
  Constraints constraints = constrain(block, loads);
  Log log;
  const State state = newton(block, constraints, {.targets = {1.05}}, log);
  for (const std::size_t i : block.body().points) EXPECT_NEAR(state.u[i], 0.05, 1e-9);
}

TEST(Newton, TakesSmallerStepsThenRelaxationThenGivesUp) {
  Problem problem(unit_laws()[0], equibiaxial());
  try {
    problem.solve({.targets = {0.9, 0.01}, .tolerance = 1e-3, .max_iterations = 500});
    FAIL() << "no failure";
  } catch (const SolverFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find("no equilibrium beyond"), std::string::npos) << failure.what();
  }
  const auto says = [&](const char* what) {
    return std::any_of(problem.log.remarks.begin(), problem.log.remarks.end(),
                       [&](const std::string& remark) { return remark.find(what) != std::string::npos; });
  };
  EXPECT_TRUE(says("going on with steps of"));
  EXPECT_TRUE(says("going on with dynamic relaxation for this step"));
}

// A state that is no minimum of the energy is no goal: without stabilisation pressed rows of points fold, and
// a solver that only looks for balance would stay on the unstable straight path.
TEST(Newton, LeavesAnUnstablePath) {
  Membrane membrane(make_lattice_body(sheet(20, 20, 0.05, Faces(0b0011))), unit_laws()[0].material(), 0);
  Constraints constraints = constrain(membrane, uniaxial());
  Log log;
  EXPECT_THROW(newton(membrane, constraints, {.targets = {0.8, 0.4}, .max_iterations = 2000}, log),
               SolverFailure);
  EXPECT_GT(log.steps.back(), 0.5);
  EXPECT_LT(log.steps.back(), 0.65);
}

TEST(Newton, LeavesABodyWithoutLoadAtRest) {
  Problem problem(unit_laws()[0],
                  edges([](double) { return Eigen::Matrix2d::Identity(); }, all_edges(), false));
  const State state = problem.solve({.targets = {1.1, 1.3}});
  EXPECT_LE(largest(state.u), 1e-12);
  EXPECT_TRUE(problem.log.remarks.empty());
}

TEST(Newton, HasTheSameBitsOnAnyNumberOfThreads) {
  std::vector<std::vector<double>> results;
  for (const int threads : {1, 2, 3}) {
    omp_set_num_threads(threads);
    Problem problem;
    results.push_back(problem.solve({.targets = {1.3}}).u);
  }
  omp_set_num_threads(1);
  for (const auto& result : results) EXPECT_EQ(result, results.front());
}

}  // namespace
}  // namespace riven::testing
