#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "load/mirror.hpp"
#include "simulation/build_parts.hpp"

namespace riven {

namespace {

constexpr std::size_t kFaces = 6;

LoadFunction make_function(const Expression& expression, Parameter parameter) {
  if (parameter == Parameter::time)
    return [expression](const Point& x, double t) { return expression(Variables{.position = x, .t = t}); };
  return [expression](const Point& x, double stretch) {
    return expression(Variables{.position = x, .stretch = stretch});
  };
}

/// Turns loads into constraints on the state of the model.
class LoadBuilder {
 public:
  LoadBuilder(Simulation& simulation, const PointModel* points)
      : simulation_(simulation),
        points_(points),
        body_(*simulation.body),
        mesh_(simulation.mesh),
        loaded_(simulation.model->dofs(), false) {}

  void build() {
    for (const LoadInput& load : simulation_.input.loads) {
      if (load.is_force()) {
        apply_force(load);
        continue;
      }
      for (const Named& on : load.on) {
        if (const auto face = simulation_.edge(on.text)) {
          displace_face(load, *face, on);
        } else {
          displace_set(load, on);
        }
      }
    }
    for (auto& [entry, constraint] : of_nodes_) simulation_.constraints->add(std::move(constraint));
    for (std::size_t face = 0; face < kFaces; ++face) check_face(face);
    add_mirror_constraints(body_, faces_, simulation_.model->conservative(), *simulation_.constraints);
    hold_fixed_inclusions();
  }

 private:
  void apply_force(const LoadInput& load) {
    for (const Named& on : load.on)
      if (const auto face = simulation_.edge(on.text))
        load.pressure ? press_face(load, *face, on) : pull_face(load, *face, on);
      else
        act_on(load, simulation_.set(on.text));
    if (!load.on.empty()) return;
    PointSet all{.name = "", .points = std::vector<std::size_t>(body_.points.size())};
    std::iota(all.points.begin(), all.points.end(), std::size_t{0});
    if (mesh_ != nullptr) {
      all.elements.resize(mesh_->elements());
      std::iota(all.elements.begin(), all.elements.end(), std::size_t{0});
    }
    act_on(load, all);
  }

  void pull_face(const LoadInput& load, std::size_t face, const Named& on) {
    if (!pulled_.insert(face).second)
      throw InputError(on.at, fmt::format("load: the edge \"{}\" has two tractions; expected one", on.text));
    if (mesh_ != nullptr)
      return add_force(load, {face, on.text, nullptr}, shares_of(mesh_->face_shares(face)));
    const double layer = load.layer.value_or(body_.spacing);
    std::vector<LoadShare> shares = edge_shares(body_, face, layer);
    if (shares.empty())
      throw InputError(on.at,
                       fmt::format("load: no point of the body lies within {:g} m of the edge \"{}\" at "
                                   "{} = {:g} m; expected a larger layer",
                                   layer, on.text, "xyz"[face / 2], body_.faces[face]));
    add_force(load, {face, on.text, nullptr}, std::move(shares));
  }

  void press_face(const LoadInput& load, std::size_t face, const Named& on) {
    if (!pressed_.insert(face).second)
      throw InputError(on.at, fmt::format("load: the edge \"{}\" has two pressures; expected one", on.text));
    if (face >= mesh_->face.size() && mesh_->group[face - mesh_->face.size()].inside)
      throw InputError(on.at,
                       fmt::format("load: the edge \"{}\" lies inside the body, and a pressure acts on its "
                                   "boundary; expected lines or faces with elements on one side only",
                                   on.text));
    std::vector<PressedSide> sides;
    for (const Side& side : mesh_->sides(face)) sides.push_back({side.node});
    const auto force = std::make_shared<FollowerPressure>(
        make_function(*load.pressure, simulation_.parameter), std::move(sides), mesh_->node,
        mesh_->dimension(), mesh_->thickness);
    simulation_.applied.push_back({face, on.text, nullptr, force});
    simulation_.external.push_back(force);
  }

  [[nodiscard]] std::vector<LoadShare> shares_of(const std::vector<NodeShare>& nodes) const {
    std::vector<LoadShare> shares;
    for (const NodeShare& share : nodes)
      shares.push_back({share.node, mesh_->node[share.node], share.extent});
    return shares;
  }

  void act_on(const LoadInput& load, const PointSet& set) {
    if (mesh_ != nullptr && set.elements.empty())
      throw InputError(load.at, fmt::format("load: the set \"{}\" holds no element, and a body force acts on "
                                            "elements; expected a set with the centres of some",
                                            set.name));
    if (mesh_ != nullptr)
      return add_force(load, {std::nullopt, set.name, nullptr},
                       shares_of(mesh_->volume_shares(set.elements)));
    std::vector<LoadShare> shares;
    for (const std::size_t number : set.points) {
      const std::size_t point = body_.points[number];
      shares.push_back({point, body_.position(point), body_.volume[point]});
    }
    add_force(load, {std::nullopt, set.name, nullptr}, std::move(shares));
  }

  void add_force(const LoadInput& load, AppliedForce applied, std::vector<LoadShare> shares) {
    DistributedForce::Density density;
    for (std::size_t axis = 0; axis < load.components().size(); ++axis)
      if (const auto& value = load.components()[axis].value)
        density[axis] = make_function(*value, simulation_.parameter);
    const auto force =
        std::make_shared<DistributedForce>(std::move(density), std::move(shares), body_.size());
    applied.force = force;
    simulation_.applied.push_back(std::move(applied));
    simulation_.external.push_back(force);
  }

  void displace_face(const LoadInput& load, std::size_t face, const Named& on) {
    if (mesh_ != nullptr) {
      const std::vector<std::uint32_t> nodes = mesh_->nodes_on(face);
      return displace_nodes(load, {nodes.begin(), nodes.end()}, face, on);
    }
    if (!faces_[face]) faces_[face] = FaceLoad{.displacement = {}, .load = face};
    face_at_[face] = on.at;
    for (std::size_t axis = 0; axis < load.components().size(); ++axis) {
      const auto& value = load.components()[axis].value;
      if (!value) continue;
      auto& given = faces_[face]->displacement[axis];
      if (given)
        throw InputError(
            on.at, fmt::format("load: the edge \"{}\" is displaced twice along {}", on.text, "xyz"[axis]));
      given = make_function(*value, simulation_.parameter);
      faces_[face]->rate[axis] = !load.velocity.empty();
    }
  }

  /// A node may be on two edges: what they prescribe must agree.
  void displace_nodes(const LoadInput& load, const std::vector<std::size_t>& nodes, std::size_t number,
                      const Named& on) {
    for (std::size_t axis = 0; axis < load.components().size(); ++axis) {
      const auto& value = load.components()[axis].value;
      if (!value) continue;
      const LoadFunction function = make_function(*value, simulation_.parameter);
      for (const std::size_t node : nodes) {
        Constraint& constraint = of_nodes_[simulation_.entry(axis, node)];
        constraint.slave = simulation_.entry(axis, node);
        constraint.terms.push_back(
            {function, mesh_->node[node], static_cast<int>(axis), 1, number, !load.velocity.empty()});
        check_agreement(constraint, on);
        share_out(constraint);
      }
    }
  }

  /// Whose reaction the force on a node is: that of the edge across the component, which then has its own
  /// section force, or of all that prescribe it alike.
  void share_out(Constraint& constraint) const {
    const auto is_across = [this](const PrescribedTerm& term) {
      return term.load < mesh_->edges() &&
             mesh_->axis_across(term.load) == static_cast<std::size_t>(term.axis);
    };
    const auto across = std::count_if(constraint.terms.begin(), constraint.terms.end(), is_across);
    const double share = 1.0 / static_cast<double>(across > 0 ? across : std::ssize(constraint.terms));
    for (PrescribedTerm& term : constraint.terms) term.factor = across == 0 || is_across(term) ? share : 0;
  }

  void check_agreement(const Constraint& constraint, const Named& on) const {
    const SolverInput& solver = simulation_.input.solver;
    const bool in_time = simulation_.parameter == Parameter::time;
    const double start = in_time ? 0 : 1, end = in_time ? solver.until : solver.stretch.back();
    const PrescribedTerm &one = constraint.terms.front(), &other = constraint.terms.back();
    bool agree = one.rate == other.rate;
    for (const double part : {0.0, 0.37, 1.0}) {
      const double at = start + part * (end - start), a = one.displacement(one.position, at),
                   b = other.displacement(other.position, at);
      agree = agree && !(std::abs(a - b) > 1e-9 * std::max(std::abs(a), std::abs(b)));
    }
    if (agree) return;
    const Point& x = one.position;
    throw InputError(
        on.at, fmt::format("load: \"{}\" displaces the node at ({:.4g}, {:.4g}, {:.4g}) m along {}, and "
                           "another load does so differently; expected equal displacements where parts "
                           "meet, or \"free\"",
                           on.text, x[0], x[1], x[2], "xyz"[one.axis]));
  }

  /// Mirror layers hold the normal component; a tangential one alone would hold the edge's normal strain at
  /// zero.
  void check_face(std::size_t face) const {
    if (!faces_[face]) return;
    if (pulled_.contains(face))
      throw InputError(face_at_[face],
                       fmt::format("load: the edge \"{}\" has a traction and is moved too; expected one of "
                                   "both, or a set of points to be moved",
                                   kFaceNames[face]));
    const bool holds = std::any_of(body_.ghosts.begin(), body_.ghosts.end(),
                                   [&](const GhostPoint& ghost) { return ghost.faces.test(face); });
    if (!holds)
      throw InputError(
          face_at_[face],
          fmt::format("load: no point of the body lies within a horizon of the edge \"{}\" at {} = {:g} m; "
                      "the load would move nothing",
                      kFaceNames[face], "xyz"[face / 2], body_.faces[face]));
    if (!faces_[face] || faces_[face]->displacement[face / 2]) return;
    throw InputError(
        face_at_[face],
        fmt::format("load: the edge \"{}\" is displaced along itself only; expected its normal component too "
                    "(entry {} of displacement), or a set of points instead of the edge",
                    kFaceNames[face], face / 2 + 1));
  }

  void displace_set(const LoadInput& load, const Named& on) {
    const PointSet& set = simulation_.set(on.text);
    if (mesh_ != nullptr) return displace_nodes(load, set.points, simulation_.edges(), on);
    for (std::size_t axis = 0; axis < load.components().size(); ++axis) {
      const auto& value = load.components()[axis].value;
      if (!value) continue;
      const LoadFunction function = make_function(*value, simulation_.parameter);
      for (const std::size_t point : set.points) {
        const std::size_t dof = simulation_.entry(axis, point);
        if (loaded_[dof])
          throw InputError(
              on.at, fmt::format("load: points of \"{}\" are displaced twice; expected sets without common "
                                 "points, or other components free",
                                 on.text));
        loaded_[dof] = true;
        simulation_.constraints->add(
            {.slave = dof,
             .terms = {{function, body_.position(body_.points[point]), static_cast<int>(axis), 1, kFaces,
                        !load.velocity.empty()}}});
      }
    }
  }

  void hold_fixed_inclusions() {
    for (std::size_t n = 0; n < simulation_.input.inclusions.size(); ++n) {
      if (simulation_.input.inclusions[n].motion != "fixed") continue;
      for (std::size_t d = 0; d < 3; ++d) {
        Constraint constraint{.slave = points_->inclusion_dof(n) + d, .terms = {}};
        if (d < 2)
          constraint.terms.push_back(
              {[](const Point&, double) { return 0.0; }, Point{}, static_cast<int>(d), 1, kFaces});
        simulation_.constraints->add(std::move(constraint));
      }
    }
  }

  Simulation& simulation_;
  const PointModel* points_;
  const Body& body_;
  const MeshBody* mesh_;
  std::array<std::optional<FaceLoad>, kFaces> faces_;
  std::array<Location, kFaces> face_at_;
  std::set<std::size_t> pulled_, pressed_;      // edges with a traction, a pressure
  std::vector<bool> loaded_;                    // entries that a set's load has taken
  std::map<std::size_t, Constraint> of_nodes_;  // of a mesh, by entry
};

/// Fills the initial state of the body's points. What is prescribed comes from the loads when the run starts.
class InitialBuilder {
 public:
  InitialBuilder(Simulation& simulation, std::size_t dofs)
      : simulation_(simulation), displaced_(dofs, false), moving_(dofs, false) {}

  void build() {
    for (const InitialInput& initial : simulation_.input.initials) {
      check_inclusions(initial);
      for (const std::vector<std::size_t>& points : points_of(initial)) {
        fill(initial, "displacement", initial.displacement, points, simulation_.initial_u, displaced_);
        fill(initial, "velocity", initial.velocity, points, simulation_.initial_v, moving_);
      }
    }
  }

 private:
  /// An inclusion would stay behind the body around it.
  void check_inclusions(const InitialInput& initial) const {
    const auto& inclusions = simulation_.input.inclusions;
    const bool free = std::any_of(inclusions.begin(), inclusions.end(),
                                  [](const InclusionInput& inclusion) { return inclusion.motion == "free"; });
    if (initial.on.empty() && free)
      throw InputError(
          initial.at,
          "initial: the body has inclusions that are free to move, and they start at rest; expected "
          "`on` with the points that do not, or inclusions with motion = \"fixed\"");
  }

  [[nodiscard]] std::vector<std::vector<std::size_t>> points_of(const InitialInput& initial) const {
    std::vector<std::vector<std::size_t>> lists;
    for (const Named& on : initial.on) lists.push_back(simulation_.set(on.text).points);
    if (!lists.empty()) return lists;
    lists.emplace_back(simulation_.body->points.size());
    std::iota(lists.front().begin(), lists.front().end(), std::size_t{0});
    return lists;
  }

  void fill(const InitialInput& initial, const char* what, const std::vector<ComponentInput>& components,
            const std::vector<std::size_t>& points, std::vector<double>& state, std::vector<bool>& given) {
    for (std::size_t axis = 0; axis < components.size(); ++axis) {
      if (!components[axis].value) continue;
      state.resize(given.size());
      for (const std::size_t point : points) {
        const std::size_t entry = simulation_.entry(axis, point);
        if (given[entry])
          throw InputError(
              initial.at,
              fmt::format("initial: component {} of the {} is given twice for the point at ({:.4g}, "
                          "{:.4g}, {:.4g}) m; expected sets without common points, or other "
                          "components \"free\"",
                          axis, what, place(point)[0], place(point)[1], place(point)[2]));
        given[entry] = true;
        state[entry] = (*components[axis].value)(Variables{.position = place(point)});
        if (!std::isfinite(state[entry]))
          throw InputError(
              initial.at,
              fmt::format("initial: component {} of the {} is no finite number at ({:.4g}, {:.4g}, "
                          "{:.4g}) m",
                          axis, what, place(point)[0], place(point)[1], place(point)[2]));
      }
    }
  }

  [[nodiscard]] Point place(std::size_t point) const {
    return simulation_.body->position(simulation_.body->points[point]);
  }

  Simulation& simulation_;
  std::vector<bool> displaced_, moving_;  // entries that are given already
};

}  // namespace

void build_loads(Simulation& simulation, const PointModel* points) {
  LoadBuilder(simulation, points).build();
}

void build_initial(Simulation& simulation, std::size_t dofs) {
  InitialBuilder(simulation, dofs).build();
}

}  // namespace riven
