// Every solver brings every model that it takes to the same state: a sheet with a hole and a slit, pulled by
// its ends. Solvers of motion get there by a pull so slow and smooth that nothing rings afterwards.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "fem/finite_elements.hpp"
#include "peridynamics/bond_membrane.hpp"
#include "peridynamics/correspondence.hpp"
#include "peridynamics/lps.hpp"
#include "peridynamics/pmb.hpp"
#include "solver/dynamic_relaxation.hpp"
#include "solver/newton.hpp"
#include "solver/space_time.hpp"
#include "solver/velocity_verlet.hpp"
#include "support/bodies.hpp"
#include "support/differences.hpp"
#include "support/laws.hpp"
#include "support/loads.hpp"

namespace riven::testing {
namespace {

/// Left and right edges on rollers, so that the other two are free.
Body body() {
  LatticeBodyInput in = sheet(20, 16, 0.05, Faces(0b0011), {{Disc{{0.13, 0.08, 0}, 0.1}}, {}, {}});
  in.defects.cracks.push_back({{-0.26, -0.2, 0}, {-0.26, 0.02, 0}});
  return make_lattice_body(in);
}

struct ModelCase {
  const char* name;
  double stretch;  // at the end
  std::function<std::unique_ptr<Model>()> make;
};

// With waves of about 2 m/s a pull of 400 s lasts 100 periods of the slowest mode, 4 s. The pull of degree
// five leaves (period / (2 pi 400 s))^3 of it, 1e-8; Verlet's own part is of the square of the step, and
// statics' that of its tolerance, 1e-8.
constexpr double kPull = 400;  // s

const std::vector<ModelCase>& models() {
  static const std::vector<ModelCase> all = {
      {"Membrane", 1.2, [] { return std::make_unique<Membrane>(body(), unit_laws()[1].material(), 4); }},
      {"BondMembrane", 1.2,
       [] {
         return std::make_unique<BondMembrane>(body(), unit_laws()[0].material(),
                                               BondMembraneSettings{Loading::uniaxial, true, false});
       }},
      {"Pmb", 1.001,
       [] { return std::make_unique<Pmb>(body(), PmbSettings{.youngs_modulus = 3, .density = 1}); }},
      {"Lps", 1.001,
       [] {
         return std::make_unique<Lps>(body(),
                                      LpsSettings{.youngs_modulus = 3, .poissons_ratio = 0.4, .density = 1});
       }},
      {"Correspondence", 1.2,
       [] {
         return std::make_unique<Correspondence>(
             body(), CorrespondenceSettings{.material = unit_laws()[1].material()});
       }},
      {"BondAssociated", 1.2,
       [] {
         return std::make_unique<Correspondence>(
             body(), CorrespondenceSettings{.material = unit_laws()[1].material(),
                                            .stabilisation = Stabilisation::bond_associated});
       }},
      {"FiniteElements", 1.2,
       [] {
         return std::make_unique<FiniteElements>(
             make_mesh(
                 ElementShape::q4, {12, 8}, 1,
                 quadrilateral_map({Point{-0.5, -0.4, 0}, {0.5, -0.2, 0}, {0.5, 0.3, 0}, {-0.5, 0.4, 0}})),
             FiniteElementsSettings{.materials = {unit_laws()[1].compressible()}, .plane = Plane::strain});
       }},
  };
  return all;
}

/// Nodes of the left and the right edge on rollers, one of them held.
Constraints pull_nodes(const FiniteElements& model, const std::function<double(double)>& stretch) {
  Constraints constraints(model.dofs(), 1);
  for (const std::size_t face : {0U, 1U})
    for (const std::uint32_t node : model.mesh().nodes_on(face))
      constraints.add(
          {.slave = node,
           .terms = {{[stretch](const Point& x, double parameter) { return (stretch(parameter) - 1) * x[0]; },
                      model.mesh().node[node]}}});
  constraints.add({.slave = model.points(), .terms = {}});
  return constraints;
}

/// The edges' loads, where the stretch is a function of the solver's parameter.
Constraints pull(const Model& any, const std::function<double(double)>& stretch) {
  if (const auto* elements = dynamic_cast<const FiniteElements*>(&any)) return pull_nodes(*elements, stretch);
  const auto& model = dynamic_cast<const PointModel&>(any);
  const auto path = [stretch](double parameter) { return Eigen::Matrix2d{{stretch(parameter), 0}, {0, 1}}; };
  Constraints constraints = constrain(model, edges(path, Faces(0b0011), true));
  // Rollers let the sheet slide along them: one point is held.
  const Body& body = model.body();
  constraints.add({.slave = body.size() + body.points.front(), .terms = {}});
  return constraints;
}

struct SolverCase {
  const char* name;
  std::function<bool(const Model&)> takes;
  std::function<std::vector<double>(Model&, double stretch)> solve;
};

const std::vector<SolverCase>& solvers() {
  static const std::vector<SolverCase> all = {
      {"DynamicRelaxation", [](const Model&) { return true; },
       [](Model& model, double stretch) {
         Constraints loads = pull(model, [](double parameter) { return parameter; });
         Observer nobody;
         return relax(model, loads, {.targets = {stretch}, .tolerance = 1e-8}, nobody).u;
       }},
      {"Newton", [](const Model& model) { return model.tangent_parts() > 0; },
       [](Model& model, double stretch) {
         Constraints loads = pull(model, [](double parameter) { return parameter; });
         Observer nobody;
         return newton(model, loads, {.targets = {stretch}, .tolerance = 1e-8}, nobody).u;
       }},
      {"Verlet", [](const Model& model) { return model.conservative(); },
       [](Model& model, double stretch) {
         Constraints loads = pull(model, [stretch](double t) {
           const double x = std::min(t / kPull, 1.0);
           return 1 + (stretch - 1) * x * x * x * (10 - 15 * x + 6 * x * x);
         });
         Observer nobody;
         return march(model, loads, {.until = kPull, .every = kPull, .history_every = kPull}, nobody).u;
       }},
      {"SpaceTime", [](const Model& model) { return model.tangent_parts() > 0; },
       [](Model& model, double stretch) {
         Constraints loads = pull(model, [stretch](double t) {
           const double x = std::min(t / kPull, 1.0);
           return 1 + (stretch - 1) * x * x * x * (10 - 15 * x + 6 * x * x);
         });
         Observer nobody;
         SpaceTimeSettings settings;  // slabs of two and a half periods of the slowest mode
         settings.until = settings.every = settings.history_every = kPull;
         settings.step = 10;
         return march_slabs(model, loads, settings, nobody).u;
       }},
  };
  return all;
}

/// Displacements of the body's points, component by component.
std::vector<double> of_points(const Model& model, const std::vector<double>& u) {
  std::vector<double> values;
  for (const Point& d : model.displacements(u)) values.insert(values.end(), d.begin(), d.begin() + 2);
  return values;
}

class EverySolver : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EverySolver, BringsTheModelToTheSameState) {
  const ModelCase& row = models()[GetParam()];
  std::vector<double> expected;
  for (const SolverCase& solver : solvers()) {
    const auto model = row.make();
    if (!solver.takes(*model)) continue;
    const std::vector<double> reached = of_points(*model, solver.solve(*model, row.stretch));
    if (expected.empty()) expected = reached;
    // Measured: 1.9e-7 (membrane), 4.7e-7 (PMB).
    EXPECT_LT(relative_difference(reached, expected), 2e-6) << solver.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Models, EverySolver, ::testing::Range(std::size_t{0}, models().size()),
                         [](const auto& row) { return std::string(models()[row.param].name); });

}  // namespace
}  // namespace riven::testing
