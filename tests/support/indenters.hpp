#pragma once

#include <cmath>

#include "load/indenter.hpp"
#include "solver/newton.hpp"
#include "support/finite_element_bodies.hpp"

namespace riven::testing {

/// All nodes of some of a mesh's faces.
inline std::vector<LoadShare> surface_of(const MeshBody& mesh, const std::vector<std::size_t>& faces) {
  std::vector<LoadShare> surface;
  for (const std::size_t face : faces)
    for (const NodeShare& share : mesh.face_shares(face))
      surface.push_back({share.node, mesh.node[share.node], share.extent});
  return surface;
}

/// An indenter above the faces of a mesh.
inline std::shared_ptr<Indenter> indenter_on(const MeshBody& mesh, IndenterSettings settings,
                                             const std::vector<std::size_t>& faces = {3}) {
  settings.name = "punch";
  if (settings.spacing == 0) settings.spacing = 1e-3;
  return std::make_shared<Indenter>(std::move(settings), surface_of(mesh, faces), mesh.node.size(),
                                    mesh.dimension());
}

/// Goes down by `depth` from stretch 1 to stretch 2.
inline std::function<Point(double)> down(double depth) {
  return [depth](double stretch) { return Point{0, -depth * (stretch - 1), 0}; };
}

/// Holds components of the nodes of a face.
inline void hold(Constraints& constraints, const MeshBody& mesh, std::size_t face,
                 const std::vector<std::size_t>& axes) {
  const auto rest = [](const Point&, double) { return 0.0; };
  for (const std::size_t axis : axes)
    for (const std::uint32_t node : mesh.nodes_on(face))
      if (constraints.is_free(axis * mesh.node.size() + node))
        constraints.add({.slave = axis * mesh.node.size() + node,
                         .terms = {{rest, mesh.node[node], static_cast<int>(axis), 1, face}}});
}

/// The state at stretch 2 under an indenter, by Newton's method.
inline State indented(FiniteElements& model, Constraints& constraints, std::shared_ptr<Indenter> indenter,
                      double increment = 0.25) {
  Observer nobody;
  LoadStepSettings settings{.targets = {2}, .increment = increment, .tolerance = 1e-9};
  settings.external = {std::move(indenter)};
  return newton(model, constraints, settings, nobody);
}

}  // namespace riven::testing
