#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/commands.hpp"
#include "input/case_reader.hpp"
#include "input/case_writer.hpp"
#include "input/schema.hpp"
#include "simulation/probes.hpp"
#include "solver/velocity_verlet.hpp"

#include <nlohmann/json.hpp>

namespace riven::app {

namespace {

void print_sets(const Simulation& simulation) {
  const Lattice& lattice = simulation.model->body().lattice;
  for (const PointSet& set : simulation.sets) {
    Point lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};
    for (const std::size_t i : set.points) {
      const Point x = lattice.position(i);
      for (std::size_t a = 0; a < 3; ++a) {
        lower[a] = std::min(lower[a], x[a]);
        upper[a] = std::max(upper[a], x[a]);
      }
    }
    fmt::print("# set {}: {} points, x {:g} to {:g} m, y {:g} to {:g} m\n", set.name, set.points.size(), lower[0], upper[0],
               lower[1], upper[1]);
  }
}

void print_model(Simulation& simulation) {
  Membrane& model = *simulation.model;
  const LatticeBody& body = model.body();
  double volume = 0;
  for (const std::size_t i : body.points) volume += body.volume[i];
  fmt::print("# body: {} points of {} x {} x {} cells, volume {:.6g} m^3, {} ghost points behind loaded edges\n", model.points(),
             body.lattice.cells()[0], body.lattice.cells()[1], body.lattice.cells()[2], volume, body.ghosts.size());
  fmt::print("# bonds: {} directed, {} neighbours within the horizon of {:g} spacings\n", model.bonds(), body.stencil.size(),
             body.horizon / body.lattice.spacing());
  fmt::print("# weights: {} points by least squares, {} by the deformation gradient\n", model.points_by_least_squares(),
             model.points_by_gradient());
  const double mu = shear_modulus(model.material().law);
  fmt::print("# material {}: shear modulus {:.6g} Pa, Young's modulus {:.6g} Pa (incompressible)\n", model.material().name, mu,
             3 * mu);
  print_sets(simulation);
  if (simulation.parameter == Parameter::time) {
    const std::vector<double> rest(model.dofs(), 0.0);
    const double limit = stable_step(model, *simulation.constraints, rest);
    const SolverInput& solver = simulation.input.solver;
    fmt::print("# time: stable step {:.4g} s at rest, {:.0f} steps to the end\n", limit,
               solver.until / solver.step.value_or(solver.safety * limit));
  }
  constexpr double kProgram = 30e6, kStateVectors = 7;  // bytes of the empty program; vectors that solvers keep
  fmt::print("# memory: about {:.0f} MB\n",
             1e-6 * (kProgram + static_cast<double>(model.bytes()) + 8 * kStateVectors * static_cast<double>(model.dofs())));
}

std::vector<std::string> warnings(const Simulation& simulation) {
  std::vector<std::string> list;
  const LatticeBody& body = simulation.model->body();
  const double ratio = body.horizon / body.lattice.spacing();
  if (ratio < 2.9)
    list.push_back(fmt::format("the horizon is {:.3g} spacings: families of so few directions are stiff along the lattice; 3 "
                               "is usual",
                               ratio));
  if (simulation.input.model.stabilisation < 1)
    list.push_back("with a stabilisation below 1 rows of points fold over one another beside defects and under compression");
  if (simulation.input.loads.empty()) list.push_back("there is no load: nothing will move");
  if (simulation.input.probes.empty()) list.push_back("there is no probe: history.csv and the metrics will be empty");
  for (const Shape& inclusion : body.defects.inclusions)
    for (std::size_t axis = 0; axis < 2; ++axis)
      for (const double side : {-1.0, 1.0})
        if (const auto* box = std::get_if<Box>(&body.shape)) {
          Point edge = std::visit([](const auto& shape) { return shape.center; }, inclusion);
          edge[axis] = box->center[axis] + side * box->half_size[axis];
          if (signed_distance(inclusion, edge) < body.horizon)
            list.push_back("an inclusion is nearer than a horizon to an edge: the strip between is too thin for this lattice");
        }
  return list;
}

}  // namespace

int check(const Options& options) {
  const Case input = read_case(find_case(options.target), options.set);
  Simulation simulation = build_simulation(input);
  const Probes probes(simulation);
  fmt::print("{}\n", resolved_case(input));
  print_model(simulation);
  for (const HistoryColumn& column : probes.columns())
    fmt::print("# metric {}{}\n", column.name, column.unit.empty() ? "" : " [" + column.unit + "]");
  for (const std::string& warning : warnings(simulation)) fmt::print("# warning: {}\n", warning);
  return kDone;
}

int schema(bool markdown) {
  if (markdown) {
    fmt::print("{}", reference_page());
  } else {
    fmt::print("{}\n", case_schema().dump(2));
  }
  return kDone;
}

}  // namespace riven::app
