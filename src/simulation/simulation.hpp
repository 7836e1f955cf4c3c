#pragma once

#include <memory>
#include <string>
#include <vector>

#include "body/body.hpp"
#include "fem/mesh_body.hpp"
#include "input/case.hpp"
#include "load/constraints.hpp"
#include "load/contact_model.hpp"
#include "load/distributed_force.hpp"
#include "load/follower_pressure.hpp"
#include "load/indenter.hpp"
#include "model/model.hpp"
#include "output/parameter.hpp"

namespace riven {

/// Body points, nodes of a mesh among them, that the user gave a name.
struct PointSet {
  std::string name;
  std::vector<std::size_t> points;      // their numbers in the list of the body's points
  std::vector<std::size_t> elements{};  // of a mesh: those whose centres are in the set
};

/// The set of that name. The input layer has checked that it exists.
const PointSet& find_set(const std::vector<PointSet>& sets, const std::string& name);

/// A traction or a pressure on an edge (its number), or a body force on a set (nothing: the whole body).
struct AppliedForce {
  std::optional<std::size_t> face;
  std::string on;
  std::shared_ptr<const DistributedForce> force;
  std::shared_ptr<const FollowerPressure> pressure{};  // instead

  [[nodiscard]] std::string kind() const { return pressure ? "pressure" : face ? "traction" : "body force"; }
  /// Sum of all forces (N) in a state.
  [[nodiscard]] Point total(std::span<const double> u, double parameter) const {
    return pressure ? pressure->total(u, parameter) : force->total(parameter);
  }
};

/// Everything a run needs, built from a case. Reactions are collected under the numbers of edges, and under
/// the one after them for points and inclusions that are held.
struct Simulation {
  Case input;
  Parameter parameter = Parameter::stretch;  // what the solver marches
  std::unique_ptr<Model> model;
  const Body* body = nullptr;             // the model's; of a mesh its nodes
  const MeshBody* mesh = nullptr;         // the model's, if it has elements
  const ContactModel* contact = nullptr;  // the model, where there is contact
  std::unique_ptr<Constraints> constraints;
  std::vector<PointSet> sets;
  std::vector<AppliedForce> applied;
  std::vector<std::shared_ptr<const Indenter>> indenters;  // impactors on finite elements
  ExternalForces external;                   // these and whatever else acts from outside of the model
  std::vector<double> initial_u, initial_v;  // m, m/s: initial conditions; empty without any

  /// Number of a face by its name, or nothing.
  static std::optional<std::size_t> face(const std::string& name);
  /// Number of an edge by its name: a face, or a group of sides of the mesh; or nothing.
  [[nodiscard]] std::optional<std::size_t> edge(const std::string& name) const;
  [[nodiscard]] std::size_t edges() const { return mesh != nullptr ? mesh->edges() : kFaceNames.size(); }
  /// A declared set. The input layer has checked that it exists.
  [[nodiscard]] const PointSet& set(const std::string& name) const;
  /// Entry of a state that holds component `axis` of a body point: point models keep a plane per component.
  [[nodiscard]] std::size_t entry(std::size_t axis, std::size_t number) const;
};

/// Throws InputError where the case can't be built: an empty set, overlapping defects, a load that the model
/// can't carry.
Simulation build_simulation(const Case& input);

}  // namespace riven
