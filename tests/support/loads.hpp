#pragma once

#include <Eigen/Core>

#include "load/mirror.hpp"
#include "peridynamics/membrane.hpp"

namespace riven::testing {

using FaceLoads = std::array<std::optional<FaceLoad>, 6>;

/// u_axis = (F(parameter) - 1) X, shared by the loads below.
using GradientPath = std::function<Eigen::Matrix2d(double)>;

inline LoadFunction component(const GradientPath& path, int axis) {
  return [path, axis](const Point& x, double parameter) {
    const Eigen::Matrix2d f = path(parameter);
    return f(axis, 0) * x[0] + f(axis, 1) * x[1] - x[static_cast<std::size_t>(axis)];
  };
}

/// The displacement of y = F X on the given edges: their normal component and, unless they are rollers, the
/// other one.
inline FaceLoads edges(const GradientPath& path, const Faces& faces, bool rollers) {
  FaceLoads loads;
  for (std::size_t face = 0; face < 4; ++face) {
    if (!faces.test(face)) continue;
    loads[face] = FaceLoad{{}, face};
    for (int axis = 0; axis < 2; ++axis)
      if (!rollers || axis == static_cast<int>(face / 2))
        loads[face]->displacement[static_cast<std::size_t>(axis)] = component(path, axis);
  }
  return loads;
}

inline FaceLoads equibiaxial() {
  return edges([](double l) { return Eigen::Matrix2d(l * Eigen::Matrix2d::Identity()); }, Faces(0b1111),
               false);
}
inline FaceLoads planar() {
  return edges([](double l) { return Eigen::Matrix2d{{l, 0}, {0, 1}}; }, Faces(0b1111), true);
}
/// Left and right edge on rollers; lower and upper edge free.
inline FaceLoads uniaxial() {
  return edges([](double l) { return Eigen::Matrix2d{{l, 0}, {0, 1}}; }, Faces(0b0011), true);
}

inline Constraints constrain(const PointModel& membrane, const FaceLoads& loads) {
  Constraints constraints(membrane.dofs(), 7);
  add_mirror_constraints(membrane.body(), loads, membrane.conservative(), constraints);
  return constraints;
}

/// Keeps an inclusion where it is.
inline void hold_inclusions(const Membrane& membrane, Constraints& constraints) {
  for (std::size_t e = 2 * membrane.body().size(); e < membrane.dofs(); ++e)
    constraints.add({.slave = e, .master = Constraint::kNone, .sign = 1, .terms = {}});
}

}  // namespace riven::testing
