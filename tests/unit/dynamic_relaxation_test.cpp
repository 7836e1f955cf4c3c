#include "solver/dynamic_relaxation.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/static_sheet.hpp"

namespace riven::testing {
namespace {

constexpr double kStabilisation = 4;  // of StaticSheet too

TEST(DynamicRelaxation, ReachesEquilibriumWithinItsTolerance) {
  for (const LawCase& law : unit_laws()) {
    StaticSheet problem(relax, law);
    const State state = problem.solve({.targets = {1.1, 1.25}, .tolerance = 1e-6});
    EXPECT_EQ(problem.log.outputs, (std::vector<double>{1.1, 1.25})) << law.name;
    problem.constraints.set_parameter(1.25);
    State2 u = state.u;
    problem.constraints.apply(u);
    EXPECT_EQ(u, state.u);  // the state obeys its loads
    State2 force = force_of(problem.membrane, u);
    problem.constraints.reduce(force);
    EXPECT_LE(norm(force), 1e-6 * problem.constraints.reaction_norm());
    EXPECT_GT(problem.constraints.reaction(1)[0], 0);
    EXPECT_NEAR(state.energy.strain, problem.membrane.strain_energy(u), 1e-15);
    // The work is integrated along steps of 0.1 by parabolas; measured 1.4e-3.
    EXPECT_LT(std::abs(state.energy.error()), 3e-3);
  }
}

TEST(DynamicRelaxation, ResultDoesNotDependOnTheIncrement) {
  std::vector<State2> results;
  std::vector<double> forces;
  for (const double increment : {0.1, 0.05}) {
    StaticSheet problem(relax, unit_laws()[1]);
    results.push_back(problem.solve({.targets = {1.4}, .increment = increment, .tolerance = 1e-7}).u);
    forces.push_back(problem.constraints.reaction(1)[0]);
  }
  // The tolerance on the force, 1e-7, times the softness of the slowest motion. Measured: 3e-8 m and 1.4e-7.
  EXPECT_LT(distance(results[0], results[1]), 1e-6);
  EXPECT_NEAR(forces[0] / forces[1], 1, 1e-6);
}

TEST(DynamicRelaxation, CutsStepsThatAreTooLarge) {
  StaticSheet small(relax, unit_laws()[0]), large(relax, unit_laws()[0]);
  const State2 expected = small.solve({.targets = {1.8}, .increment = 0.05, .tolerance = 1e-7}).u;
  // One step of 0.8 from the affine motion about the inclusion folds the sheet or takes too long.
  const State state =
      large.solve({.targets = {1.8}, .increment = 0.8, .tolerance = 1e-7, .max_iterations = 400});
  ASSERT_FALSE(large.log.remarks.empty());
  EXPECT_NE(large.log.remarks[0].find("going on with steps of"), std::string::npos);
  EXPECT_EQ(large.log.steps.back(), 1.8);
  EXPECT_LT(distance(state.u, expected), 1e-6);  // as for two increments; 8e-8 measured
}

TEST(DynamicRelaxation, GivesUpOnAnImpossibleLoad) {
  // The sheet is pressed to nothing: it folds long before.
  StaticSheet problem(relax, unit_laws()[0], equibiaxial());
  try {
    problem.solve({.targets = {0.9, 0.01}, .tolerance = 1e-3, .max_iterations = 500});
    FAIL() << "no failure";
  } catch (const SolverFailure& failure) {
    const std::string what = failure.what();
    EXPECT_NE(what.find("no equilibrium beyond"), std::string::npos) << what;
    EXPECT_NE(what.find("model.stabilisation"), std::string::npos) << what;
    EXPECT_EQ(what.find("solver.increment"), std::string::npos) << what;  // it was halved 256 times
  }
  EXPECT_FALSE(problem.log.remarks.empty());
}

TEST(DynamicRelaxation, StandsStillWhereTheLoadsDo) {
  // A path with a plateau, as tables have them: the guess of a step must not run on while the loads stand
  // still.
  const GradientPath path = [](double l) { return Eigen::Matrix2d{{std::clamp(l, 1.0, 1.3), 0}, {0, 1}}; };
  Membrane membrane(make_lattice_body(sheet(20, 10, 0.05, Faces(0b0011))), unit_laws()[0].material(),
                    kStabilisation);
  Constraints constraints = constrain(membrane, edges(path, Faces(0b0011), true));
  StaticLog log;
  const State state = relax(membrane, constraints, {.targets = {1.3, 1.6}}, log);
  StaticLog again;
  const State to_plateau = relax(membrane, constraints, {.targets = {1.3}}, again);
  EXPECT_TRUE(log.remarks.empty());
  // Each of the three steps of the plateau asks once whether it is in equilibrium.
  EXPECT_LE(state.evaluations, to_plateau.evaluations + 3);
}

TEST(DynamicRelaxation, ReportsAFoldInsteadOfAnEquilibrium) {
  // Pressed along x with free sides and no stabilisation, rows of points begin to fold at a stretch of 0.6.
  // The forces balance then, too.
  Membrane membrane(make_lattice_body(sheet(20, 20, 0.05, Faces(0b0011))), unit_laws()[0].material(), 0);
  Constraints constraints = constrain(membrane, uniaxial());
  StaticLog log;
  EXPECT_THROW(relax(membrane, constraints, {.targets = {0.8, 0.4}, .max_iterations = 2000}, log),
               SolverFailure);
  EXPECT_EQ(log.outputs, (std::vector<double>{0.8}));
  EXPECT_GT(log.steps.back(), 0.55);  // 0.59 to 0.60 measured
  EXPECT_LT(log.steps.back(), 0.65);
  const auto folds = std::count_if(log.remarks.begin(), log.remarks.end(), [](const std::string& remark) {
    return remark.find("folded over itself") != std::string::npos &&
           remark.find(" at (") != std::string::npos;
  });
  EXPECT_GT(folds, 0);
}

TEST(DynamicRelaxation, KeepsAStabilisedSheetFromFoldingUnderCompression) {
  Membrane membrane(make_lattice_body(sheet(20, 20, 0.05, Faces(0b0011))), unit_laws()[0].material(),
                    kStabilisation);
  Constraints constraints = constrain(membrane, uniaxial());
  StaticLog log;
  const State state = relax(membrane, constraints, {.targets = {0.8, 0.4}, .max_iterations = 2000}, log);
  // Every unit square of neighbours keeps its orientation and, in this homogeneous state, its shape.
  const Lattice& lattice = membrane.body().on_lattice()->lattice;
  const auto place = [&](int i, int j) -> Eigen::Vector2d {
    const std::size_t p = lattice.index({i, j, 0});
    return plane(lattice.position(p)) + Eigen::Vector2d(state.u[p], state.u[membrane.body().size() + p]);
  };
  for (int i = 0; i < 19; ++i)
    for (int j = 0; j < 19; ++j) {
      const Eigen::Vector2d x = (place(i + 1, j) - place(i, j)) / 0.05,
                            y = (place(i, j + 1) - place(i, j)) / 0.05;
      EXPECT_NEAR(x.x(), 0.4, 0.02);
      EXPECT_NEAR(y.y(), 1 / std::sqrt(0.4), 0.05);
      EXPECT_GT(x.x() * y.y() - x.y() * y.x(), 0.5);
    }
}

TEST(DynamicRelaxation, StretchesAUniformSheetExactly) {
  // Mirror layers and weights are exact for homogeneous states, so the first residual is the last.
  const LawCase law = unit_laws()[1];
  Membrane membrane(make_lattice_body(sheet(16, 12, 0.05, all_edges())), law.material(), kStabilisation);
  Constraints constraints = constrain(membrane, planar());
  StaticLog log;
  const State state = relax(membrane, constraints, {.targets = {1.7}}, log);
  const State2 exact = affine_state(membrane, Eigen::Matrix2d{{1.7, 0}, {0, 1}});
  EXPECT_LT(distance(state.u, exact), 1e-12);
  EXPECT_EQ(state.evaluations, state.steps);
}

// A body that nothing loads has no reaction to compare with: rest must count as equilibrium all the same.
TEST(DynamicRelaxation, LeavesABodyWithoutLoadAtRest) {
  const FaceLoads still = edges([](double) { return Eigen::Matrix2d::Identity(); }, all_edges(), false);
  StaticSheet problem(relax, unit_laws()[0], still);
  const State state = problem.solve({.targets = {1.1, 1.3}, .max_iterations = 200});
  EXPECT_LE(largest(state.u), 1e-15);
  EXPECT_LE(std::abs(state.energy.error()), 1e-3);
  EXPECT_TRUE(problem.log.remarks.empty());
}

// One edge that moves takes a free sheet with it as a rigid body: again there is no reaction.
TEST(DynamicRelaxation, CarriesAFreeSheetWithOneEdge) {
  FaceLoads loads;
  loads[0] = FaceLoad{.displacement = {[](const Point&, double p) { return p - 1; },
                                       [](const Point&, double) { return 0.0; }},
                      .load = 0};
  StaticSheet problem(relax, unit_laws()[0], loads, Faces(0b0001));
  const State state = problem.solve({.targets = {1.2}});
  // Converged to forces of strains of 1e-11 in each bond, which add up along the sheet as in a
  // cantilever: 1.3e-8 at its end.
  const std::size_t size = problem.membrane.body().size();
  for (const std::size_t i : problem.membrane.body().points) {
    EXPECT_NEAR(state.u[i], 0.2, 1e-7);
    EXPECT_NEAR(state.u[size + i], 0, 1e-7);
  }
}

}  // namespace
}  // namespace riven::testing
