// A run that stops anywhere and goes on from its snapshot in new objects ends with the same bits as one that
// did not stop: for each model and each solver.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>

#include "base/error.hpp"
#include "body/listed_body.hpp"
#include "load/distributed_force.hpp"
#include "peridynamics/bond_membrane.hpp"
#include "peridynamics/correspondence.hpp"
#include "peridynamics/lps.hpp"
#include "peridynamics/pmb.hpp"
#include "solver/arc_length.hpp"
#include "solver/dynamic_relaxation.hpp"
#include "solver/generalised_alpha.hpp"
#include "solver/newton.hpp"
#include "solver/space_time.hpp"
#include "solver/velocity_verlet.hpp"
#include "support/bodies.hpp"
#include "support/laws.hpp"
#include "support/loads.hpp"
#include "support/random.hpp"

namespace riven::testing {
namespace {

struct Problem {
  std::unique_ptr<PointModel> model;
  std::unique_ptr<Constraints> constraints;
};

Body body(bool as_list, Faces mirrored) {
  Body on_lattice = make_lattice_body(
      sheet(14, 12, 0.05, mirrored, {{Disc{{0.15, 0.1, 0}, 0.08}}, {}, {Disc{{-0.15, -0.1, 0}, 0.07}}}));
  return as_list ? listed(on_lattice) : on_lattice;
}

std::unique_ptr<PointModel> membrane(bool as_list, Faces mirrored) {
  return std::make_unique<Membrane>(body(as_list, mirrored), unit_laws()[1].material(), 4);
}

std::unique_ptr<PointModel> bond_membrane(bool as_list, Faces mirrored) {
  return std::make_unique<BondMembrane>(body(as_list, mirrored), unit_laws()[0].material(),
                                        BondMembraneSettings{Loading::planar, true, true});
}

/// Without an inclusion.
Body holed_body(bool as_list, Faces mirrored) {
  const Body on_lattice =
      make_lattice_body(sheet(14, 12, 0.05, mirrored, {{Disc{{0.15, 0.1, 0}, 0.08}}, {}, {}}));
  return as_list ? listed(on_lattice) : on_lattice;
}

/// Bonds break under all loads, in statics until next to nothing holds together.
std::unique_ptr<PointModel> pmb(bool as_list, Faces mirrored) {
  auto model =
      std::make_unique<Pmb>(holed_body(as_list, mirrored), PmbSettings{.youngs_modulus = 6, .density = 1});
  model->set_limits(FailureLimits::uniform(0.02));
  return model;
}

std::unique_ptr<PointModel> lps(bool as_list, Faces mirrored) {
  return std::make_unique<Lps>(holed_body(as_list, mirrored),
                               LpsSettings{.youngs_modulus = 6, .poissons_ratio = 0.4, .density = 1});
}

std::unique_ptr<PointModel> correspondence(bool as_list, Faces mirrored) {
  return std::make_unique<Correspondence>(holed_body(as_list, mirrored),
                                          CorrespondenceSettings{.material = unit_laws()[0].material()});
}

struct ModelCase {
  const char* name;
  std::function<std::unique_ptr<PointModel>(Faces)> make;
};

/// A new model is one more row.
const std::vector<ModelCase>& models() {
  static const std::vector<ModelCase> all = {
      {"Membrane", [](Faces mirrored) { return membrane(false, mirrored); }},
      {"MembraneListed", [](Faces mirrored) { return membrane(true, mirrored); }},
      {"BondMembrane", [](Faces mirrored) { return bond_membrane(false, mirrored); }},
      {"BondMembraneListed", [](Faces mirrored) { return bond_membrane(true, mirrored); }},
      {"Pmb", [](Faces mirrored) { return pmb(false, mirrored); }},
      {"PmbListed", [](Faces mirrored) { return pmb(true, mirrored); }},
      {"Lps", [](Faces mirrored) { return lps(false, mirrored); }},
      {"LpsListed", [](Faces mirrored) { return lps(true, mirrored); }},
      {"Correspondence", [](Faces mirrored) { return correspondence(false, mirrored); }},
      {"CorrespondenceListed", [](Faces mirrored) { return correspondence(true, mirrored); }},
  };
  return all;
}

bool breaks(const PointModel& model) {
  return dynamic_cast<const Pmb*>(&model) != nullptr;
}

/// By an implicit method with a traction besides; by Verlet where a model has no tangent.
template <class Settings>
State implicitly(State (*solve)(Model&, Constraints&, const Settings&, Observer&, const Snapshot*),
                 Settings settings, Problem& p, Observer& observer, const Snapshot* from) {
  if (p.model->tangent_parts() == 0)
    return march(*p.model, *p.constraints, {.until = 0.4, .every = 0.4, .history_every = 0.4}, observer,
                 from);
  const Body& body = p.model->body();
  settings.tolerance = 1e-6;
  settings.external = {std::make_shared<DistributedForce>(
      DistributedForce::Density{[](const Point&, double t) { return 0.001 + 0.1 * t; }},
      edge_shares(body, 1, body.spacing), body.size())};
  return solve(*p.model, *p.constraints, settings, observer, from);
}

struct SolverCase {
  const char* name;
  bool in_time;
  std::function<State(Problem&, Observer&, const Snapshot*)> run;
};

const std::vector<SolverCase>& solvers() {
  static const std::vector<SolverCase> all = {
      {"Relaxation", false,
       [](Problem& p, Observer& observer, const Snapshot* from) {
         return relax(*p.model, *p.constraints, {.targets = {1.1, 1.25}, .tolerance = 1e-4}, observer, from);
       }},
      {"RelaxationWithCuts", false,
       [](Problem& p, Observer& observer, const Snapshot* from) {
         return relax(*p.model, *p.constraints,
                      {.targets = {1.3},
                       .increment = 0.3,
                       .tolerance = 1e-5,
                       .max_iterations = breaks(*p.model) ? 20000 : 130},
                      observer, from);
       }},
      {"Newton", false,
       [](Problem& p, Observer& observer, const Snapshot* from) {
         const auto solve = p.model->tangent_parts() > 0 ? newton : relax;
         return solve(*p.model, *p.constraints,
                      {.targets = {1.1, 1.25}, .increment = 0.03, .tolerance = 1e-4}, observer, from);
       }},
      {"ArcLength", false,
       [](Problem& p, Observer& observer, const Snapshot* from) {
         const LoadStepSettings loads{.targets = {1.1, 1.25}, .increment = 0.03, .tolerance = 1e-6};
         if (p.model->tangent_parts() > 0 && !breaks(*p.model))
           return follow_path(*p.model, *p.constraints, {loads}, observer, from);
         return relax(*p.model, *p.constraints, loads, observer, from);
       }},
      {"Verlet", true,
       [](Problem& p, Observer& observer, const Snapshot* from) {
         return march(*p.model, *p.constraints, {.until = 1.3, .every = 0.5, .history_every = 0.17}, observer,
                      from);
       }},
      {"VerletWithGivenStep", true,
       [](Problem& p, Observer& observer, const Snapshot* from) {
         VelocityVerletSettings settings{.until = 0.4, .every = 0.2, .history_every = 0.03, .step = 0.0021};
         settings.initial_v.assign(p.model->dofs(), 0.1);
         return march(*p.model, *p.constraints, settings, observer, from);
       }},
      {"SpaceTime", true,
       [](Problem& p, Observer& observer, const Snapshot* from) {
         SpaceTimeSettings settings;  // the step follows the motion
         settings.until = 1.3;
         settings.every = 0.5;
         settings.history_every = 0.17;
         return implicitly(march_slabs, settings, p, observer, from);
       }},
      {"SpaceTimeSingleField", true,
       [](Problem& p, Observer& observer, const Snapshot* from) {
         SpaceTimeSettings settings;
         settings.until = 1.2;
         settings.every = 0.5;
         settings.history_every = 0.17;
         settings.step = 0.04;
         settings.scheme = SlabKind::single_field;
         settings.gauss_points = 2;
         return implicitly(march_slabs, settings, p, observer, from);
       }},
      {"GeneralisedAlpha", true,
       [](Problem& p, Observer& observer, const Snapshot* from) {
         GeneralisedAlphaSettings settings;
         settings.until = 1.2;
         settings.every = 0.5;
         settings.history_every = 0.17;
         settings.step = 0.04;
         return implicitly(generalised_alpha, settings, p, observer, from);
       }},
      {"VerletDampedWithVelocityAndTraction", true,
       [](Problem& p, Observer& observer, const Snapshot* from) {
         const Body& body = p.model->body();
         for (const std::size_t i : body.points)
           if (body.position(i)[0] < -0.3)
             p.constraints->add({.slave = body.size() + i,
                                 .terms = {{[](const Point& x, double t) { return 0.1 * std::sin(t + x[1]); },
                                            body.position(i), 1, 1, 1, true}}});
         VelocityVerletSettings settings{.until = 1.3, .every = 0.5, .history_every = 0.17};
         settings.damping = 0.7;
         const auto traction = [](const Point&, double t) { return 0.001 + 0.1 * t; };
         settings.external = {std::make_shared<DistributedForce>(
             DistributedForce::Density{traction}, edge_shares(body, 1, body.spacing), body.size())};
         return march(*p.model, *p.constraints, settings, observer, from);
       }},
  };
  return all;
}

/// Statics pull at mirrored edges; in time a column of points is pushed.
Problem make_problem(const ModelCase& model, bool in_time) {
  Problem problem{model.make(in_time ? Faces() : all_edges()), nullptr};
  if (!in_time) {
    problem.constraints = std::make_unique<Constraints>(constrain(*problem.model, planar()));
    return problem;
  }
  const Body& body = problem.model->body();
  problem.constraints = std::make_unique<Constraints>(problem.model->dofs(), 7);
  const LoadFunction push = [](const Point&, double t) { return 0.1 * t * t; };
  for (const std::size_t i : body.points)
    if (body.position(i)[0] < -0.3)
      problem.constraints->add({.slave = i, .terms = {{push, body.position(i), 0, 1, 1}}});
  return problem;
}

struct Stopped {};

/// Keeps all that an observer is told, and stops the run at a safe point.
struct Watch : Observer {
  void reached(const State& state, const Constraints& constraints, bool output) override {
    told.push_back(state.parameter);
    told.push_back(output ? 1 : 0);
    told.insert(told.end(), state.u.begin(), state.u.end());
    for (const double value :
         {state.energy.kinetic, state.energy.strain, state.energy.external_work, state.energy.largest,
          state.energy.dissipated, constraints.reaction(1)[0], constraints.reaction_norm()})
      told.push_back(value);
  }
  void remarked(const std::string& remark) override { remarks.push_back(remark); }
  void safe_point(const std::function<Snapshot()>& take) override {
    if (points++ != stop_at) return;
    snapshot = take();
    throw Stopped();
  }
  long stop_at = -1, points = 0;
  std::vector<double> told;
  std::vector<std::string> remarks;
  Snapshot snapshot;
};

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

class Resuming : public ::testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {};

TEST_P(Resuming, ChangesNoBit) {
  const ModelCase& model = models()[std::get<0>(GetParam())];
  const SolverCase& solver = solvers()[std::get<1>(GetParam())];
  Problem problem = make_problem(model, solver.in_time);
  Watch whole;
  const State expected = solver.run(problem, whole, nullptr);
  ASSERT_GT(whole.points, 20);
  // The bond-based models need fewer iterations, and no cuts.
  if (!breaks(*problem.model)) {
    EXPECT_EQ(
        std::string(solver.name) == "RelaxationWithCuts" && std::string(model.name).starts_with("Membrane"),
        !whole.remarks.empty());
  }
  // Where bonds can break, some do.
  EXPECT_EQ(breaks(*problem.model), expected.energy.dissipated > 0);
  Random random(11);
  for (int trial = 0; trial < 3; ++trial) {
    // Stops a few times on its way, first anywhere, then after few or many more safe points.
    Watch parts;
    std::optional<Snapshot> from;
    State state;
    for (long stop = random.integer(0, static_cast<int>(whole.points) - 1);; stop += random.integer(1, 200)) {
      parts.stop_at = stop;
      Problem fresh = make_problem(model, solver.in_time);
      try {
        state = solver.run(fresh, parts, from ? &*from : nullptr);
        break;
      } catch (const Stopped&) {
        from = parts.snapshot;
      }
    }
    EXPECT_EQ(parts.points, whole.points);
    EXPECT_TRUE(same_bits(state.u, expected.u));
    EXPECT_TRUE(same_bits(state.v, expected.v));
    EXPECT_TRUE(same_bits(parts.told, whole.told));
    EXPECT_EQ(parts.remarks, whole.remarks);
    EXPECT_EQ(state.evaluations, expected.evaluations);
    EXPECT_EQ(state.steps, expected.steps);
  }
}

INSTANTIATE_TEST_SUITE_P(EveryModelAndSolver, Resuming,
                         ::testing::Combine(::testing::Range(std::size_t{0}, models().size()),
                                            ::testing::Range(std::size_t{0}, solvers().size())),
                         [](const auto& row) {
                           return std::string(models()[std::get<0>(row.param)].name) +
                                  solvers()[std::get<1>(row.param)].name;
                         });

TEST(ResumingElsewhere, RefusesASnapshotOfAnotherBody) {
  Problem problem = make_problem(models()[0], true);
  Watch watch;
  watch.stop_at = 3;
  EXPECT_THROW(solvers()[2].run(problem, watch, nullptr), Stopped);
  Problem other{
      std::make_unique<Membrane>(make_lattice_body(sheet(10, 10, 0.05)), unit_laws()[0].material(), 4),
      nullptr};
  other.constraints = std::make_unique<Constraints>(other.model->dofs(), 7);
  EXPECT_THROW(solvers()[2].run(other, watch, &watch.snapshot), InputError);
}

}  // namespace
}  // namespace riven::testing
