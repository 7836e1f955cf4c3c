#include "simulation/preflight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "base/nearest_name.hpp"
#include "geometry/mesh_faults.hpp"
#include "material/linear_elastic.hpp"
#include "simulation/free_motions.hpp"
#include "simulation/materials.hpp"
#include "solver/velocity_verlet.hpp"
#include "verification/reference_points.hpp"

namespace riven {

namespace {

double last_state(const Case& input) {
  return input.solver.in_time() ? input.solver.until : input.solver.stretch.back();
}

std::string states_text(const Case& input) {
  if (input.solver.in_time()) {
    const double every = input.output.every.value_or(input.solver.until);
    return fmt::format("0 and every {:g} s to {:g} s", every, input.solver.until);
  }
  std::string text;
  for (const double stretch : input.solver.stretch)
    text += fmt::format("{}{:g}", text.empty() ? "" : ", ", stretch);
  return text;
}

/// Whether the run goes past a state, so that an expectation there was meant to be met.
bool passes(const Case& input, double state) {
  const double start = input.solver.in_time() ? 0 : 1, end = last_state(input);
  return (state - start) * (end - state) >= 0 && state != start;
}

std::filesystem::path reference_file(const Case& input, const ExpectInput& expect) {
  return input.file.parent_path() / expect.file;
}

/// The states of a reference file that an expectation is about.
std::vector<double> wanted_states(const Case& input, const ExpectInput& expect) {
  std::vector<double> states;
  try {
    for (const ReferenceState& state : read_reference_points(reference_file(input, expect)).states)
      if (!expect.state || (state.value && same_state(*state.value, *expect.state)))
        states.push_back(state.value.value_or(last_state(input)));
  } catch (const InputError& error) {
    throw InputError(expect.at, fmt::format("expect: {}", error.what()));
  }
  return states;
}

[[noreturn]] void fail_state(const Case& input, const ExpectInput& expect, double state) {
  throw InputError(expect.at, fmt::format("expect: the run has no output state at {:g}; its states are {}",
                                          state, states_text(input)));
}

void check_field(const Case& input, const ExpectInput& expect) {
  const auto& fields = input.output.fields;
  if (std::find(fields.begin(), fields.end(), expect.field) == fields.end())
    throw InputError(
        expect.at,
        fmt::format("expect: the field {} is not written; expected it in fields of [output]", expect.field));
  const std::vector<double> wanted = wanted_states(input, expect);
  const auto here =
      std::find_if(wanted.begin(), wanted.end(), [&](double state) { return reaches(input, state); });
  if (here == wanted.end())
    throw InputError(expect.at,
                     fmt::format("expect: {} has none of the run's output states {}", expect.file,
                                 expect.state ? fmt::format("at {:g}", *expect.state) : states_text(input)));
  for (const double state : wanted)
    if (passes(input, state) && !reaches(input, state)) fail_state(input, expect, state);
}

void check_metric(const ExpectInput& expect, const std::vector<HistoryColumn>& columns) {
  const auto column = std::find_if(columns.begin(), columns.end(),
                                   [&](const HistoryColumn& c) { return c.name == expect.metric; });
  if (column == columns.end()) {
    std::vector<std::string> names;
    for (const HistoryColumn& c : columns) names.push_back(c.name);
    throw InputError(expect.at,
                     fmt::format("expect: the case has no metric \"{}\"; its probes give {}{}", expect.metric,
                                 names.empty() ? "none" : listed(names), did_you_mean(expect.metric, names)));
  }
  static_cast<void>(in_unit_of_metric(expect, column->unit));
}

void check_step(const Simulation& simulation) {
  constexpr double kMostSteps = 1e9;
  const SolverInput& solver = simulation.input.solver;
  if (!solver.is_explicit()) return;
  std::vector<double> start = simulation.initial_u;
  start.resize(simulation.model->dofs());
  simulation.constraints->set_parameter(0);
  simulation.constraints->apply(start);
  const double limit = stable_step(*simulation.model, *simulation.constraints, start, simulation.external);
  if (!solver.step && solver.until > kMostSteps * solver.safety * limit)
    throw InputError(
        solver.until_at,
        fmt::format("solver.until: {:g} s take {:.3g} time steps of {:.4g} s; expected {:g} at most",
                    solver.until, solver.until / (solver.safety * limit), solver.safety * limit, kMostSteps));
  if (solver.step && *solver.step > limit)
    throw InputError(
        solver.at, fmt::format("solver.step: {:.4g} s is above the stable step, {:.4g} s; expected less, or "
                               "no step to have it chosen",
                               *solver.step, limit));
}

void check_solver(const Simulation& simulation) {
  const Case& input = simulation.input;
  const SolverInput& solver = input.solver;
  if (solver.control == "arc-length" && !input.interfaces.empty())
    throw InputError(
        input.interfaces.front().at,
        "interface: its bonds break, and a path of equilibria that can be followed to and fro has "
        "none that do; expected none, or solver.control = \"load\"");
  if (!solver.inertia && simulation.mesh == nullptr)
    throw InputError(solver.at,
                     fmt::format("solver.inertia: the model \"{}\" remembers nothing that would take "
                                 "time without it; expected true, or method = \"newton\"",
                                 input.model.kind));
  if (solver.is_implicit_motion() && solver.start == "equilibrium" && !input.initials.empty())
    throw InputError(
        input.initials.front().at,
        "initial: the run starts in the equilibrium under the loads of time 0, whatever the body's "
        "state before; expected none, or solver.start = \"initial\" (with inertia)");
  if (solver.control == "arc-length")
    for (const MaterialInput& material : input.materials)
      if (material.breaks())
        throw InputError(solver.at, fmt::format("solver.control: bonds of material.{} break, and a path of "
                                                "equilibria that can be followed to and fro has none that "
                                                "do; expected \"load\"",
                                                material.name));
  const bool needs_tangent = solver.method == "newton" || solver.is_implicit_motion();
  if (!needs_tangent || simulation.model->tangent_parts() > 0) return;
  throw InputError(solver.at,
                   fmt::format("solver.method: the model \"{}\" has no tangent for \"{}\"; expected "
                               "\"dynamic-relaxation\" or \"verlet\"",
                               input.model.kind, solver.method));
}

/// Elements that nothing holds move at once, or nowhere: statics has no answer.
void check_supports(const Simulation& simulation) {
  const SolverInput& solver = simulation.input.solver;
  if (simulation.mesh == nullptr || (solver.in_time() && solver.inertia)) return;
  if (const auto motion = free_motion(simulation))
    throw InputError(
        simulation.input.solver.at,
        fmt::format("solver.method: the loads leave the body free to move as a whole, by {}; expected "
                    "displacements that hold it, or {}",
                    *motion, solver.in_time() ? "inertia = true" : "method = \"verlet\""));
}

/// Every field asked for must be one that the model has.
void check_fields(const Simulation& simulation) {
  const std::vector<double> rest(simulation.model->dofs(), 0.0);
  std::vector<std::string> names = {"displacement"};
  if (simulation.mesh == nullptr) names.emplace_back("fragment");
  for (const ModelField& field : simulation.model->fields(rest)) names.push_back(field.name);
  const OutputInput& output = simulation.input.output;
  for (const std::string& field : output.fields)
    if (std::find(names.begin(), names.end(), field) == names.end())
      throw InputError(output.at,
                       fmt::format("output.fields: the model \"{}\" has no field \"{}\"; it has {}",
                                   simulation.input.model.kind, field, listed(names)));
}

/// Stretches or times at which the solver may ask for the loads, close enough for what tables may have.
std::vector<double> marched(const Simulation& simulation) {
  const SolverInput& solver = simulation.input.solver;
  std::vector<double> values;
  const auto add = [&values](double from, double to, int parts) {
    for (int n = 1; n <= parts; ++n) values.push_back(n == parts ? to : from + (to - from) * n / parts);
  };
  if (simulation.parameter == Parameter::time) {
    // As many as a fraction of a second has time for.
    const auto terms =
        static_cast<int>(std::min<std::size_t>(simulation.constraints->offsets().size(), 20000));
    values.push_back(0);
    add(0, solver.until, std::clamp(2000000 / (terms + 1), 100, 10000));
    return values;
  }
  constexpr int kHalves = 8;  // of increments, which the solver cuts
  values.push_back(1);
  for (const double stretch : solver.stretch) {
    const double before = values.back();
    add(before, stretch,
        kHalves * static_cast<int>(std::ceil(std::abs(stretch - before) / solver.increment - 1e-9)));
  }
  return values;
}

/// A table that ends before the run does, or a field without a row at a point, must be told before it.
/// Evaluating a load there says what is wrong.
void check_data(const Simulation& simulation) {
  const auto& loads = simulation.input.loads;
  const auto first_that = [&loads](bool (Expression::*does)() const) {
    return std::find_if(loads.begin(), loads.end(), [does](const LoadInput& load) {
      if (load.pressure) return ((*load.pressure).*does)();
      return std::any_of(load.components().begin(), load.components().end(),
                         [does](const ComponentInput& c) { return c.value && ((*c.value).*does)(); });
    });
  };
  const auto calls = first_that(&Expression::calls_tables), reads = first_that(&Expression::reads_fields);
  const auto first = std::min(calls, reads);
  if (first == loads.end()) return;
  std::vector<double> values = marched(simulation);
  if (calls == loads.end()) values.resize(1);
  const std::vector<double> rest(simulation.model->dofs(), 0.0);
  for (const double value : values) {
    simulation.constraints->set_parameter(value);
    const auto offsets = simulation.constraints->offsets();
    const auto finite = [](double x) { return std::isfinite(x); };
    bool all = std::all_of(offsets.begin(), offsets.end(), finite);
    for (const AppliedForce& applied : simulation.applied) {
      const Point total = applied.total(rest, value);
      all = all && std::all_of(total.begin(), total.end(), finite);
    }
    if (!all)
      throw InputError(first->at, fmt::format("load: its value is no finite number at {} {:g}",
                                              name(simulation.parameter), value));
  }
}

/// Whether the loads displace the body before they have begun.
bool jumps_at_start(const Simulation& simulation) {
  std::vector<double> u(simulation.model->dofs(), 0.0);
  simulation.constraints->set_parameter(simulation.parameter == Parameter::time ? 0 : 1);
  simulation.constraints->apply(u);
  const double noticeable = 1e-6 * simulation.body->spacing;
  return std::any_of(u.begin(), u.end(), [&](double value) { return !(std::abs(value) <= noticeable); });
}

/// Volume (m^3) of the body without its holes, to a few thousandths: by a grid of samples.
double volume_without_holes(const GeometryInput& geometry, const std::vector<Shape>& holes) {
  const auto& box = std::get<Box>(geometry.shape);
  const auto dimension = static_cast<std::size_t>(geometry.dimension);
  const int side = dimension == 2 ? 400 : 60;
  const auto along = [&](std::size_t axis, int n) {
    return axis < dimension ? box.center[axis] + box.half_size[axis] * ((2 * n + 1.0) / side - 1) : 0.0;
  };
  long all = 0, left = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < (dimension == 2 ? 1 : side); ++k) {
        const Point x{along(0, i), along(1, j), along(2, k)};
        ++all;
        left += std::none_of(holes.begin(), holes.end(),
                             [&](const Shape& hole) { return signed_distance(hole, x) < 0; });
      }
  double volume = geometry.thickness * static_cast<double>(left) / static_cast<double>(all);
  for (std::size_t axis = 0; axis < dimension; ++axis) volume *= 2 * box.half_size[axis];
  return volume;
}

/// Volumes in the file that do not fill the box it claims.
void warn_of_volumes(const Simulation& simulation, std::vector<std::string>& list) {
  constexpr double kNoticeable = 0.03;
  const GeometryInput& geometry = simulation.input.geometry;
  if (!geometry.points->has_edges()) return;
  const Body& body = *simulation.body;
  double sum = 0;
  for (std::size_t n = 0; n < geometry.points->list->volume.size(); ++n)
    if (body.kind[n] != PointKind::outside) sum += geometry.points->list->volume[n];
  const double whole = volume_without_holes(geometry, body.defects.holes);
  if (std::abs(sum - whole) > kNoticeable * whole)
    list.push_back(
        fmt::format("the volumes of the points sum to {:.4g} m^3, {:.2g} % {} than the box without its holes "
                    "({:.4g} m^3); forces are off by as much",
                    sum, 100 * std::abs(sum / whole - 1), sum > whole ? "more" : "less", whole));
}

/// Bonds of a point in the mean, and what the horizon in spacings makes expect. Far apart where the volumes,
/// from which dx comes, are in another unit than the places.
struct Families {
  double mean = 0, expected = 0;
};

Families families(const Simulation& simulation) {
  const Body& body = *simulation.body;
  const double ratio = body.horizon / body.spacing;
  const double expected = body.dimension == 1   ? 2 * ratio
                          : body.dimension == 2 ? std::numbers::pi * ratio * ratio
                                                : 4.0 / 3 * std::numbers::pi * ratio * ratio * ratio;
  return {static_cast<double>(simulation.model->bonds()) / static_cast<double>(simulation.model->points()),
          expected};
}

std::string families_text(const Simulation& simulation) {
  const auto [mean, expected] = families(simulation);
  const Body& body = *simulation.body;
  return fmt::format(
      "a point has {:.3g} bonds in the mean, and {:.3g} would be usual for a horizon of {:.3g} "
      "spacings: dx = {:.4g} m, which the volumes give, does not fit the distances of the points",
      mean, expected, body.horizon / body.spacing, body.spacing);
}

void warn_of_families(const Simulation& simulation, std::vector<std::string>& list) {
  const auto [mean, expected] = families(simulation);
  if (mean < 0.5 * expected || mean > 2 * expected) list.push_back(families_text(simulation));
}

/// With hardly a bond there is no body.
void check_families(const Simulation& simulation) {
  const auto [mean, expected] = families(simulation);
  if (simulation.input.geometry.points && mean < 0.05 * expected)
    throw InputError(simulation.input.geometry.at, fmt::format("geometry: {}; {}", families_text(simulation),
                                                               simulation.input.geometry.points->is_mesh()
                                                                   ? "expected elements of about one size"
                                                                   : "is the unit of the volumes right?"));
}

/// Points that nothing holds.
void warn_of_lonely_points(const Simulation& simulation, std::vector<std::string>& list) {
  const Body& body = *simulation.body;
  std::vector<std::size_t> lonely;
  std::copy_if(body.points.begin(), body.points.end(), std::back_inserter(lonely),
               [&](std::size_t n) { return body.family_size(n) == 0; });
  if (lonely.empty()) return;
  const std::string others =
      lonely.size() == 1 ? " has" : fmt::format(" and {} more have", lonely.size() - 1);
  list.push_back(
      fmt::format("the point in {}{} no bond: no other point within the horizon of {:.4g} m, or "
                  "defects between",
                  simulation.input.geometry.points->list->at(lonely.front()).text(), others, body.horizon));
}

}  // namespace

bool same_state(double a, double b) {
  return std::abs(a - b) <= 1e-6 * std::max(std::abs(a), std::abs(b));
}

bool reaches(const Case& input, double state) {
  const SolverInput& solver = input.solver;
  if (!solver.in_time())
    return std::any_of(solver.stretch.begin(), solver.stretch.end(),
                       [&](double s) { return same_state(s, state); });
  const double every = input.output.every.value_or(solver.until), count = std::round(state / every);
  const bool on_schedule =
      count >= 0 && state <= solver.until * (1 + 1e-6) && same_state(state, count * every);
  return on_schedule || same_state(state, solver.until);
}

std::size_t drop_unreached_expectations(Case& input) {
  std::vector<ExpectInput> kept;
  std::size_t dropped = 0;
  for (const ExpectInput& expect : input.expects) {
    std::vector<double> wanted;  // no state: the last one, which every run reaches
    if (!expect.field.empty()) wanted = wanted_states(input, expect);
    if (expect.field.empty() && expect.state) wanted = {*expect.state};
    const auto reached = [&](double state) { return reaches(input, state); };
    if (std::all_of(wanted.begin(), wanted.end(), reached)) {
      kept.push_back(expect);
      continue;
    }
    // Of a field that is expected at many states, those that are reached.
    for (const double state : wanted) {
      if (reached(state)) {
        kept.push_back(expect);
        kept.back().state = state;
      } else {
        ++dropped;
      }
    }
  }
  input.expects = std::move(kept);
  return dropped;
}

std::string left_out(std::size_t expectations) {
  return expectations == 1
             ? std::string("1 expectation is at a state that this run does not reach; it is left out")
             : fmt::format("{} expectations are at states that this run does not reach; they are left out",
                           expectations);
}

ExpectInput in_unit_of_metric(ExpectInput expect, const std::string& metric_unit) {
  const bool angle = metric_unit == "deg";  // a case has angles in radians, as plain numbers
  const std::string unit = metric_unit.empty() || angle ? "1" : metric_unit;
  for (auto* quantity : {&expect.value, &expect.absolute_tolerance, &expect.min, &expect.max}) {
    if (!*quantity) continue;
    if ((*quantity)->dimension != unit)
      throw InputError(expect.at,
                       fmt::format("expect: \"{}\" is in {}; found a value in {}", expect.metric,
                                   unit == "1" ? "no unit" : unit,
                                   (*quantity)->dimension == "1" ? "no unit" : (*quantity)->dimension));
    if (angle) (*quantity)->si *= 180 / std::numbers::pi;
  }
  return expect;
}

void check_before_run(const Simulation& simulation, const Probes& probes) {
  check_solver(simulation);
  check_supports(simulation);
  check_data(simulation);  // before the loads are asked for a state
  check_step(simulation);
  check_fields(simulation);
  check_families(simulation);
  const Case& input = simulation.input;
  for (const ExpectInput& expect : input.expects) {
    if (expect.state && !reaches(input, *expect.state)) fail_state(input, expect, *expect.state);
    if (expect.field.empty()) {
      check_metric(expect, probes.columns());
    } else {
      check_field(input, expect);
    }
  }
}

namespace {

/// Of the model and the mesh.
void warn_of_model(const Simulation& simulation, std::vector<std::string>& list) {
  const Body& body = *simulation.body;
  const double ratio = body.horizon / body.spacing;
  if (ratio < 2.9 && body.dimension > 1 && simulation.mesh == nullptr)
    list.push_back(fmt::format(
        "the horizon is {:.3g} spacings: families of so few directions are stiff along the lattice; 3 "
        "is usual",
        ratio));
  if (simulation.input.model.kind == "membrane" && simulation.input.model.stabilisation.value_or(4) < 1)
    list.emplace_back(
        "with a stabilisation below 1 rows of points fold over one another beside defects and under "
        "compression");
  if (simulation.input.model.kind == "correspondence" && simulation.input.model.variant == "published")
    list.emplace_back(
        "the published stabilisation has a wrong unit: its strength depends on the unit of length, here the "
        "metre; it is kept for comparison, variant = \"stabilised\" is the one to use");
  if ((simulation.input.model.kind == "correspondence" || simulation.mesh != nullptr) &&
      simulation.input.materials.front().law == LinearElastic::name)
    list.emplace_back(
        "the law \"linear-elastic\" takes rotations for strain: where they reach 1 % its stresses are wrong; "
        "\"compressible-neo-hookean\" has the same constants and no such limit");
  if (simulation.parameter == Parameter::stretch && simulation.model->has_memory())
    list.emplace_back(
        "statics knows no time: materials that relax give the answer to a jump; method = \"space-time\" with "
        "inertia = false has their times");
  if (!simulation.model->conservative())
    list.push_back(
        fmt::format("the model \"{}\" has no energy and holds for the loading \"{}\" only: it is kept for "
                    "comparison; kind = \"membrane\" is the one to use",
                    simulation.input.model.kind, simulation.input.model.loading));
  if (const auto& elements = simulation.input.geometry.elements; elements && elements->mesh)
    for (std::string& odd : oddities(*elements->mesh)) list.push_back(std::move(odd));
}

void warn_of_inclusions(const Body& body, std::vector<std::string>& list) {
  for (const Shape& inclusion : body.defects.inclusions) {
    bool near = false;
    for (std::size_t face = 0; face < 4; ++face) {
      Point edge = std::visit([](const auto& shape) { return shape.center; }, inclusion);
      edge[face / 2] = body.faces[face];
      near = near || signed_distance(inclusion, edge) < body.horizon;
    }
    if (near)
      list.emplace_back(
          "an inclusion is nearer than a horizon to an edge: the strip between is too thin for this lattice");
  }
}

}  // namespace

std::vector<std::string> warnings(const Simulation& simulation) {
  std::vector<std::string> list;
  warn_of_model(simulation, list);
  if (simulation.input.loads.empty() && simulation.input.initials.empty() &&
      simulation.input.impactors.empty())
    list.emplace_back("there is no load: nothing will move");
  if (simulation.input.probes.empty())
    list.emplace_back("there is no probe: history.csv and the metrics will be empty");
  if (simulation.input.solver.start != "equilibrium" && jumps_at_start(simulation))
    list.push_back(fmt::format("the loads are not zero at {}: the body starts with a jump",
                               simulation.parameter == Parameter::time ? "time 0" : "stretch 1"));
  if (!simulation.input.impactors.empty() && !simulation.input.contact &&
      std::any_of(simulation.input.materials.begin(), simulation.input.materials.end(),
                  [](const MaterialInput& m) { return m.breaks(); }))
    list.emplace_back("bonds can break, and without [contact] fragments of the body pass through each other");
  if (simulation.input.geometry.points) {
    warn_of_volumes(simulation, list);
    warn_of_lonely_points(simulation, list);
    warn_of_families(simulation, list);
  }
  const std::vector<std::string> unstable = stability_warnings(simulation.input);
  list.insert(list.end(), unstable.begin(), unstable.end());
  warn_of_inclusions(*simulation.body, list);
  return list;
}

}  // namespace riven
