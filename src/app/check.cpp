#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/commands.hpp"
#include "app/sweep_plan.hpp"
#include "base/machine.hpp"
#include "base/text.hpp"
#include "geometry/surface.hpp"
#include "input/case_reader.hpp"
#include "input/case_writer.hpp"
#include "input/material_format.hpp"
#include "input/schema.hpp"
#include "input/set_format.hpp"
#include "simulation/estimate.hpp"
#include "simulation/materials.hpp"
#include "simulation/preflight.hpp"
#include "simulation/probes.hpp"
#include "solver/velocity_verlet.hpp"

#include <nlohmann/json.hpp>

namespace riven::app {

namespace {

double volume_of(const Body& body, const std::vector<std::size_t>& points) {
  double volume = 0;
  for (const std::size_t i : points) volume += body.volume[i];
  return volume;
}

/// How well points fill the shapes of a set, and where those lie that a seed has put somewhere.
void print_shapes(const SetInput& in, const PointSet& set, const Simulation& simulation) {
  const std::vector<TurnedShape> shapes = shapes_of(in);
  if (shapes.empty()) return;
  const Body& body = *simulation.body;
  std::vector<std::size_t> stored;
  for (const std::size_t i : set.points) stored.push_back(body.points[i]);
  const GeometryInput& geometry = simulation.input.geometry;
  double sum = 0;
  for (const TurnedShape& shape : shapes)
    sum += measure(shape, geometry.dimension) * (geometry.dimension < 3 ? geometry.thickness : 1);
  const double whole = volume_of(body, body.points);
  const std::string exact =
      std::isfinite(sum) ? fmt::format(", the shapes add up to {:.4g} %", 1e2 * sum / whole) : "";
  fmt::print("#   {}: its points have {:.4g} % of the body's volume{}\n",
             count_text(static_cast<double>(shapes.size()), "shape"), 1e2 * volume_of(body, stored) / whole,
             exact);
  if (!in.random_discs && !in.random_balls) return;
  for (const TurnedShape& shape : shapes) {
    const Point center = center_of(shape);
    fmt::print("#   center ({:.6g}) m\n",
               fmt::join(center.begin(), center.begin() + geometry.dimension, ", "));
  }
}

void print_sets(const Simulation& simulation) {
  for (std::size_t n = 0; n < simulation.sets.size(); ++n) {
    const PointSet& set = simulation.sets[n];
    Point lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};
    for (const std::size_t i : set.points) {
      const Point x = simulation.body->position(simulation.body->points[i]);
      for (std::size_t a = 0; a < 3; ++a) {
        lower[a] = std::min(lower[a], x[a]);
        upper[a] = std::max(upper[a], x[a]);
      }
    }
    fmt::print("# set {}: {} points, x {:g} to {:g} m, y {:g} to {:g} m\n", set.name, set.points.size(),
               lower[0], upper[0], lower[1], upper[1]);
    if (n < simulation.input.sets.size()) print_shapes(simulation.input.sets[n], set, simulation);
  }
}

/// Physical groups of a mesh that are edges.
void print_edges(const Simulation& simulation) {
  for (std::size_t edge = kFaceNames.size(); edge < simulation.edges(); ++edge)
    fmt::print("# edge {}: {} sides, {:.6g} m^2\n", simulation.mesh->group[edge - kFaceNames.size()].name,
               simulation.mesh->sides(edge).size(), simulation.mesh->face_area(edge));
}

std::string range(const TableFunction::Column& column) {
  const auto [least, most] = std::minmax_element(column.values.begin(), column.values.end());
  const std::string span = fmt::format("{} {:g} to {:g}", without_unit(column.name), *least, *most);
  return column.dimension == dimension::none ? span : fmt::format("{} {}", span, si_unit(column.dimension));
}

void print_indenters(const Simulation& simulation) {
  constexpr std::array kShapes{"sphere", "plane", "flat"};
  for (const auto& indenter : simulation.indenters) {
    const IndenterSettings& settings = indenter->settings();
    fmt::print("# impactor {}: {}, {}, {} nodes face it, {:.4g} N/m^3\n", settings.name,
               kShapes[settings.shape.index()], settings.sticking ? "sticking" : "frictionless",
               indenter->surface().size(), settings.stiffness);
  }
}

void print_initial(const char* what, const char* unit, const std::vector<double>& state,
                   const Simulation& simulation) {
  if (state.empty()) return;
  std::size_t points = 0;
  double largest = 0;
  for (std::size_t i = 0; i < simulation.body->points.size(); ++i) {
    double square = 0;
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(simulation.body->dimension); ++axis)
      square += std::pow(state[simulation.entry(axis, i)], 2);
    points += square > 0 ? 1 : 0;
    largest = std::max(largest, std::sqrt(square));
  }
  fmt::print("# initial {}: {} of {} points, at most {:g} {}\n", what, points, simulation.body->points.size(),
             largest, unit);
}

void print_tables(const Case& input) {
  for (const TableInput& table : input.tables) {
    const TableFunction& f = *table.function;
    fmt::print("# table {}: {}, {} points, {}, {}; beyond its ends {}\n", table.name, f.file().string(),
               f.argument().values.size(), range(f.argument()), range(f.value()),
               f.holds() ? "it holds its first and last value" : "an error");
  }
}

void print_fields(const Case& input) {
  for (const FieldInput& field : input.fields)
    fmt::print("# field {}: {}, {} places, {}\n", field.name, field.field->file(),
               field.field->value().values.size(), range(field.field->value()));
}

/// What tractions and body forces sum up to, at the start and at the end.
void print_forces(const Simulation& simulation) {
  const SolverInput& solver = simulation.input.solver;
  const bool in_time = simulation.parameter == Parameter::time;
  const auto text = [&](const Point& force) {
    return fmt::format("({:.6g}) N",
                       fmt::join(force.begin(), force.begin() + simulation.body->dimension, ", "));
  };
  const std::vector<double> rest(simulation.model->dofs(), 0.0);
  for (const AppliedForce& applied : simulation.applied)
    fmt::print("# {} on {}: {} in all at the start, {} at the end{}\n", applied.kind(),
               applied.on.empty() ? "the body" : applied.on, text(applied.total(rest, in_time ? 0 : 1)),
               text(applied.total(rest, in_time ? solver.until : solver.stretch.back())),
               applied.pressure ? " if the body did not deform" : "");
}

std::string extent_text(const Body& body) {
  std::string text;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(body.dimension); ++axis)
    text += fmt::format("{}{} {:g} to {:g} m", axis == 0 ? "" : ", ", "xyz"[axis], body.faces[2 * axis],
                        body.faces[2 * axis + 1]);
  return text;
}

void print_points(const Simulation& simulation) {
  const Model& model = *simulation.model;
  const Body& body = *simulation.body;
  if (const auto& points = simulation.input.geometry.points)
    fmt::print("# {}: {} in {}, filling {}\n", points->is_mesh() ? "elements" : "points",
               points->list->position.size(), points->list->file, extent_text(body));
  if (const auto& surface = simulation.input.geometry.surface)
    fmt::print("# surface: {} triangles in {}, around {:.6g} m^3\n", surface->surface->size(), surface->file,
               surface->surface->volume());
  const LatticeBonds* on = body.on_lattice();
  const std::string cells = on == nullptr
                                ? std::string("with listed bonds, mean spacing")
                                : fmt::format("of {} cells, spacing", fmt::join(on->lattice.cells(), " x "));
  fmt::print("# body: {} points {} {:.6g} m, volume {:.6g} m^3, {} ghost points behind loaded edges\n",
             model.points(), cells, body.spacing, volume_of(body, body.points), body.ghosts.size());
  const std::string neighbours =
      on == nullptr ? std::string("listed") : fmt::format("{} neighbours", on->stencil.size());
  fmt::print("# bonds: {} directed, {} within the horizon of {:g} spacings\n", model.bonds(), neighbours,
             body.horizon / body.spacing);
}

void print_model(const Simulation& simulation) {
  const Model& model = *simulation.model;
  const Body& body = *simulation.body;
  if (simulation.mesh == nullptr)
    print_points(simulation);
  else
    fmt::print("# body: {}, volume {:.6g} m^3\n", extent_text(body), volume_of(body, body.points));
  for (const MaterialInput& in : simulation.input.materials)
    if (is_complete(in)) fmt::print("# material {}: {}\n", in.name, moduli_text(make_material(in)));
  for (const std::string& line : model.describe()) fmt::print("# {}\n", line);
  print_edges(simulation);
  print_sets(simulation);
  print_forces(simulation);
  print_indenters(simulation);
  print_initial("displacement", "m", simulation.initial_u, simulation);
  print_initial("velocity", "m/s", simulation.initial_v, simulation);
}

void print_cost(const Simulation& simulation) {
  if (simulation.parameter == Parameter::time && simulation.input.solver.inertia) {
    const std::vector<double> rest(simulation.model->dofs(), 0.0);
    fmt::print("# stable step of explicit methods: {:.4g} s at rest\n",
               stable_step(*simulation.model, *simulation.constraints, rest, simulation.external));
  }
  const TimeEstimate time = time_estimate(simulation);
  fmt::print("# time: about {} on {} ({:.3g} {} of {:.2g} ms)\n", duration_text(time.total_s()),
             count_text(omp_get_max_threads(), "thread"), time.evaluations, time.unit,
             1e3 * time.evaluation_s);
  fmt::print("# memory: about {}\n", bytes_text(memory_estimate(simulation.input)));
  fmt::print("# disk: up to {}\n", bytes_text(output_estimate(simulation)));
}

/// The short variant is a run of its own and may be wrong where the full one is right.
void check_short(const Case& input, std::vector<std::string> set) {
  set.insert(set.end(), input.short_run->set.begin(), input.short_run->set.end());
  Case brief = read_case(input.file, set);
  brief.expects = input.short_run->expect;
  const Simulation simulation = build_simulation(brief);
  check_before_run(simulation, Probes(simulation));
}

/// What the study runs, every variant checked.
std::string study_text(const Options& options) {
  const SweepPlan plan = plan_sweep({.target = options.target, .set = options.set});
  return fmt::format("{} over {}", count_text(static_cast<double>(plan.variants.size()), "variant"),
                     fmt::join(plan.labels, ", "));
}

}  // namespace

int check(const Options& options) {
  if (options.threads > 0) omp_set_num_threads(options.threads);
  Case input = read_case(find_case(options.target), options.set);
  const std::size_t unreached = options.set.empty() ? 0 : drop_unreached_expectations(input);
  const Simulation simulation = build_simulation(input);
  const Probes probes(simulation);
  check_before_run(simulation, probes);
  check_disk(simulation, available_disk(default_output(input.file)));
  if (input.short_run) check_short(input, options.set);
  const std::string study = input.study ? study_text(options) : "";
  fmt::print("{}\n", resolved_case(input));
  print_tables(input);
  print_fields(input);
  print_model(simulation);
  print_cost(simulation);
  if (!study.empty()) fmt::print("# study: {}\n", study);
  for (const HistoryColumn& column : probes.columns())
    fmt::print("# metric {}{}\n", column.name, column.unit.empty() ? "" : " [" + column.unit + "]");
  if (unreached > 0) fmt::print("# {}\n", left_out(unreached));
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
