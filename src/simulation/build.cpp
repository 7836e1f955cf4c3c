#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/machine.hpp"
#include "body/lattice_body.hpp"
#include "body/listed_body.hpp"
#include "load/mirror.hpp"
#include "peridynamics/bond_membrane.hpp"
#include "peridynamics/membrane.hpp"
#include "peridynamics/pmb.hpp"
#include "simulation/estimate.hpp"
#include "simulation/simulation.hpp"

namespace riven {

namespace {

constexpr std::size_t kFaces = 6;

InvariantLaw make_law(const MaterialInput& in) {
  if (in.law == "neo-hookean") {
    if (in.youngs_modulus) return NeoHookean{*in.youngs_modulus / 6};  // E = 3 mu, mu = 2 C10
    if (in.shear_modulus) return NeoHookean{*in.shear_modulus / 2};
    return NeoHookean{*in.c10};
  }
  if (in.law == "mooney-rivlin") return MooneyRivlin{*in.c10, *in.c01};
  return Yeoh{*in.c10, in.c20.value_or(0), in.c30.value_or(0)};
}

Material make_material(const MaterialInput& in) {
  Material material{in.name, make_law(in), in.density};
  if (!(shear_modulus(material.law) > 0))
    throw InputError(
        in.at, fmt::format("material.{}: the shear modulus is {:g} Pa; expected a law with a positive one",
                           in.name, shear_modulus(material.law)));
  return material;
}

/// Points of a shape's outline, close enough to tell whether it lies within a convex body.
std::vector<Point> outline(const Shape& shape) {
  std::vector<Point> points;
  if (const auto* box = std::get_if<Box>(&shape)) {
    for (const double x : {-1.0, 1.0})
      for (const double y : {-1.0, 1.0})
        points.push_back(
            {box->center[0] + x * box->half_size[0], box->center[1] + y * box->half_size[1], box->center[2]});
    return points;
  }
  const auto* disc = std::get_if<Disc>(&shape);
  const Point& center = disc != nullptr ? disc->center : std::get<Ball>(shape).center;
  const double radius = disc != nullptr ? disc->radius : std::get<Ball>(shape).radius;
  for (int n = 0; n < 360; ++n) {
    const double angle = n * std::numbers::pi / 180;
    points.push_back({center[0] + radius * std::cos(angle), center[1] + radius * std::sin(angle), center[2]});
  }
  return points;
}

/// A defect that the body does not hold is a slip of a sign or a unit.
void check_places(const Case& in, double touch) {
  const Shape& body = in.geometry.shape;
  for (const HoleInput& hole : in.holes)
    if (!overlap(hole.shape, body, touch))
      throw InputError(hole.at, "hole: lies outside of the body; expected one that cuts it");
  for (const CrackInput& crack : in.cracks)
    if (!chord(body, crack.segment.a, crack.segment.b, touch))
      throw InputError(crack.at, "crack: lies outside of the body; expected one that cuts it");
  for (const InclusionInput& inclusion : in.inclusions)
    for (const Point& point : outline(inclusion.shape))
      if (signed_distance(body, point) > touch)
        throw InputError(inclusion.at,
                         fmt::format("inclusion: reaches out of the body at ({:.4g}, {:.4g}) m; expected one "
                                     "inside it",
                                     point[0], point[1]));
}

Defects make_defects(const Case& in) {
  struct Placed {
    const Shape& shape;
    const Location& at;
  };
  Defects defects;
  std::vector<Placed> placed;
  for (const HoleInput& hole : in.holes) {
    defects.holes.push_back(hole.shape);
    placed.push_back({hole.shape, hole.at});
  }
  for (const InclusionInput& inclusion : in.inclusions) {
    defects.inclusions.push_back(inclusion.shape);
    placed.push_back({inclusion.shape, inclusion.at});
  }
  for (const CrackInput& crack : in.cracks) defects.cracks.push_back(crack.segment);
  const double touch = 1e-6 * in.geometry.spacing;
  check_places(in, touch);
  for (std::size_t a = 0; a < placed.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (overlap(placed[a].shape, placed[b].shape, touch))
        throw InputError(placed[a].at,
                         fmt::format("this shape overlaps the one at {}; expected holes and inclusions apart "
                                     "from each other",
                                     placed[b].at.text()));
  return defects;
}

/// Faces that some load displaces.
Faces loaded_faces(const Case& in) {
  Faces faces;
  for (const LoadInput& load : in.loads)
    for (const Named& name : load.on)
      if (const auto face = Simulation::face(name.text)) faces.set(*face);
  return faces;
}

/// A point on a loaded edge would be its own mirror image.
void check_off_loaded_faces(const PointList& points, double spacing, const ListedBodyInput& body) {
  constexpr double kOnFace = 0.01;  // spacings
  for (std::size_t face = 0; face < kFaces; ++face)
    for (std::size_t n = 0; n < points.position.size() && body.mirrored.test(face); ++n)
      if (std::abs(points.position[n][face / 2] - body.faces[face]) < kOnFace * spacing)
        throw InputError(points.at(n),
                         fmt::format("the point lies on the edge \"{}\", which has a load; expected points "
                                     "inside, such as the centres of cells",
                                     kFaceNames[face]));
}

Body make_points_body(const Case& in) {
  const GeometryInput& geometry = in.geometry;
  const PointList& points = *geometry.points->list;
  const auto& box = std::get<Box>(geometry.shape);
  ListedBodyInput listed{.dimension = geometry.dimension,
                         .position = points.position,
                         .volume = points.volume,
                         .thickness = geometry.thickness,
                         .horizon = geometry.horizon,
                         .faces = {},
                         .defects = make_defects(in),
                         .mirrored = loaded_faces(in)};
  for (std::size_t face = 0; face < 2 * static_cast<std::size_t>(geometry.dimension); ++face)
    listed.faces[face] = box.center[face / 2] + (face % 2 == 0 ? -1 : 1) * box.half_size[face / 2];
  check_off_loaded_faces(points, geometry.spacing, listed);
  return make_listed_body(listed);
}

Body make_body(const Case& in) {
  const GeometryInput& geometry = in.geometry;
  try {
    if (geometry.points) return make_points_body(in);
    Body body = make_lattice_body({.dimension = geometry.dimension,
                                   .shape = geometry.shape,
                                   .thickness = geometry.thickness,
                                   .spacing = geometry.spacing,
                                   .horizon = geometry.horizon,
                                   .defects = make_defects(in),
                                   .mirrored = loaded_faces(in)});
    return geometry.bonds == "listed" ? listed(body) : body;
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.starts_with(in.file.string())) throw;
    throw InputError(geometry.at, "geometry: " + what);
  }
}

PointSet make_set(const SetInput& in, const Body& body) {
  PointSet set{in.name, {}};
  const double touch = 1e-9 * body.spacing;
  for (std::size_t n = 0; n < body.points.size(); ++n) {
    const Point x = body.position(body.points[n]);
    const bool inside =
        in.where ? (*in.where)(Variables{.position = x}) != 0 : signed_distance(*in.shape, x) <= touch;
    if (inside) set.points.push_back(n);
  }
  if (set.points.empty())
    throw InputError(
        in.at, fmt::format("set.{}: the set is empty; expected at least one of the body's {} points in it",
                           in.name, body.points.size()));
  return set;
}

LoadFunction make_function(const Expression& expression, Parameter parameter) {
  if (parameter == Parameter::time)
    return [expression](const Point& x, double t) { return expression(Variables{.position = x, .t = t}); };
  return [expression](const Point& x, double stretch) {
    return expression(Variables{.position = x, .stretch = stretch});
  };
}

BondMembraneSettings bond_settings(const ModelInput& in) {
  Loading loading = Loading::equibiaxial;
  if (in.loading == "planar") loading = Loading::planar;
  if (in.loading == "uniaxial") loading = Loading::uniaxial;
  if (in.loading == "uniaxial-compression") loading = Loading::uniaxial_compression;
  return {loading, in.variant == "zero-residual", in.surface_correction == "on"};
}

PmbSettings pmb_settings(const Case& in) {
  const MaterialInput& material = in.materials.front();
  if (material.critical_stretch && in.solver.method != "verlet")
    throw InputError(
        material.at,
        fmt::format("material.{}.critical_stretch: bonds break in motion only; expected method = "
                    "\"verlet\" in [solver], or no critical_stretch",
                    material.name));
  PmbSettings settings{.youngs_modulus = *material.youngs_modulus, .density = material.density};
  if (material.critical_stretch) settings.critical_stretch = *material.critical_stretch;
  settings.plane = in.model.plane == "strain" ? Plane::strain : Plane::stress;
  return settings;
}

/// Poisson's ratio is the model's; one that the user gave must be it.
void check_poissons_ratio(const MaterialInput& in, const Pmb& model) {
  constexpr double kRounded = 0.005;  // 0.33 for 1/3
  if (model.body().dimension == 1 || !in.poissons_ratio) return;
  if (std::abs(*in.poissons_ratio - model.poissons_ratio()) <= kRounded) return;
  throw InputError(in.at,
                   fmt::format("material.{}.poissons_ratio: found {:g}; the model \"pmb\" has {:.4g} here "
                               "(1/3 in plane stress, 1/4 otherwise)",
                               in.name, *in.poissons_ratio, model.poissons_ratio()));
}

std::unique_ptr<PointModel> make_pmb(const Case& in, Body body) {
  if (!in.inclusions.empty())
    throw InputError(in.inclusions.front().at,
                     "inclusion: the model \"pmb\" has no rigid inclusions; expected holes and cracks only");
  auto model = std::make_unique<Pmb>(std::move(body), pmb_settings(in));
  check_poissons_ratio(in.materials.front(), *model);
  return model;
}

/// Springs take the one law, membranes the others.
void check_law(const Case& in) {
  const MaterialInput& material = in.materials.front();
  const bool springs = in.model.kind == "pmb", elastic = material.law == "linear-elastic";
  if (springs != elastic)
    throw InputError(material.at,
                     fmt::format("material.{}.law: the model \"{}\" has no law \"{}\"; expected {}",
                                 material.name, in.model.kind, material.law,
                                 springs ? "\"linear-elastic\"" : "neo-hookean, mooney-rivlin or yeoh"));
}

std::unique_ptr<PointModel> make_model(const Case& in, Body body) {
  check_law(in);
  if (in.model.kind == "pmb") return make_pmb(in, std::move(body));
  const Material material = make_material(in.materials.front());
  try {
    if (in.model.kind == "membrane-bond")
      return std::make_unique<BondMembrane>(std::move(body), material, bond_settings(in.model));
    return std::make_unique<Membrane>(std::move(body), material, in.model.stabilisation);
  } catch (const InputError& error) {
    throw InputError(in.model.at, std::string("model: ") + error.what());
  }
}

/// Turns loads into constraints on the state of the model.
class LoadBuilder {
 public:
  LoadBuilder(Simulation& simulation, const PointModel& model)
      : simulation_(simulation), model_(model), body_(model.body()), loaded_(model.dofs(), false) {}

  void build() {
    for (const LoadInput& load : simulation_.input.loads)
      for (const Named& on : load.on) {
        if (const auto face = Simulation::face(on.text)) {
          displace_face(load, *face, on);
        } else {
          displace_set(load, on);
        }
      }
    for (std::size_t face = 0; face < kFaces; ++face) check_face(face);
    add_mirror_constraints(body_, faces_, model_.conservative(), *simulation_.constraints);
    hold_fixed_inclusions();
  }

 private:
  void displace_face(const LoadInput& load, std::size_t face, const Named& on) {
    if (!faces_[face]) faces_[face] = FaceLoad{.displacement = {}, .load = face};
    face_at_[face] = on.at;
    for (std::size_t axis = 0; axis < load.displacement.size(); ++axis) {
      const auto& value = load.displacement[axis].value;
      if (!value) continue;
      auto& given = faces_[face]->displacement[axis];
      if (given)
        throw InputError(
            on.at, fmt::format("load: the edge \"{}\" is displaced twice along {}", on.text, "xyz"[axis]));
      given = make_function(*value, simulation_.parameter);
    }
  }

  /// Mirror layers hold the normal component; a tangential one alone would hold the edge's normal strain at
  /// zero.
  void check_face(std::size_t face) const {
    if (!faces_[face]) return;
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
    for (std::size_t axis = 0; axis < load.displacement.size(); ++axis) {
      const auto& value = load.displacement[axis].value;
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
             .terms = {{function, body_.position(body_.points[point]), static_cast<int>(axis), 1, kFaces}}});
      }
    }
  }

  void hold_fixed_inclusions() {
    for (std::size_t n = 0; n < simulation_.input.inclusions.size(); ++n) {
      if (simulation_.input.inclusions[n].motion != "fixed") continue;
      for (std::size_t d = 0; d < 3; ++d) {
        Constraint constraint{.slave = model_.inclusion_dof(n) + d, .terms = {}};
        if (d < 2)
          constraint.terms.push_back(
              {[](const Point&, double) { return 0.0; }, Point{}, static_cast<int>(d), 1, kFaces});
        simulation_.constraints->add(std::move(constraint));
      }
    }
  }

  Simulation& simulation_;
  const PointModel& model_;
  const Body& body_;
  std::array<std::optional<FaceLoad>, kFaces> faces_;
  std::array<Location, kFaces> face_at_;
  std::vector<bool> loaded_;  // entries that a set's load has taken
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

std::optional<std::size_t> Simulation::face(const std::string& name) {
  const auto found = std::find(kFaceNames.begin(), kFaceNames.end(), name);
  if (found == kFaceNames.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kFaceNames.begin());
}

const PointSet& Simulation::set(const std::string& name) const {
  const auto found =
      std::find_if(sets.begin(), sets.end(), [&](const PointSet& s) { return s.name == name; });
  if (found == sets.end()) throw InputError(fmt::format("no set is called \"{}\"", name));
  return *found;
}

std::size_t Simulation::entry(std::size_t axis, std::size_t number) const {
  return axis * body->size() + body->points[number];
}

Simulation build_simulation(const Case& input) {
  check_memory(input, available_memory());
  Simulation simulation;
  simulation.input = input;
  simulation.parameter = input.solver.method == "verlet" ? Parameter::time : Parameter::stretch;
  Body body = make_body(input);
  for (const SetInput& set : input.sets) simulation.sets.push_back(make_set(set, body));
  auto model = make_model(input, std::move(body));
  simulation.body = &model->body();
  simulation.constraints = std::make_unique<Constraints>(model->dofs(), kFaces + 1);
  LoadBuilder(simulation, *model).build();
  InitialBuilder(simulation, model->dofs()).build();
  simulation.model = std::move(model);
  return simulation;
}

}  // namespace riven
