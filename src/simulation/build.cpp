#include <fmt/format.h>

#include <algorithm>

#include "base/machine.hpp"
#include "simulation/build_parts.hpp"
#include "simulation/estimate.hpp"

namespace riven {

std::optional<std::size_t> Simulation::face(const std::string& name) {
  const auto found = std::find(kFaceNames.begin(), kFaceNames.end(), name);
  if (found == kFaceNames.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kFaceNames.begin());
}

std::optional<std::size_t> Simulation::edge(const std::string& name) const {
  if (mesh == nullptr) return face(name);
  for (std::size_t group = 0; group < mesh->group.size(); ++group)
    if (mesh->group[group].name == name) return mesh->face.size() + group;
  // A group of the mesh may have the name of a face.
  const bool is_set =
      std::any_of(sets.begin(), sets.end(), [&](const PointSet& s) { return s.name == name; });
  return is_set ? std::nullopt : face(name);
}

const PointSet& find_set(const std::vector<PointSet>& sets, const std::string& name) {
  const auto found =
      std::find_if(sets.begin(), sets.end(), [&](const PointSet& s) { return s.name == name; });
  if (found == sets.end()) throw InputError(fmt::format("no set is called \"{}\"", name));
  return *found;
}

const PointSet& Simulation::set(const std::string& name) const {
  return find_set(sets, name);
}

std::size_t Simulation::entry(std::size_t axis, std::size_t number) const {
  return axis * body->size() + body->points[number];
}

namespace {

/// Points, sets and model of a case with a peridynamic model.
const PointModel* build_points(Simulation& simulation) {
  const Case& input = simulation.input;
  Body body = make_body(input);
  for (const SetInput& set : input.sets) simulation.sets.push_back(make_set(set, input, body));
  mark_points(input, simulation.sets, body);
  auto model = make_model(input, std::move(body));
  const PointModel* points = model.get();
  simulation.body = &points->body();
  simulation.model = with_contact(input, std::move(model), simulation.contact);
  return points;
}

}  // namespace

Simulation build_simulation(const Case& input) {
  check_memory(input, available_memory());
  Simulation simulation;
  simulation.input = input;
  simulation.parameter = input.solver.in_time() ? Parameter::time : Parameter::stretch;
  const PointModel* points = nullptr;
  if (input.geometry.elements)
    build_elements(simulation);
  else
    points = build_points(simulation);
  simulation.constraints = std::make_unique<Constraints>(simulation.model->dofs(), simulation.edges() + 1);
  build_loads(simulation, points);
  build_initial(simulation, simulation.model->dofs());
  build_impactors(simulation);
  return simulation;
}

}  // namespace riven
