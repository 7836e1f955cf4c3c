#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>

#include "base/nearest_name.hpp"
#include "input/contact_format.hpp"
#include "input/crack_format.hpp"
#include "input/crack_probe_format.hpp"
#include "input/element_mesh.hpp"
#include "input/elements_format.hpp"
#include "input/failure_format.hpp"
#include "input/field_format.hpp"
#include "input/format.hpp"
#include "input/format_lists.hpp"
#include "input/model_format.hpp"
#include "input/set_format.hpp"
#include "input/shape_format.hpp"
#include "input/study_format.hpp"
#include "input/table_format.hpp"

namespace riven {
namespace {

using kind::AnyUnit;
using kind::Components;
using kind::Flag;
using kind::Formula;
using kind::Integer;
using kind::Interval;
using kind::Part;
using kind::Parts;
using kind::Place;
using kind::Quantities;
using kind::Quantity;
using kind::Table;
using kind::Text;
using kind::Texts;

const std::string relaxation = "dynamic-relaxation";
const std::string newton = "newton";
const std::string verlet = "verlet";
const std::string space_time = "space-time";
const std::string generalised_alpha = "generalised-alpha";

When method(const Case& c, const std::string& value) {
  return {"solver.method", &c.solver.method, {value}};
}

When in_time(const Case& c) {
  return {"solver.method", &c.solver.method, SolverInput::methods_in_time()};
}

// Two of a kind must not share a name: probes name columns, sets name regions.
template <class Item>
void check_new_name(const std::vector<Item>& items, const Item& item, const Check& check) {
  for (const Item& other : items)
    if (&other != &item && other.name == item.name)
      check.fail("name", fmt::format("\"{}\" is the name of another one at {}; expected a new name",
                                     item.name, other.at.text()));
}

// ---- what interrupts the body ----

Format describe(HoleInput& hole, const Case& c) {
  const auto shape = std::make_shared<std::optional<Shape>>(hole.shape);
  return {.doc = "A hole: a shape without material.",
          .at = &hole.at,
          .keys = shape_keys(*shape),
          .groups = {{{"disc", "box", "ball"}}},
          .finish = [shape, &hole, &c](const Check& check) {
            hole.shape = shape->value();
            check_shape(hole.shape, c, check);
          }};
}

Format describe(InclusionInput& inclusion, const Case& c) {
  const auto shape = std::make_shared<std::optional<Shape>>(inclusion.shape);
  std::vector<Key> keys = {Key{"motion", Text{&inclusion.motion, {"free", "fixed"}},
                               "Whether it moves with the body around it or stays."}
                               .otherwise("\"free\"")};
  for (Key& key : shape_keys(*shape)) keys.push_back(std::move(key));
  return {.doc = "A rigid inclusion, bonded to the body.",
          .at = &inclusion.at,
          .keys = std::move(keys),
          .groups = {{{"disc", "box", "ball"}}},
          .finish = [shape, &inclusion, &c](const Check& check) {
            inclusion.shape = shape->value();
            check_shape(inclusion.shape, c, check);
          }};
}

// ---- load and solver ----

// Naming a part twice is a slip.
void check_parts(const std::vector<Named>& on, const Check& check) {
  std::set<std::string> seen;
  for (const Named& name : on)
    if (!seen.insert(name.text).second) check.fail("on", fmt::format("names \"{}\" twice", name.text));
}

bool all_free(const std::vector<ComponentInput>& components) {
  return std::none_of(components.begin(), components.end(),
                      [](const ComponentInput& component) { return component.value.has_value(); });
}

// Of N/m^3, and of 1/s.
constexpr Dimension force_density{.metre = -2, .second = -2, .kilogram = 1};
constexpr Dimension rate{.second = -1};

void check_load(const LoadInput& load, const Case& c, const Check& check) {
  check_parts(load.on, check);
  if (load.on.empty() && load.body_force.empty())
    check.fail("on", "missing; expected the edges or sets that the load acts on");
  for (const char* key : {"displacement", "velocity", "traction", "body_force"})
    if (check.given(key) && all_free(load.components()))
      check.fail(key, "every entry is \"free\"; expected a load");
  if (load.pressure && !c.geometry.elements)
    check.fail("pressure",
               "acts on the sides of finite elements, and this body has points; expected `traction`, "
               "which does not turn with the body");
  if (load.layer && load.traction.empty()) check.fail("layer", "belongs to traction");
  const std::vector<std::string> edges = edge_names(c);
  for (const Named& name : load.on) {
    const bool edge = std::find(edges.begin(), edges.end(), name.text) != edges.end();
    if (!edge && (!load.traction.empty() || load.pressure))
      check.fail("on", fmt::format("\"{}\" is a set, and a {} acts on an edge; expected {}, or "
                                   "body_force instead of it",
                                   name.text, load.pressure ? "pressure" : "traction", listed(edges)));
    if (edge && !load.body_force.empty())
      check.fail("on", fmt::format("\"{}\" is an edge, and a body force acts on points; expected a set, "
                                   "nothing for the whole body, or traction instead of body_force",
                                   name.text));
  }
}

Format describe(LoadInput& load, const Case& c) {
  return {
      .doc = "What is prescribed on an edge or a set.",
      .at = &load.at,
      .keys =
          {Key{"on", Parts{&load.on},
               "An edge (left, right, bottom, top, back, front) or a set, or a list of them. Only a "
               "body_force may do without: it then acts on the whole body."},
           Key{"displacement", Components{&load.displacement},
               "One entry per direction: \"free\" or a length, a formula of x, y, z and stretch "
               "(statics) or t (in time)."},
           Key{"velocity", Components{&load.velocity, dimension::velocity},
               "The same for a velocity, from zero displacement at time 0 on."}
               .applies(in_time(c)),
           Key{"traction", Components{&load.traction, dimension::pressure},
               "The same for a force per undeformed area of an edge; \"free\" and 0 are no force. It keeps "
               "its direction and "
               "size, as a dead pressure would."},
           Key{"pressure", Formula{&load.pressure, dimension::pressure},
               "Of finite elements: a force per deformed area of an edge, across it and into the body, which "
               "turns and grows with it. In plane stress the area is that of the undeformed thickness."},
           Key{"body_force", Components{&load.body_force, force_density},
               "The same for a force per undeformed volume of a set, or of the whole body."},
           Key{"layer", Quantity{&load.layer, dimension::length, positive},
               "Points this near to the edge carry its traction, in proportion to their volumes; "
               "geometry.spacing unless given."}},
      .groups = {{{"displacement", "velocity", "traction", "pressure", "body_force"}}},
      .finish = [&load, &c](const Check& check) { check_load(load, c, check); }};
}

Format describe(InitialInput& initial, const Case& c) {
  return {
      .doc =
          "The state from which a motion starts; where nothing is said, at rest and undeformed. Loads "
          "come before it where they prescribe a displacement.",
      .at = &initial.at,
      .keys = {Key{"on", Parts{&initial.on}, "A set, or a list of them; the whole body unless given."},
               Key{"displacement", Components{&initial.displacement, dimension::length, true},
                   "One entry per direction: a length, a formula of x, y, z, or \"free\": not said here."},
               Key{"velocity", Components{&initial.velocity, dimension::velocity, true},
                   "The same for the velocity."}},
      .finish = [&initial, &c](const Check& check) {
        check_parts(initial.on, check);
        const std::vector<std::string> edges = edge_names(c);
        for (const Named& name : initial.on)
          if (std::find(edges.begin(), edges.end(), name.text) != edges.end())
            check.fail("on", fmt::format("\"{}\" is an edge, and edges have no points; expected a set, or "
                                         "nothing for the whole body",
                                         name.text));
        if (all_free(initial.displacement) && all_free(initial.velocity))
          check.fail("", "says nothing; expected displacement or velocity");
      }};
}

void check_stretch(const std::vector<double>& stretch, const Check& check) {
  double before = 1;
  for (const double next : stretch) {
    const bool away = stretch.front() > 1 ? next > before : next < before;
    if (!away)
      check.fail("stretch",
                 fmt::format("{} comes after {}; expected numbers that move away from 1, such as [1.5, 2, 3]",
                             next, before));
    before = next;
  }
}

// Counts beyond these are slips of a unit or a digit.
constexpr double kMostStates = 1e6;
constexpr double kMostSteps = 1e9;

void check_count(const char* key, double count, const char* what, double most, const Check& check) {
  if (!(count <= most))
    check.fail(key, fmt::format("gives {:.3g} {}; expected {:g} at most", count, what, most));
}

Format describe(SolverInput& s) {
  const When in_statics{"method", &s.method, {relaxation, newton}};
  const When in_time{"method", &s.method, SolverInput::methods_in_time()};
  const When by_verlet{"method", &s.method, {verlet}}, in_slabs{"method", &s.method, {space_time}};
  const auto time = [](auto& to) { return Quantity{&to, dimension::time, positive}; };
  return {
      .doc = "How the body is brought to its states.",
      .at = &s.at,
      .keys =
          {Key{"method", Text{&s.method, {relaxation, newton, verlet, space_time, generalised_alpha}},
               "Static states by relaxation or by Newton's method; motion by explicit steps, by space-time "
               "slabs or "
               "by the generalised-alpha method."}
               .required(),
           Key{"stretch", Quantities{&s.stretch, dimension::none, positive},
               "Output states, moving away from 1."}
               .applies(in_statics)
               .required(),
           Key{"increment", Quantity{&s.increment, dimension::none, positive},
               "Largest step of the stretch; with arc-length control its first one, and later ones are as "
               "long "
               "on the path, or shorter."}
               .applies(in_statics)
               .otherwise("0.1"),
           Key{"control", Text{&s.control, {"load", "arc-length"}},
               "What steps are of: the stretch, or the length of the path of equilibria, which then is "
               "followed through points where the stretch has a maximum or a minimum, and where it is "
               "unstable."}
               .applies(When{"method", &s.method, {newton}})
               .otherwise("\"load\""),
           Key{"max_steps", Integer{&s.max_steps, 1},
               "After which the path ends, though it may not have reached the last stretch."}
               .applies(When{"control", &s.control, {"arc-length"}})
               .otherwise("1000"),
           Key{"tolerance", Quantity{&s.tolerance, dimension::none, fraction},
               "Statics: L2 norm of the free forces over that of the constraint forces, at which a state has "
               "converged; 1e-5 unless given. Space-time and generalised-alpha: norms of residual and "
               "increment over "
               "those of forces and motion; 1e-8 unless given."}
               .applies(When{"method", &s.method, {relaxation, newton, space_time, generalised_alpha}}),
           Key{"max_iterations", Integer{&s.max_iterations, 1},
               "Of relaxation, per load step; beyond it the step is cut. Newton's method, which relaxation "
               "stands in for where it fails, has 30."}
               .applies(in_statics)
               .otherwise("20000"),
           Key{"until", time(s.until), "End of the run."}.applies(in_time).required(),
           Key{"step", time(s.step),
               "Time step. Unless given, Verlet takes it from the stable step, and space-time slabs from "
               "step_tolerance."}
               .applies(in_time)
               .required_if(When{"method", &s.method, {generalised_alpha}}),
           Key{"safety", Quantity{&s.safety, dimension::none, fraction},
               "Part of the stable step that is used."}
               .applies(by_verlet)
               .otherwise("0.8"),
           Key{"damping", Quantity{&s.damping, rate, not_negative},
               "Force against the velocity, per mass and velocity: a free motion decays as exp(-damping t)."}
               .applies(by_verlet)
               .otherwise("0"),
           Key{"start", Text{&s.start, {"initial", "equilibrium"}},
               "The undeformed state or what [[initial]] says, or the equilibrium under the loads of time 0, "
               "with velocity 0: "
               "by dynamic relaxation before explicit steps, else by Newton's method. Without inertia it is "
               "always the equilibrium."}
               .applies(in_time)
               .otherwise("\"initial\""),
           Key{"start_tolerance", Quantity{&s.start_tolerance, dimension::none, fraction},
               "L2 norm of the free forces over those of constraints and loads, at which that equilibrium is "
               "reached."}
               .applies(When{"start", &s.start, {"equilibrium"}})
               .otherwise("1e-5"),
           Key{"scheme", Text{&s.scheme, {"two-field", "single-field"}},
               "Of the slabs: displacements and velocities that both jump, which damps what the step does "
               "not "
               "resolve, or continuous displacements, which keep an energy law."}
               .applies(in_slabs)
               .otherwise("\"two-field\""),
           Key{"gauss_points", Integer{&s.gauss_points, 2},
               "In time, of a single-field slab, 2 to 6; more for large changes of stretch in a step."}
               .applies(When{"scheme", &s.scheme, {"single-field"}})
               .otherwise("3"),
           Key{"step_tolerance", Quantity{&s.step_tolerance, dimension::none, fraction},
               "Where no step is given: energy of the jumps at a slab's start over that of the motion, above "
               "which "
               "the step is halved; it grows where there is much less."}
               .applies(in_slabs)
               .otherwise("1e-4"),
           Key{"inertia", Flag{&s.inertia},
               "false leaves masses out: the body is in equilibrium at any time, only what its material "
               "remembers moves on."}
               .applies(in_slabs)
               .otherwise("true"),
           Key{"spectral_radius", Quantity{&s.spectral_radius, dimension::none, {.low = 0, .high = 1}},
               "Amplification of motions far faster than the step, 0 to 1; 1 is Newmark's average "
               "acceleration."}
               .applies(When{"method", &s.method, {generalised_alpha}})
               .otherwise("0.8")},
      .finish = [&s](const Check& check) {
        check_stretch(s.stretch, check);
        if (!s.inertia) {
          if (check.given("start") && s.start == "initial")
            check.fail("start",
                       "without inertia the body starts in equilibrium; expected none, or inertia = true");
          s.start = "equilibrium";
          if (!check.given("start_tolerance")) s.start_tolerance = s.tolerance.value_or(1e-8);
        }
        if (s.gauss_points > 6) check.fail("gauss_points", "expected 2 to 6");
        if (!s.tolerance && !s.is_explicit()) s.tolerance = s.in_time() ? 1e-8 : 1e-5;
        if (s.stretch.empty()) {
          s.until_at = check.at("until");
          if (s.step) check_count("step", s.until / *s.step, "time steps", kMostSteps, check);
          return;
        }
        check_count("increment", std::abs(s.stretch.back() - 1) / s.increment, "load steps", kMostStates,
                    check);
      }};
}

// ---- what comes out ----

Format describe(OutputInput& output, const Case& c) {
  const auto time = [](std::optional<double>& to) { return Quantity{&to, dimension::time, positive}; };
  return {
      .doc = "What is written. Static solvers write at each stretch.",
      .at = &output.at,
      .keys =
          {Key{"every", time(output.every), "Time between output states; start and end only unless given."}
               .applies(in_time(c)),
           Key{"history_every", time(output.history_every),
               "Time between rows of the history; `every` unless given."}
               .applies(in_time(c)),
           Key{"fields",
               Texts{&output.fields,
                     {"displacement", "damage", "strain_energy_density", "nominal_stress", "weight_minimum",
                      "surface_correction", "deformation_gradient", "fragment", "mises_stress"}},
               "Fields of the output states; weight_minimum: membrane, surface_correction: "
               "membrane-bond, deformation_gradient: correspondence and finite-elements. fragment: the "
               "number of the part that a point belongs to, 1 the largest. mises_stress: finite-elements, "
               "which have no damage."}
               .otherwise(R"(["displacement", "damage", "strain_energy_density", "nominal_stress"])"),
           Key{"checkpoint_every", Interval{&output.checkpoint_every},
               "Wall time, or time steps or iterations (statics), between checkpoints, "
               "from which `riven run --resume` goes on."}
               .otherwise("\"5 min\"")},
      .finish = [&output, &c](const Check& check) {
        if (c.geometry.elements && !check.given("fields")) std::erase(output.fields, "damage");
        const double until = c.solver.until;
        if (output.every) check_count("every", until / *output.every, "output states", kMostStates, check);
        if (output.history_every)
          check_count("history_every", until / *output.history_every, "rows of the history", kMostStates,
                      check);
      }};
}

Format describe(ProbeInput& p, const Case& c) {
  const auto kinds = [&p](std::vector<std::string> among) { return When{"kind", &p.kind, std::move(among)}; };
  std::vector<std::string> all{"reaction", "nominal-stress", "displacement",      "stretch", "strain",
                               "largest",  "overload",       "dissipated-energy", "impactor"};
  all.insert(all.end(), crack_probe_kinds().begin(), crack_probe_kinds().end());
  std::vector<Key> keys = {
      Key{"name", Text{&p.name}, "Its name in the history and in metrics."}.required(),
      Key{"kind", Text{&p.kind, std::move(all)}, "What it measures."}.required(),
      Key{"on", Part{&p.on},
          "The edge or set whose external force is summed; the inertia of points that a load "
          "moves is not in it. Of cracks: the set whose points are looked at, all unless given."}
          .applies(kinds({"reaction", "nominal-stress", "crack-length", "crack-area", "crack-speed",
                          "crack-tip", "branches", "crack-angle"}))
          .required_if(kinds({"reaction", "nominal-stress"})),
      Key{"component", Text{&p.component, {"x", "y", "z"}},
          "Only this component; the metric then has the probe's own name. Otherwise all, as "
          "name_x, name_y."}
          .applies(kinds({"reaction", "displacement"})),
      Key{"at", Place{&p.position}, "A place in the undeformed body."}
          .applies(kinds({"displacement"}))
          .required(),
      Key{"from", Place{&p.from}, "One of two places in the undeformed body."}
          .applies(kinds({"stretch", "strain"}))
          .required(),
      Key{"to", Place{&p.to},
          "The other place; the probe is their distance over the undeformed one, as a strain less 1."}
          .applies(kinds({"stretch", "strain"}))
          .required(),
      Key{"of", Text{&p.of},
          "The metric, of a probe above, whose largest value over the rows of the history is kept."}
          .applies(kinds({"largest"}))
          .required(),
      Key{"gives", Text{&p.gives},
          "Instead of that largest value, what this metric, stretch or time was there."}
          .applies(kinds({"largest"})),
      Key{"impactor", Text{&p.impactor},
          "The impactor whose position, velocity (of points) and force, that of the body on it, are "
          "followed: name_position_x and so on."}
          .applies(kinds({"impactor"}))
          .required()};
  for (Key& key : crack_probe_keys(p)) keys.push_back(std::move(key));
  return {.doc = "A number that is followed through the run.",
          .at = &p.at,
          .keys = std::move(keys),
          .finish = [&p, &c](const Check& check) {
            check_new_name(c.probes, p, check);
            check_crack_probe(p, c, check);
            if (p.kind == "impactor") check_impactor(p.impactor, c, check);
            if (p.from && p.from == p.to) check.fail("to", "is the same place as from; expected two places");
          }};
}

// The values of one expectation share a dimension; a plain 0 takes that of its companions.
void unify_dimensions(ExpectInput& e, const Check& check) {
  const std::array<std::pair<const char*, std::optional<AnyQuantity>*>, 4> all{
      {{"value", &e.value}, {"absolute_tolerance", &e.absolute_tolerance}, {"min", &e.min}, {"max", &e.max}}};
  const auto plain_zero = [](const AnyQuantity& q) { return q.si == 0 && q.dimension == "1"; };
  std::string shared;
  for (const auto& [key, quantity] : all) {
    if (!*quantity || plain_zero(**quantity)) continue;
    if (shared.empty()) shared = (*quantity)->dimension;
    if ((*quantity)->dimension != shared)
      check.fail(key, fmt::format("is in {}; expected {}, as its companion", (*quantity)->dimension, shared));
  }
  for (const auto& [key, quantity] : all)
    if (*quantity && !shared.empty()) (*quantity)->dimension = shared;
}

void check_metric(ExpectInput& e, const Check& check) {
  const bool range = e.min || e.max;
  if (!e.value && !range) check.fail("metric", "nothing to compare with; expected value, or min and max");
  if (e.value && range) check.fail("value", "given together with min or max; expected one of both");
  unify_dimensions(e, check);
  if (e.min && e.max && e.min->si > e.max->si) check.fail("max", "is below min");
  if (range && (e.tolerance || e.absolute_tolerance)) check.fail("min", "min and max need no tolerance");
  if (e.value && e.value->si == 0 && e.tolerance)
    check.fail("tolerance", "is relative, and the value is 0; expected absolute_tolerance");
  if (e.value && e.kind == "reference" && !e.tolerance && !e.absolute_tolerance)
    check.fail("value", "a reference decides; expected tolerance (relative) or absolute_tolerance with it");
}

Format describe(ExpectInput& e, const Case& c) {
  const bool moving = c.solver.in_time();
  return {.doc = "A published or reference result, which `riven verify` compares; only references decide.",
          .at = &e.at,
          .keys = {Key{"metric", Text{&e.metric}, "A name in the metrics of summary.json."},
                   Key{"value", AnyUnit{&e.value}, "Its value, with unit."},
                   Key{"tolerance", Quantity{&e.tolerance, dimension::none, positive},
                       "Relative; for a field the relative L2 norm per state."},
                   Key{"absolute_tolerance", AnyUnit{&e.absolute_tolerance},
                       "Instead of the relative one, for values of zero."},
                   Key{"min", AnyUnit{&e.min}, "Smallest value, instead of value and tolerance."},
                   Key{"max", AnyUnit{&e.max}, "Largest value."},
                   Key{"field", Text{&e.field, {"displacement"}}, "A field instead of a metric."},
                   Key{"file", Text{&e.file}, "CSV with the field's values, relative to the case file."},
                   Key{"exclude_within", Quantity{&e.exclude_within, dimension::length, not_negative},
                       "Field points this near to a defect do not count."}
                       .otherwise("0"),
                   Key{"at", Quantity{&e.state, moving ? dimension::time : dimension::none, any_number},
                       "The state: a stretch, or a time with unit; unless given the final one (metric) or "
                       "all (field)."},
                   Key{"kind", Text{&e.kind, {"published", "reference"}},
                       "Whether the value was published or is an independent reference."}
                       .required(),
                   Key{"source", Text{&e.source}, "Where the value comes from."}.otherwise("\"\"")},
          .groups = {{{"metric", "field"}}},
          .finish = [&e](const Check& check) {
            if (e.field.empty()) {
              if (check.given("file")) check.fail("file", "belongs to field, not to metric");
              return check_metric(e, check);
            }
            if (e.file.empty()) check.fail("file", "missing; a field needs the CSV file to compare with");
            for (const char* key : {"value", "absolute_tolerance", "min", "max"})
              if (check.given(key)) check.fail(key, "belongs to metric; a field takes file and tolerance");
            if (e.kind == "reference" && !e.tolerance)
              check.fail("tolerance", "missing; a reference decides and needs it");
          }};
}

Format describe(std::optional<ShortInput>& run, const Case& c) {
  if (!run) run.emplace();
  return {.doc = "What `riven verify --short` runs instead: overrides and their own expectations.",
          .at = &run->at,
          .keys = {Key{"set", Texts{&run->set}, "Overrides as for --set: \"path.to.key=value\"."}.required(),
                   Key{"expect",
                       tables(run->expect, [&c](ExpectInput& e, std::size_t) { return describe(e, c); }),
                       "As [[expect]]."}},
          .finish = [&run](const Check& check) {
            for (const std::string& text : run->set)
              if (text.find('=') == std::string::npos || text.front() == '=')
                check.fail("set", fmt::format("\"{}\" has no \"=\"; expected \"path.to.key=value\"", text));
          }};
}

bool always() {
  return true;
}

}  // namespace

std::vector<std::string> edge_names(const Case& of) {
  std::vector<std::string> names{"left", "right", "bottom", "top", "back", "front"};
  if (!std::holds_alternative<Box>(of.geometry.shape)) return {};
  names.resize(2 * static_cast<std::size_t>(of.geometry.dimension));
  for (std::size_t face = names.size(); face-- > 0;)
    if (of.geometry.open_faces[face]) names.erase(names.begin() + static_cast<std::ptrdiff_t>(face));
  const auto take = [&names](const std::string& name) { std::erase(names, name); };
  for (const std::string& name : other_groups(of.geometry)) take(name);
  for (const std::string& name : edge_groups(of.geometry)) {
    take(name);  // the user's goes before a side of the box
    names.push_back(name);
  }
  return names;
}

std::vector<std::string> part_names(const Case& of) {
  std::vector<std::string> names = edge_names(of);
  for (std::string& name : other_groups(of.geometry)) names.push_back(std::move(name));
  for (const SetInput& set : of.sets) names.push_back(set.name);
  return names;
}

Format describe(Case& c) {
  // The order is that of reading: what later keys need comes first.
  return {
      .doc = "A case: one text file in TOML that says all about one simulation.",
      .keys =
          {Key{"title", Text{&c.title}, "What the case shows."}.required(),
           Key{"source", Text{&c.source}, "Where the problem was published."}.otherwise("\"\""),
           Key{"table", named_tables(c.tables, [&c](TableInput& t) { return describe(t, c); }),
               "Functions given by points."},
           Key{"geometry", Table{[&c] { return describe_geometry(c); }, always}, "The body."}.required(),
           Key{"field", named_tables(c.fields, [&c](FieldInput& f) { return describe(f, c); }),
               "Values at places."},
           Key{"hole", tables(c.holes, [&c](HoleInput& h, std::size_t) { return describe(h, c); }), "Holes."},
           Key{"crack", tables(c.cracks, [&c](CrackInput& k, std::size_t) { return describe_crack(k, c); }),
               "Cracks."},
           Key{"inclusion",
               tables(c.inclusions, [&c](InclusionInput& i, std::size_t) { return describe(i, c); }),
               "Rigid inclusions."},
           Key{"set", named_tables(c.sets, [&c](SetInput& s) { return describe(s, c); }), "Sets of points."},
           Key{"model", Table{[&c] { return describe(c.model); }, always}, "The model."}.otherwise("{}"),
           Key{"solver", Table{[&c] { return describe(c.solver); }, always}, "The solver."}.required(),
           Key{"material", named_tables(c.materials, [&c](MaterialInput& m) { return describe(m, c); }),
               "The materials."}
               .required(),
           Key{"interface",
               tables(c.interfaces, [&c](InterfaceInput& i, std::size_t) { return describe(i, c); }),
               "Between materials."},
           Key{"failure", Table{[&c] { return describe(c.failure, c); }, always}, "Failure."}.otherwise("{}"),
           Key{"load", tables(c.loads, [&c](LoadInput& l, std::size_t) { return describe(l, c); }), "Loads."},
           Key{"initial", tables(c.initials, [&c](InitialInput& i, std::size_t) { return describe(i, c); }),
               "Initial conditions. Relaxation starts undeformed, since its states do not depend on where "
               "it starts."}
               .applies(in_time(c)),
           Key{"contact",
               Table{[&c] { return describe(c.contact, c); }, [&c] { return c.contact.has_value(); }},
               "Contact of the body with itself."}
               .applies(method(c, verlet)),
           Key{"impactor",
               tables(c.impactors, [&c](ImpactorInput& i, std::size_t) { return describe(i, c); }),
               "Rigid impactors."},
           Key{"output", Table{[&c] { return describe(c.output, c); }, always}, "The output."}.otherwise(
               "{}"),
           Key{"probe", tables(c.probes, [&c](ProbeInput& p, std::size_t) { return describe(p, c); }),
               "Probes."},
           Key{"expect", tables(c.expects, [&c](ExpectInput& e, std::size_t) { return describe(e, c); }),
               "Expected results."},
           Key{"short",
               Table{[&c] { return describe(c.short_run, c); }, [&c] { return c.short_run.has_value(); }},
               "The short variant."},
           Key{"study", Table{[&c] { return describe(c.study); }, [&c] { return c.study.has_value(); }},
               "The study."}},
      .finish = [&c](const Check& check) {
        check_failure(c, check);
        check_elements(c);
      }};
}

}  // namespace riven
