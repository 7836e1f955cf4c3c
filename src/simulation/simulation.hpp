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

/// A traction on an edge (its number), or a body force on a set (nothing: the whole body).
struct AppliedForce {
  std::optional<std::size_t> face;
  std::string on;
  std::shared_ptr<const DistributedForce> force;
};

/// Everything a run needs, built from a case. Reactions are collected under 0 to 5 for the faces, and under 6
/// for points and inclusions that are held.
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
  /// A declared set. The input layer has checked that it exists.
  [[nodiscard]] const PointSet& set(const std::string& name) const;
  /// Entry of a state that holds component `axis` of a body point: point models keep a plane per component.
  [[nodiscard]] std::size_t entry(std::size_t axis, std::size_t number) const;
};

/// Throws InputError where the case can't be built: an empty set, overlapping defects, a load that the model
/// can't carry.
Simulation build_simulation(const Case& input);

}  // namespace riven
