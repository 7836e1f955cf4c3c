#include "simulation/probes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "verification/interpolate.hpp"

namespace riven {

namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

/// Displacements anywhere in the body at one state.
class DisplacementField {
 public:
  DisplacementField(const Simulation& simulation, std::span<const double> u)
      : positions_(simulation.model->positions()),
        displacements_(simulation.model->displacements(u)),
        interpolation_(positions_, displacements_, simulation.body->defects, simulation.body->spacing,
                       simulation.body->horizon) {}

  [[nodiscard]] Point at(const Point& place, const ProbeInput& probe) const {
    const auto displacement = interpolation_.at(place);
    if (!displacement)
      throw InputError(probe.at, fmt::format("probe {}: there is no material at ({:g}, {:g}, {:g}) m",
                                             probe.name, place[0], place[1], place[2]));
    return *displacement;
  }

 private:
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

Probes::Probes(const Simulation& simulation) : simulation_(simulation) {
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
  if (probe.kind == "nominal-stress" && Simulation::face(probe.on.text)) vector(probe.name, "Pa");
  if (probe.kind == "nominal-stress" && !Simulation::face(probe.on.text))
    for (const char* component : {"_xx", "_xy", "_yx", "_yy"})
      columns_.push_back({probe.name + component, "Pa"});
  if (probe.kind == "displacement") vector("displacement_" + probe.name, "m");
  if (probe.kind == "stretch") columns_.push_back({probe.name, ""});
  if (probe.kind == "impactor") {
    vector(probe.name + "_position", "m");
    vector(probe.name + "_velocity", "m/s");
    vector(probe.name + "_force", "N");
  }
}

std::vector<double> Probes::evaluate(const State& state, const Constraints& constraints) const {
  const auto dimension = static_cast<std::size_t>(simulation_.body->dimension);
  std::optional<DisplacementField> field;
  for (const ProbeInput& probe : simulation_.input.probes)
    if (!field && (probe.kind == "displacement" || probe.kind == "stretch"))
      field.emplace(simulation_, state.u);
  std::vector<double> values;
  for (const ProbeInput& probe : simulation_.input.probes) {
    const auto add = [&](const Point& vector, double divisor) {
      for (std::size_t a = 0; a < dimension; ++a)
        if (probe.component.empty() || axis_of(probe) == a) values.push_back(vector[a] / divisor);
    };
    const auto face = Simulation::face(probe.on.text);
    if (probe.kind == "reaction")
      add(face ? constraints.reaction(*face) : reaction_of(simulation_.set(probe.on.text), constraints), 1);
    if (probe.kind == "nominal-stress" && face)
      add(constraints.reaction(*face), simulation_.body->face_area(*face));
    if (probe.kind == "nominal-stress" && !face) {
      const std::array<double, 9> stress = mean_stress(simulation_.set(probe.on.text), state.u);
      values.insert(values.end(), {stress[0], stress[1], stress[3], stress[4]});
    }
    if (probe.kind == "displacement") add(field->at(*probe.position, probe), 1);
    if (probe.kind == "stretch")
      values.push_back(distance_between(moved(*probe.from, field->at(*probe.from, probe)),
                                        moved(*probe.to, field->at(*probe.to, probe))) /
                       distance_between(*probe.from, *probe.to));
    if (probe.kind == "impactor")
      for (const Point& vector : impactor_of(probe, state)) add(vector, 1);
  }
  return values;
}

/// Position (m) and velocity (m/s) of an impactor, and the force (N) of the body on it.
std::array<Point, 3> Probes::impactor_of(const ProbeInput& probe, const State& state) const {
  const std::vector<ImpactorInput>& inputs = simulation_.input.impactors;
  const auto found = std::find_if(inputs.begin(), inputs.end(),
                                  [&](const ImpactorInput& in) { return in.name == probe.impactor; });
  const auto n = static_cast<std::size_t>(found - inputs.begin());
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
