#pragma once

#include <array>
#include <optional>

#include "body/body.hpp"
#include "load/constraints.hpp"

namespace riven {

/// Displacement or velocity prescribed on a face: a function per given component; other components are free.
struct FaceLoad {
  std::array<std::optional<LoadFunction>, 3> displacement;
  std::size_t load = 0;        // number under which reactions are collected
  std::array<bool, 3> rate{};  // the function is a velocity, as in `PrescribedTerm`
};

/// Makes the ghost points of a body follow their masters so that every mirrored face has its
/// prescribed displacement: u_ghost = 2 U* - u_master for given components, u_ghost = u_master for free ones
/// (peridynamics theory, 5a rule 1). At a corner, component a is reflected at the face normal to a last, so
/// that the reaction of that face is its own section force. `chain_rule`: see `Constraint`.
void add_mirror_constraints(const Body& body, const std::array<std::optional<FaceLoad>, 6>& faces,
                            bool chain_rule, Constraints& constraints);

}  // namespace riven
