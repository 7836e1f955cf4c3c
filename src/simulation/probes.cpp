#include "simulation/probes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/nearest_name.hpp"
#include "verification/interpolate.hpp"

namespace riven {

namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

/// Displacements anywhere in the body at one state.
class DisplacementField {
 public:
  DisplacementField(const Simulation& simulation, std::span<const double> u)
      : mesh_(simulation.mesh),
        positions_(simulation.model->positions()),
        displacements_(simulation.model->displacements(u)),
        interpolation_(positions_, displacements_, simulation.body->defects, simulation.body->spacing,
                       simulation.body->horizon) {}

  [[nodiscard]] Point at(const Point& place, const ProbeInput& probe) const {
    const auto displacement = mesh_ != nullptr ? in_element(place) : interpolation_.at(place);
    if (!displacement)
      throw InputError(probe.at, fmt::format("probe {}: there is no material at ({:g}, {:g}, {:g}) m",
                                             probe.name, place[0], place[1], place[2]));
    return *displacement;
  }

 private:
  [[nodiscard]] std::optional<Point> in_element(const Point& place) const {
    const auto found = locate(*mesh_, place);
    if (!found) return std::nullopt;
    Point sum{};
    for (std::size_t a = 0; a < found->value.size(); ++a)
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum[axis] += found->value[a] * displacements_[mesh_->nodes(found->element)[a]][axis];
    return sum;
  }

  const MeshBody* mesh_;
  std::vector<Point> positions_;
  std::vector<Point> displacements_;
  Interpolation interpolation_;
};

double distance_between(const Point& a, const Point& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

/// Axis of the one component that a probe asks for.
std::size_t axis_of(const ProbeInput& probe) {
  return static_cast<std::size_t>(probe.component[0] - 'x');
}

Point moved(const Point& x, const Point& u) {
  return {x[0] + u[0], x[1] + u[1], x[2] + u[2]};
}

}  // namespace

Probes::Probes(const Simulation& simulation) : simulation_(simulation), cracks_(simulation) {
  for (const ProbeInput& probe : simulation.input.probes) {
    const bool plain = std::all_of(probe.name.begin(), probe.name.end(),
                                   [](char c) { return static_cast<unsigned char>(c) >= ' '; });
    if (probe.name.empty() || !plain || probe.name == "stretch" || probe.name == "time" ||
        probe.name == "cycle")
      throw InputError(
          probe.at,
          "probe: the name heads a column of history.csv, beside stretch or time; expected another one, "
          "of printable characters");
    const std::size_t before = columns_.size();
    add_columns(probe);
    for (std::size_t n = before; n < columns_.size(); ++n)
      for (std::size_t other = 0; other < before; ++other)
        if (columns_[n].name == columns_[other].name)
          throw InputError(probe.at,
                           fmt::format("probe {}: gives the metric {}, which a probe above gives too; "
                                       "expected another name",
                                       probe.name, columns_[n].name));
  }
  const std::vector<double> rest(simulation.model->dofs(), 0.0);
  const DisplacementField field(simulation, rest);
  for (const ProbeInput& probe : simulation.input.probes)
    for (const auto& place : {probe.position, probe.from, probe.to})
      if (place) static_cast<void>(field.at(*place, probe));
}

void Probes::add_columns(const ProbeInput& probe) {
  const auto dimension = static_cast<std::size_t>(simulation_.body->dimension);
  if (!probe.component.empty() && axis_of(probe) >= dimension)
    throw InputError(probe.at, fmt::format("probe {}: component {}; expected one of the body's {}",
                                           probe.name, probe.component, dimension));
  const auto vector = [&](const std::string& name, const std::string& unit) {
    if (!probe.component.empty()) {
      columns_.push_back({probe.name, unit});
      return;
    }
    for (std::size_t a = 0; a < dimension; ++a) columns_.push_back({name + "_" + kAxes[a], unit});
  };
  if (probe.kind == "reaction") vector(probe.name, "N");
  if (probe.kind == "nominal-stress" && simulation_.edge(probe.on.text)) vector(probe.name, "Pa");
  if (probe.kind == "nominal-stress" && !simulation_.edge(probe.on.text))
    for (const char* component : {"_xx", "_xy", "_yx", "_yy"})
      columns_.push_back({probe.name + component, "Pa"});
  if (probe.kind == "displacement") vector("displacement_" + probe.name, "m");
  if (probe.kind == "stretch" || probe.kind == "strain") columns_.push_back({probe.name, ""});
  if (probe.kind == "largest") add_largest(probe);
  if (CrackProbes::is_one(probe))
    for (HistoryColumn& column : CrackProbes::columns(probe)) columns_.push_back(std::move(column));
  if (probe.kind == "overload") columns_.push_back({probe.name, ""});
  if (probe.kind == "dissipated-energy") columns_.push_back({probe.name, "J"});
  if (probe.kind == "impactor") {
    vector(probe.name + "_position", "m");
    if (simulation_.contact != nullptr) vector(probe.name + "_velocity", "m/s");
    vector(probe.name + "_force", "N");
  }
}

void Probes::add_largest(const ProbeInput& probe) {
  std::vector<std::string> names;
  for (const HistoryColumn& column : columns_) names.push_back(column.name);
  const auto find = [&](const char* key, const std::string& name, const std::vector<std::string>& among) {
    const auto found = std::find(among.begin(), among.end(), name);
    if (found == among.end())
      throw InputError(
          probe.at, fmt::format("probe {}: {}: no probe above gives \"{}\"; known are {}{}", probe.name, key,
                                name, among.empty() ? "none" : listed(among), did_you_mean(name, among)));
    return static_cast<std::size_t>(found - among.begin());
  };
  const std::size_t of = find("of", probe.of, names);
  LargestColumn largest{.column = columns_.size(), .of = of, .gives = of};
  std::string unit = columns_[of].unit;
  if (!probe.gives.empty()) {
    names.emplace_back(name(simulation_.parameter));
    const std::size_t gives = find("gives", probe.gives, names);
    const bool is_column = gives < columns_.size();
    largest.gives = is_column ? std::optional(gives) : std::nullopt;
    unit = is_column ? columns_[gives].unit : std::string(riven::unit(simulation_.parameter));
  }
  columns_.push_back({probe.name, unit});
  largest_.add(largest);
}

std::vector<double> Probes::evaluate(const State& state, const Constraints& constraints) {
  const auto dimension = static_cast<std::size_t>(simulation_.body->dimension);
  cracks_.look(state.parameter);
  std::optional<DisplacementField> field;
  for (const ProbeInput& probe : simulation_.input.probes)
    if (!field && (probe.position || probe.from)) field.emplace(simulation_, state.u);
  std::vector<double> values;
  for (std::size_t n = 0; n < simulation_.input.probes.size(); ++n) {
    const ProbeInput& probe = simulation_.input.probes[n];
    const auto add = [&](const Point& vector, double divisor) {
      for (std::size_t a = 0; a < dimension; ++a)
        if (probe.component.empty() || axis_of(probe) == a) values.push_back(vector[a] / divisor);
    };
    const auto face = simulation_.edge(probe.on.text);
    if (probe.kind == "reaction")
      add(face ? force_on(*face, state, constraints)
               : reaction_of(simulation_.set(probe.on.text), constraints),
          1);
    if (probe.kind == "nominal-stress" && face)
      add(force_on(*face, state, constraints), simulation_.mesh != nullptr
                                                   ? simulation_.mesh->face_area(*face)
                                                   : simulation_.body->face_area(*face));
    if (probe.kind == "nominal-stress" && !face) {
      const std::array<double, 9> stress = mean_stress(simulation_.set(probe.on.text), state.u);
      values.insert(values.end(), {stress[0], stress[1], stress[3], stress[4]});
    }
    if (probe.kind == "displacement") add(field->at(*probe.position, probe), 1);
    if (probe.from)
      values.push_back(distance_between(moved(*probe.from, field->at(*probe.from, probe)),
                                        moved(*probe.to, field->at(*probe.to, probe))) /
                           distance_between(*probe.from, *probe.to) -
                       (probe.kind == "strain" ? 1 : 0));
    if (probe.kind == "largest") values.push_back(0);  // filled in when all others are known
    if (CrackProbes::is_one(probe)) {
      const std::vector<double> of_cracks = cracks_.values(n);
      values.insert(values.end(), of_cracks.begin(), of_cracks.end());
    }
    if (probe.kind == "overload") values.push_back(simulation_.model->overload(state.u));
    if (probe.kind == "dissipated-energy") values.push_back(state.energy.dissipated);
    if (probe.kind == "impactor")
      for (const Point& vector : impactor_of(probe, state)) add(vector, 1);
  }
  largest_.look_at(state.parameter, values);
  return values;
}

/// What moves the edge, or the traction or pressure on it, exerts; an edge of elements may have both.
Point Probes::force_on(std::size_t face, const State& state, const Constraints& constraints) const {
  Point force = constraints.reaction(face);
  for (const AppliedForce& applied : simulation_.applied)
    if (applied.face == face) force = moved(force, applied.total(state.u, state.parameter));
  return force;
}

/// Position (m), in motion of points velocity (m/s) of an impactor, and the force (N) of the body on it.
std::vector<Point> Probes::impactor_of(const ProbeInput& probe, const State& state) const {
  const std::vector<ImpactorInput>& inputs = simulation_.input.impactors;
  const auto found = std::find_if(inputs.begin(), inputs.end(),
                                  [&](const ImpactorInput& in) { return in.name == probe.impactor; });
  const auto n = static_cast<std::size_t>(found - inputs.begin());
  if (simulation_.contact == nullptr) {
    const Indenter& indenter = *simulation_.indenters[n];
    return {moved(start_of(indenter.settings().shape), indenter.settings().way(state.parameter)),
            indenter.force_on(state.u, state.parameter)};
  }
  const ContactModel& contact = *simulation_.contact;
  const Point start = contact.impactors()[n].start();
  Point velocity{};
  for (std::size_t axis = 0; axis < found->velocity.size(); ++axis)
    velocity[axis] = (*found->velocity[axis].value)(Variables{.position = start, .t = state.parameter});
  // A free one has its velocity in the state, which a prescribed one is not a part of.
  if (found->mass)
    std::copy_n(state.v.begin() + static_cast<std::ptrdiff_t>(contact.impactor_entry(n)),
                simulation_.body->dimension, velocity.begin());
  return {moved(start, contact.moved(n, state.u)), velocity, contact.force_on_impactor(n, state.u)};
}

/// External force on the points of a set, whichever load holds them.
Point Probes::reaction_of(const PointSet& set, const Constraints& constraints) const {
  Point sum{};
  for (const std::size_t number : set.points)
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(simulation_.body->dimension); ++axis)
      sum[axis] += constraints.external_force(simulation_.entry(axis, number));
  return sum;
}

/// Nominal stress of a set, averaged over its volume, row by row.
std::array<double, 9> Probes::mean_stress(const PointSet& set, std::span<const double> u) const {
  std::array<double, 9> mean{};
  double volume = 0;
  for (const ModelField& field : simulation_.model->fields(u)) {
    if (field.name != "nominal_stress") continue;
    for (const std::size_t number : set.points) {
      const double here = simulation_.body->volume[simulation_.body->points[number]];
      volume += here;
      for (std::size_t c = 0; c < 9; ++c) mean[c] += here * field.values[9 * number + c];
    }
  }
  for (double& component : mean) component /= volume;
  return mean;
}

Metrics Probes::metrics(const std::vector<double>& values) const {
  Metrics metrics;
  for (std::size_t n = 0; n < columns_.size(); ++n) metrics[columns_[n].name] = {values[n], columns_[n].unit};
  return metrics;
}

}  // namespace riven
