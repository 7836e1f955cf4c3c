#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "simulation/build_parts.hpp"
#include "simulation/way.hpp"

namespace riven {

namespace {

using Eigen::Vector3d;

// A side faces an indenter that it sees at less than 84 degrees from its normal.
constexpr double kFacing = 0.1;
constexpr double kFade = 0.25;  // of a spacing: beyond the ends of a flat
// Of a spacing at stiffness 1: no pressure that a body stands makes nodes as deep as that.
constexpr double kDeepest = 0.1;

IndenterShape shape_of(const ImpactorInput& in, double spacing) {
  if (in.sphere) return RigidSphere{in.sphere->center, in.sphere->radius};
  if (in.flat) return RigidFlat{in.flat->from, in.flat->to, kFade * spacing};
  return rigid_plane(*in.plane);
}

/// Direction from a place to where an indenter comes from.
Vector3d towards(const ImpactorInput& in, const Vector3d& place) {
  if (in.sphere) return (Vector3d(in.sphere->center.data()) - place).normalized();
  if (in.plane) return -Vector3d(rigid_plane(*in.plane).normal.data());
  const Vector3d along = Vector3d(in.flat->to.data()) - Vector3d(in.flat->from.data());
  return Vector3d(-along.y(), along.x(), 0).normalized();
}

/// Corners of sides go round so that this points out of the body.
Vector3d outward(const Side& side, const MeshBody& mesh) {
  const auto x = [&](std::size_t a) { return Vector3d(mesh.node[side.node[a]].data()); };
  if (mesh.dimension() == 3) return (x(1) - x(0)).cross(x(2) - x(0)).normalized();
  const Vector3d along = x(1) - x(0);
  return Vector3d(along.y(), -along.x(), 0).normalized();
}

/// Sides that belong to one element.
std::vector<Side> outer_sides(const MeshBody& mesh) {
  return with_element(mesh.shape, [&]<class E>(E) {
    std::map<std::vector<std::uint32_t>, std::optional<Side>> found;  // nothing: of two
    for (std::size_t e = 0; e < mesh.elements(); ++e)
      for (const auto& corners : E::sides) {
        Side side;
        for (const int a : corners) side.node.push_back(mesh.nodes(e)[static_cast<std::size_t>(a)]);
        std::vector<std::uint32_t> key = side.node;
        std::sort(key.begin(), key.end());
        const auto [at, is_new] = found.emplace(std::move(key), std::move(side));
        if (!is_new) at->second.reset();
      }
    std::vector<Side> outer;
    for (auto& [key, side] : found)
      if (side) outer.push_back(std::move(*side));
    return outer;
  });
}

/// Nodes of the sides that an indenter may push, with their areas.
std::vector<LoadShare> surface_of(const ImpactorInput& in, const MeshBody& mesh) {
  MeshBody facing{
      .shape = mesh.shape, .thickness = mesh.thickness, .node = mesh.node, .corner = {}, .material = {}};
  for (const Side& side : outer_sides(mesh)) {
    const Vector3d middle =
        0.5 * (Vector3d(mesh.node[side.node[0]].data()) + Vector3d(mesh.node[side.node[1]].data()));
    if (outward(side, mesh).dot(towards(in, middle)) > kFacing) facing.face[0].push_back(side);
  }
  std::vector<LoadShare> surface;
  for (const NodeShare& share : facing.face_shares(0))
    surface.push_back({share.node, mesh.node[share.node], share.extent});
  if (surface.empty())
    throw InputError(in.at, fmt::format("impactor {}: no side of the mesh faces it; expected a place outside "
                                        "of the body",
                                        in.name));
  return surface;
}

/// What the elements at the surface hold against a displacement of their nodes, per area (N/m^3).
double stiffness_at(const std::vector<LoadShare>& surface, Model& model, std::size_t points, int dimension) {
  const std::vector<double> rest(model.dofs(), 0.0);
  std::vector<double> bound(model.dofs());
  model.stiffness_bound(rest, bound);
  double rows = 0, area = 0;
  for (const LoadShare& share : surface) {
    double largest = 0;
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
      largest = std::max(largest, bound[d * points + share.point]);
    rows += largest;
    area += share.extent;
  }
  return rows / area;
}

using Component = std::function<double(double parameter)>;

Component component_of(const ImpactorInput& in, std::size_t axis, const Point& place,
                       const Simulation& simulation) {
  if (!in.velocity.empty()) return Way(*in.velocity[axis].value, place, simulation.input.solver.until);
  if (in.displacement.empty()) return [](double) { return 0.0; };
  const Expression formula = *in.displacement[axis].value;
  if (simulation.parameter == Parameter::time)
    return [=](double t) { return formula(Variables{.position = place, .t = t}); };
  return [=](double stretch) { return formula(Variables{.position = place, .stretch = stretch}); };
}

std::function<Point(double)> way_of(const ImpactorInput& in, const Point& place,
                                    const Simulation& simulation) {
  std::vector<Component> components;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(simulation.body->dimension); ++axis)
    components.push_back(component_of(in, axis, place, simulation));
  return [components](double parameter) {
    Point moved{};
    for (std::size_t axis = 0; axis < components.size(); ++axis) moved[axis] = components[axis](parameter);
    return moved;
  };
}

void check_way(const Indenter& indenter, const ImpactorInput& in, const Simulation& simulation) {
  const SolverInput& solver = simulation.input.solver;
  const bool in_time = simulation.parameter == Parameter::time;
  const Point first = indenter.settings().way(in_time ? 0 : 1),
              last = indenter.settings().way(in_time ? solver.until : solver.stretch.back());
  for (const Point& moved : {first, last})
    if (!std::all_of(moved.begin(), moved.end(), [](double x) { return std::isfinite(x); }))
      throw InputError(in.at, fmt::format("impactor {}: its way is no finite number", in.name));
  if (std::any_of(first.begin(), first.end(), [](double x) { return x != 0; }))
    throw InputError(
        in.at,
        fmt::format("impactor {}: its displacement is ({:.4g}, {:.4g}, {:.4g}) m at {} already; expected "
                    "0 there: it starts where it is placed",
                    in.name, first[0], first[1], first[2], in_time ? "time 0" : "stretch 1"));
}

/// What overlaps at the start would fly apart.
void check_start(const Indenter& indenter, const ImpactorInput& in, const Simulation& simulation) {
  std::vector<double> u = simulation.initial_u;
  u.resize(simulation.model->dofs());
  const double start = simulation.parameter == Parameter::time ? 0 : 1;
  for (std::size_t n = 0; n < indenter.surface().size(); ++n) {
    const double depth = indenter.depth(n, u, start);
    const Point& at = indenter.surface()[n].position;
    if (depth > 1e-6 * simulation.body->spacing)
      throw InputError(
          in.at, fmt::format("impactor {}: reaches {:.4g} m into the body at the start, at the node at "
                             "({:.4g}, {:.4g}, {:.4g}) m; expected a place outside, from which it moves "
                             "in{}",
                             in.name, depth, at[0], at[1], at[2],
                             in.flat ? ", the body to the right of the way from `from` to `to`" : ""));
  }
}

}  // namespace

void build_indenters(Simulation& simulation) {
  const Body& body = *simulation.body;
  for (const ImpactorInput& in : simulation.input.impactors) {
    std::vector<LoadShare> surface = surface_of(in, *simulation.mesh);
    IndenterSettings settings{.name = in.name,
                              .shape = shape_of(in, body.spacing),
                              .sticking = in.surface == "sticking",
                              .spacing = body.spacing,
                              .deepest = kDeepest * body.spacing / in.stiffness};
    settings.stiffness = in.stiffness * stiffness_at(surface, *simulation.model, body.size(), body.dimension);
    settings.way = way_of(in, start_of(settings.shape), simulation);
    const auto indenter =
        std::make_shared<Indenter>(std::move(settings), std::move(surface), body.size(), body.dimension);
    check_way(*indenter, in, simulation);
    check_start(*indenter, in, simulation);
    simulation.indenters.push_back(indenter);
    simulation.external.push_back(indenter);
  }
}

}  // namespace riven
