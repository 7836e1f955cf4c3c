#include "load/mirror.hpp"

#include <algorithm>

namespace riven {

namespace {

std::size_t axis_of(std::size_t face) {
  return face / 2;
}

/// The ghost's faces in the order of reflection, the one normal to the component first.
std::vector<std::size_t> reflection_order(const Faces& faces, std::size_t component) {
  std::vector<std::size_t> order;
  for (std::size_t face = 0; face < faces.size(); ++face)
    if (faces.test(face)) order.push_back(face);
  std::stable_partition(order.begin(), order.end(),
                        [&](std::size_t face) { return axis_of(face) == component; });
  return order;
}

}  // namespace

void add_mirror_constraints(const Body& body, const std::array<std::optional<FaceLoad>, 6>& faces,
                            bool chain_rule, Constraints& constraints) {
  for (const GhostPoint& ghost : body.ghosts) {
    for (std::size_t component = 0; component < static_cast<std::size_t>(body.dimension); ++component) {
      Constraint constraint;
      constraint.chain_rule = chain_rule;
      constraint.slave = component * body.size() + ghost.point;
      constraint.master = component * body.size() + ghost.master;
      Point x = body.position(ghost.point);
      for (const std::size_t face : reflection_order(ghost.faces, component)) {
        const double plane = body.faces[face];
        const auto& given = faces[face]->displacement[component];
        if (given) {
          Point on_face = x;
          on_face[axis_of(face)] = plane;
          constraint.terms.push_back({*given, on_face, static_cast<int>(component), 2 * constraint.sign,
                                      faces[face]->load, faces[face]->rate[component]});
          constraint.sign = -constraint.sign;
        }
        x[axis_of(face)] = 2 * plane - x[axis_of(face)];
      }
      constraints.add(std::move(constraint));
    }
  }
}

}  // namespace riven
