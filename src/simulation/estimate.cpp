#include "simulation/estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>

#include "base/text.hpp"
#include "geometry/mesh.hpp"
#include "solver/velocity_verlet.hpp"

namespace riven {

namespace {

constexpr double kProgram = 16e6;  // bytes of the program itself
constexpr double kNumber = sizeof(double);
// Numbers per point and direction: the vectors of a solver with those of its observers.
constexpr double kSolver = 11;
// Numbers per point: what is copied while an output state is written, and what a body knows of a point.
constexpr double kOutput = 25;

/// What a kind of model takes besides (bytes).
struct Footprint {
  double point = 0;        // per stored point
  double listed_bond = 0;  // per directed bond of a list, body and model together
  double bond = 0;         // per directed bond, listed or not
};

Footprint footprint(const ModelInput& model) {
  if (model.kind == "membrane-bond") return {90, 5};
  if (model.kind == "pmb") return {80, 13};
  if (model.kind == "lps") return {100, 21};
  if (model.kind == "correspondence")
    return model.variant == "bond-associated" ? Footprint{120, 5, 28} : Footprint{300, 13};
  return {250, 6};
}

double points_along(const Shape& shape, double spacing, std::size_t axis) {
  if (const auto* box = std::get_if<Box>(&shape)) return std::ceil(2 * box->half_size[axis] / spacing - 1e-6);
  const double radius =
      std::holds_alternative<Disc>(shape) ? std::get<Disc>(shape).radius : std::get<Ball>(shape).radius;
  return std::ceil(2 * radius / spacing - 1e-6);
}

/// Points of the body's box, or of its file.
double body_points(const GeometryInput& geometry) {
  if (geometry.points) return static_cast<double>(geometry.points->list->position.size());
  double points = 1;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(geometry.dimension); ++axis)
    points *= points_along(geometry.shape, geometry.spacing, axis);
  return points;
}

/// What the sparse tangent of Newton's method, or of implicit steps, takes.
struct Factors {
  double bytes = 0, seconds = 0;
};

/// Powers of the number of points and of how far they couple, in spacings: families couple neighbours of
/// neighbours, springs neighbours. Fitted to what MUMPS foresees for squares of 900 to 40 000 points and
/// cubes of 216 to 5832 points, with horizons of 1.5 to 4 spacings: within a third, on cubes within a factor
/// of two.
Factors factors(const Case& input) {
  const bool complex = input.solver.method == "space-time";  // numbers twice as long, products of four
  if (input.solver.method != "newton" && !input.solver.is_implicit_motion()) return {};
  constexpr double kFlopsPerSecond = 4e10, kEntriesPerSecond = 2e8;  // of one core
  const GeometryInput& geometry = input.geometry;
  const double points = body_points(geometry), horizon = geometry.horizon / geometry.spacing;
  const double reach = (input.model.kind == "pmb" ? 1 : 2) * horizon;
  const bool in_space = geometry.dimension == 3;
  const double bonds = in_space ? 4.2 * std::pow(horizon, 3) : 3.1 * horizon * horizon;
  const double block = geometry.dimension * (input.model.kind == "pmb" ? 2 : 1 + bonds);
  const double blocks = points * (input.model.kind == "pmb" ? 0.5 * bonds : 1);
  const double bytes = in_space ? 12e3 * std::pow(reach, 1.5) * std::pow(points / 1728, 0.4)
                                : 2.1e3 * std::pow(reach, 1.5) * std::pow(points / 1e4, 0.2);
  const double flops = in_space ? 6e8 * std::pow(reach, 2) * std::pow(points / 1728, 2)
                                : 2.2e8 * std::pow(reach, 2.5) * std::pow(points / 1e4, 1.6);
  return {(complex ? 2 : 1) * points * bytes,
          (complex ? 4 : 1) * flops / kFlopsPerSecond + blocks * block * block / kEntriesPerSecond};
}

/// Nodes of a mesh; of a regular one nearly.
double nodes_of(const GeometryInput& geometry) {
  if (geometry.elements->mesh) return static_cast<double>(geometry.elements->mesh->node.size());
  double nodes = geometry.element == "q8" ? 3 : 1;
  for (const int along : geometry.elements->along) nodes *= along + 1;
  return nodes;
}

/// The same of finite elements, by nested dissection: on a grid of n x n nodes 31/4 n^2 log2(n) numbers and
/// 829/84 n^3 products (George 1973), in space of powers 4/3 and 2 of the number of nodes.
Factors element_factors(const Case& input) {
  if (input.solver.method != "newton" && !input.solver.is_implicit_motion()) return {};
  const bool complex = input.solver.method == "space-time";  // numbers twice as long, products of four
  constexpr double kFlopsPerSecond = 4e9, kNodesPerSecond = 2e5;
  const double nodes = nodes_of(input.geometry), d = input.geometry.dimension;
  const double numbers = d == 2 ? 31.0 / 8 * nodes * std::log2(nodes) : 8 * std::pow(nodes, 4.0 / 3);
  const double flops = d == 2 ? 10 * std::pow(nodes, 1.5) : 4 * nodes * nodes;
  return {(complex ? 2 : 1) * kNumber * d * d * numbers,
          (complex ? 4 : 1) * d * d * d * flops / kFlopsPerSecond + nodes / kNodesPerSecond};
}

Factors all_factors(const Case& input) {
  return input.geometry.elements ? element_factors(input) : factors(input);
}

double elements_memory(const Case& input) {
  constexpr double kElement = 1200;  // bytes: slopes, forces, fields of the largest kind
  double elements = 1;
  for (const int along : input.geometry.elements->along) elements *= along;
  if (const auto& mesh = input.geometry.elements->mesh) {
    elements = 0;
    for (const ElementBlock& block : mesh->blocks) elements += static_cast<double>(block.size());
  }
  std::size_t branches = 0;  // of materials that relax, whose points keep three states
  for (const MaterialInput& material : input.materials)
    branches = std::max(branches, material.relaxation.size());
  const std::map<std::string, double> points{{"q4", 4}, {"q8", 9}, {"h8", 8}};
  const auto found = points.find(input.geometry.element);
  const double remembered = branches == 0 ? 0
                                          : 3 * kNumber * (found == points.end() ? 1 : found->second) *
                                                static_cast<double>(13 + 6 * branches);
  const bool sixths = input.geometry.element == "t4" && !input.geometry.elements->mesh;
  return kProgram + nodes_of(input.geometry) * kNumber * (kSolver * input.geometry.dimension + kOutput + 30) +
         elements * (kElement + remembered) * (sixths ? 3 : 1) + element_factors(input).bytes;
}

/// The smallest spacing (m), with horizon in proportion, whose run fits; two digits, rounded up.
double spacing_that_fits(Case input, double available) {
  const double spacing = input.geometry.spacing, horizon = input.geometry.horizon;
  double low = 0, high = 30;  // powers of ten of what the spacing is multiplied with
  while (high - low > 1e-3) {
    const double middle = 0.5 * (low + high), factor = std::pow(10, middle);
    input.geometry.spacing = factor * spacing;
    input.geometry.horizon = factor * horizon;
    (memory_estimate(input) > available ? low : high) = middle;
  }
  const double fits = spacing * std::pow(10, high);
  const double digit = std::pow(10, std::floor(std::log10(fits)) - 1);
  return digit * std::ceil(fits / digit);
}

double output_states(const Simulation& simulation) {
  const SolverInput& solver = simulation.input.solver;
  if (simulation.parameter == Parameter::stretch) return static_cast<double>(solver.stretch.size());
  return 1 + std::ceil(solver.until / simulation.input.output.every.value_or(solver.until) - 1e-9);
}

double load_steps(const SolverInput& solver) {
  double steps = 1, before = 1;  // one small step comes first
  for (const double stretch : solver.stretch) {
    steps += std::ceil(std::abs(stretch - before) / solver.increment - 1e-9);
    before = stretch;
  }
  return steps;
}

double history_rows(const Simulation& simulation) {
  const Case& input = simulation.input;
  if (input.solver.control == "arc-length") return input.solver.max_steps;
  if (simulation.parameter == Parameter::stretch) return load_steps(input.solver);
  const double every = input.output.every.value_or(input.solver.until);
  return 1 + std::ceil(input.solver.until / input.output.history_every.value_or(every) - 1e-9);
}

/// Seconds of a force evaluation: the median, for threads that wait for a busy core now and then say nothing
/// about the run.
double measured_evaluation(Model& model) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kMoment{200};
  constexpr std::size_t kEnough = 15;
  const std::vector<double> rest(model.dofs(), 0.0);
  std::vector<double> force(model.dofs());
  const auto evaluate = [&] { static_cast<void>(model.internal_force(rest, force)); };
  evaluate();  // the first one touches new memory
  std::vector<double> seconds;
  const auto begin = Clock::now();
  do {
    const auto start = Clock::now();
    evaluate();
    seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
  } while (seconds.size() < kEnough && Clock::now() - begin < kMoment);
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  return *middle;
}

/// Whether a load moves one of the two edges across an axis.
bool is_loaded(const Case& input, std::size_t axis) {
  for (const LoadInput& load : input.loads)
    for (const Named& on : load.on)
      if (const auto face = Simulation::face(on.text); face && !load.is_force() && *face / 2 == axis)
        return true;
  return false;
}

}  // namespace

double memory_estimate(const Case& input) {
  if (input.geometry.elements) return elements_memory(input);
  const GeometryInput& geometry = input.geometry;
  const Footprint model = footprint(input.model);
  const double reach = geometry.horizon / geometry.spacing;
  const auto dimension = static_cast<std::size_t>(geometry.dimension);
  double points = 1, offsets = 1;
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    const double along = geometry.points ? std::pow(body_points(geometry), 1.0 / geometry.dimension)
                                         : points_along(geometry.shape, geometry.spacing, axis);
    // Ghost layers lie behind loaded edges; the last axis has room to read beyond the ends.
    points *= along + (axis + 1 == dimension || is_loaded(input, axis) ? 2 * reach : 0);
    offsets *= 2 * reach;
  }
  // The share of the cube of offsets that lies within the horizon: a lattice has a bit for each.
  constexpr std::array<double, 3> kBall = {1, std::numbers::pi / 4, std::numbers::pi / 6};
  const double bonds = kBall[dimension - 1] * offsets;
  const double per_point = kNumber * (kSolver * geometry.dimension + kOutput) + model.point +
                           model.bond * bonds +
                           (geometry.bonds == "listed" ? model.listed_bond * bonds : bonds / 8);
  return kProgram + points * per_point + factors(input).bytes;
}

void check_memory(const Case& input, double available) {
  const double need = memory_estimate(input);
  if (need <= available) return;
  const std::string expected = input.geometry.elements ? "fewer elements"
                               : input.geometry.points ? "fewer points"
                                                       : fmt::format("a larger spacing, {:.2g} m at least",
                                                                     spacing_that_fits(input, available));
  throw InputError(
      input.geometry.at,
      fmt::format("geometry: {:.3g} points need about {} of memory, and {} are available; expected {}",
                  body_points(input.geometry), bytes_text(need), bytes_text(available), expected));
}

double output_estimate(const Simulation& simulation) {
  constexpr double kAsText = 4.0 / 3;  // base64
  constexpr double kCell = 20;         // characters of a number in a history
  constexpr double kEnergies = 6;      // columns of energy.csv
  constexpr double kPosition = 3, kDisplacement = 3;
  const auto& asked = simulation.input.output.fields;
  const auto is_asked = [&](const std::string& field) {
    return std::find(asked.begin(), asked.end(), field) != asked.end();
  };
  double numbers = kPosition + (is_asked("displacement") ? kDisplacement : 0);
  const std::vector<double> rest(simulation.model->dofs(), 0.0);
  for (const ModelField& field : simulation.model->fields(rest))
    if (is_asked(field.name)) numbers += field.components;
  const auto points = static_cast<double>(simulation.model->positions().size());
  return output_states(simulation) * points * numbers * kNumber * kAsText +
         history_rows(simulation) * kCell *
             (1 + 2 * static_cast<double>(simulation.input.probes.size()) + kEnergies);
}

void check_disk(const Simulation& simulation, double available) {
  const double need = output_estimate(simulation);
  if (need <= available) return;
  throw InputError(
      simulation.input.output.at,
      fmt::format("output: {:.6g} states of {} points take up to {} on disk, and {} are free; expected fewer "
                  "states{} or fields",
                  output_states(simulation), simulation.model->points(), bytes_text(need),
                  bytes_text(available),
                  simulation.parameter == Parameter::time ? " (every, history_every)" : ""));
}

TimeEstimate time_estimate(const Simulation& simulation) {
  constexpr double kBesides = 1.15;  // of a step's time over that of its force
  Model& model = *simulation.model;
  TimeEstimate estimate;
  estimate.evaluation_s = kBesides * measured_evaluation(model);
  const SolverInput& solver = simulation.input.solver;
  if (solver.is_implicit_motion()) {
    constexpr double kIterations = 4;         // of a step, with two forces each
    constexpr double kStepsOfAMotion = 1000;  // if none is given
    estimate.unit = "iterations";
    estimate.evaluation_s = all_factors(simulation.input).seconds / kIterations + 2 * estimate.evaluation_s;
    estimate.evaluations =
        kIterations * std::ceil(solver.until / solver.step.value_or(solver.until / kStepsOfAMotion));
  } else if (simulation.parameter == Parameter::time) {
    const std::vector<double> rest(model.dofs(), 0.0);
    const double step =
        solver.safety * stable_step(model, *simulation.constraints, rest, simulation.external);
    estimate.evaluations = std::ceil(solver.until / solver.step.value_or(step));
  } else if (solver.method == "newton") {
    constexpr double kIterations = 3.5;  // of a load step
    estimate.unit = "iterations";
    estimate.evaluation_s = all_factors(simulation.input).seconds + 3 * estimate.evaluation_s;
    estimate.evaluations = kIterations * load_steps(solver);
  } else {
    constexpr double kPerPointAlongSide = 3.5;  // waves must cross the body a few times in each load step
    const auto& faces = simulation.body->faces;
    double side = 0;  // m
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(simulation.body->dimension); ++axis)
      side = std::max(side, faces[2 * axis + 1] - faces[2 * axis]);
    estimate.evaluations = kPerPointAlongSide * side / simulation.body->spacing * load_steps(solver);
  }
  return estimate;
}

}  // namespace riven
