#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulation/build_parts.hpp"
#include "simulation/way.hpp"

namespace riven {

namespace {

constexpr std::size_t kHeld = 6;  // where reactions of what is held are collected

Impactor make_impactor(const ImpactorInput& in, double stiffness) {
  Impactor impactor{.name = in.name, .shape = {}, .mass = in.mass, .stiffness = in.stiffness * stiffness};
  if (in.sphere)
    impactor.shape = RigidSphere{in.sphere->center, in.sphere->radius};
  else
    impactor.shape = rigid_plane(*in.plane);
  return impactor;
}

void check_finite(const ImpactorInput& in, double value) {
  if (!std::isfinite(value))
    throw InputError(in.at, fmt::format("impactor {}: its velocity is no finite number", in.name));
}

/// Its way is a prescribed displacement, as that of points on which a load acts.
void prescribe(const ImpactorInput& in, const Point& place, std::size_t axis, std::size_t entry,
               Simulation& simulation) {
  LoadFunction way = [](const Point&, double) { return 0.0; };
  if (!in.velocity.empty()) {
    const Way integral(*in.velocity[axis].value, place, simulation.input.solver.until);
    check_finite(in, integral(simulation.input.solver.until));
    way = [integral](const Point&, double time) { return integral(time); };
  }
  simulation.constraints->add({.slave = entry, .terms = {{way, place, static_cast<int>(axis), 1, kHeld}}});
}

void start(const ImpactorInput& in, const Point& place, std::size_t axis, std::size_t entry,
           Simulation& simulation) {
  if (in.velocity.empty()) return;
  simulation.initial_v.resize(simulation.model->dofs());
  simulation.initial_v[entry] = (*in.velocity[axis].value)(Variables{.position = place});
  check_finite(in, simulation.initial_v[entry]);
}

/// What overlaps at the start would fly apart.
void check_start(const ImpactorInput& in, const Impactor& impactor, const Simulation& simulation) {
  const Body& body = *simulation.body;
  double deepest = 0;
  Point where{};
  for (const std::size_t i : body.points) {
    Point at = body.position(i);
    for (std::size_t d = 0; d < static_cast<std::size_t>(body.dimension) && !simulation.initial_u.empty();
         ++d)
      at[d] += simulation.initial_u[d * body.size() + i];
    const double depth = depth_of(impactor, {}, at, 0.5 * body.spacing).value;
    if (depth <= deepest) continue;
    deepest = depth;
    where = at;
  }
  if (deepest > 1e-6 * body.spacing)
    throw InputError(
        in.at,
        fmt::format("impactor {}: reaches {:.4g} m into the body at the start, at the point at ({:.4g}, "
                    "{:.4g}, {:.4g}) m, whose cell is half a spacing thick all around; expected a place "
                    "outside, from which it moves in",
                    in.name, deepest, where[0], where[1], where[2]));
}

}  // namespace

RigidPlane rigid_plane(const PlaneInput& in) {
  RigidPlane plane{in.point, {}};
  double square = 0;
  for (const double n : in.normal) square += n * n;
  for (std::size_t d = 0; d < in.normal.size(); ++d) plane.normal[d] = in.normal[d] / std::sqrt(square);
  return plane;
}

std::unique_ptr<Model> with_contact(const Case& in, std::unique_ptr<PointModel> model,
                                    const ContactModel*& contact) {
  if (!in.contact && in.impactors.empty()) return model;
  const Body& body = model->body();
  const ContactStiffness stiffness = contact_stiffness(*model, body);
  std::optional<SelfContactSettings> self;
  if (in.contact)
    self = SelfContactSettings{in.contact->distance, in.contact->stiffness * stiffness.per_pair};
  std::vector<Impactor> impactors;
  for (const ImpactorInput& impactor : in.impactors)
    impactors.push_back(make_impactor(impactor, stiffness.per_volume));
  auto with = std::make_unique<ContactModel>(std::move(model), body, self, std::move(impactors));
  contact = with.get();
  return with;
}

void build_impactors(Simulation& simulation) {
  if (simulation.mesh != nullptr) return build_indenters(simulation);
  for (std::size_t n = 0; n < simulation.input.impactors.size(); ++n) {
    const ImpactorInput& in = simulation.input.impactors[n];
    const Impactor& impactor = simulation.contact->impactors()[n];
    check_start(in, impactor, simulation);
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(simulation.body->dimension); ++axis)
      (in.mass ? start : prescribe)(in, impactor.start(), axis, simulation.contact->impactor_entry(n) + axis,
                                    simulation);
  }
}

}  // namespace riven
