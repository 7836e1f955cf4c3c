#pragma once

#include <array>
#include <optional>

#include "body/lattice_body.hpp"
#include "load/constraints.hpp"

namespace riven {

/// Displacement prescribed on a face: a function per given component; other components are free.
struct FaceLoad {
  std::array<std::optional<LoadFunction>, 3> displacement;
  std::size_t load = 0;  // number under which reactions are collected
};

/// Makes the ghost points of a lattice body follow their masters so that every mirrored face has its
/// prescribed displacement: u_ghost = 2 U* - u_master for given components, u_ghost = u_master for free ones
/// (peridynamics theory, 5a rule 1). At a corner, component a is reflected at the face normal to a last, so
/// that the reaction of that face is its own section force. `component_stride`: distance in a state between
/// two components of one point.
void add_mirror_constraints(const LatticeBody& body, const std::array<std::optional<FaceLoad>, 6>& faces,
                            std::size_t component_stride, Constraints& constraints);

}  // namespace riven
