#pragma once

#include <memory>

#include "input/case.hpp"
#include "peridynamics/point_model.hpp"
#include "simulation/simulation.hpp"

namespace riven {

// The steps of build_simulation, a file each. All throw InputError with the place in the case file.

/// Points and bonds, with ghost points behind the edges that have a load.
Body make_body(const Case& in);

/// What a crack of the case adds to the defects.
void add_crack(const CrackInput& crack, Defects& to);

/// A crack that misses the body is a slip of a sign or a unit. Those in two dimensions are checked in place;
/// those in three against the points of the finished body: one must be between two of them.
void check_cracks(const Case& in, const Body& body);

/// The points of a set, and the elements of a mesh; an empty one is an error.
PointSet make_set(const SetInput& in, const Case& of, const Body& body, const MeshBody* mesh = nullptr);

/// Gives the body's points the materials of their sets, and marks those whose bonds never break.
void mark_points(const Case& in, const std::vector<PointSet>& sets, Body& body);

std::unique_ptr<PointModel> make_model(const Case& in, Body body);

/// Mesh, sets and model of a case with finite elements.
void build_elements(Simulation& simulation);

/// Turns the loads into constraints on the state of the model and forces. `points`: the model, unless it has
/// elements.
void build_loads(Simulation& simulation, const PointModel* points);

/// Fills the initial state of the body's points. What is prescribed comes from the loads when the run starts.
void build_initial(Simulation& simulation, std::size_t dofs);

/// The model with the case's contact and impactors, of which `contact` then tells; the model itself without
/// any.
std::unique_ptr<Model> with_contact(const Case& in, std::unique_ptr<PointModel> model,
                                    const ContactModel*& contact);

/// Prescribes how impactors move, or gives them the velocity that they start with. On finite elements they
/// are external forces.
void build_impactors(Simulation& simulation);
void build_indenters(Simulation& simulation);

RigidPlane rigid_plane(const PlaneInput& in);

}  // namespace riven
