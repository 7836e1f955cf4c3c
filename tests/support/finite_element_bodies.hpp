#pragma once

#include <memory>
#include <vector>

#include "fem/finite_elements.hpp"
#include "support/laws.hpp"
#include "support/random.hpp"

namespace riven::testing {

inline const std::vector<ElementShape>& element_shapes() {
  static const std::vector<ElementShape> shapes{ElementShape::t3, ElementShape::q4, ElementShape::q8,
                                                ElementShape::t4, ElementShape::h8};
  return shapes;
}

/// A block of about 1 m whose nodes have been moved by up to a fifth of an element: those inside, or all of
/// them. Sides of eight-node quadrilaterals are curved.
inline MeshBody distorted(ElementShape shape, Random& random, bool boundary_too = true, int along = 3) {
  std::vector<int> elements{along, 2};
  if (dimension_of(shape) == 3) elements.push_back(2);
  MeshBody mesh = make_mesh(shape, elements, 0.7, [](const Point& x) { return x; });
  for (Point& x : mesh.node)
    for (std::size_t d = 0; d < elements.size(); ++d) {
      const bool edge = x[d] == 0 || x[d] == 1;  // stays in its plane
      const double middle = shape == ElementShape::q8 ? 0.25 : 1;
      const double shift = middle * random.between(-0.2, 0.2) / elements[d];
      if (boundary_too || !edge) x[d] += shift;
    }
  return mesh;
}

inline std::unique_ptr<FiniteElements> elements_of(MeshBody mesh, const Material& material, Plane plane,
                                                   std::optional<Dilatation> dilatation = {}) {
  return std::make_unique<FiniteElements>(
      std::move(mesh),
      FiniteElementsSettings{.materials = {material}, .plane = plane, .dilatation = dilatation});
}

/// u = G X + random displacements of up to `size`.
inline std::vector<double> moved(const FiniteElements& model, const Eigen::Matrix3d& gradient, double size,
                                 Random& random) {
  std::vector<double> u(model.dofs());
  const auto& node = model.mesh().node;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const auto axis = static_cast<Eigen::Index>(i / node.size());
    u[i] =
        gradient.row(axis).dot(Eigen::Vector3d(node[i % node.size()].data())) + random.between(-size, size);
  }
  return u;
}

inline std::vector<double> force_in(Model& model, const std::vector<double>& u) {
  std::vector<double> force(model.dofs());
  EXPECT_FALSE(model.internal_force(u, force));
  return force;
}

/// Entries of nodes that are on no face.
inline std::vector<std::size_t> inner_entries(const MeshBody& mesh) {
  std::vector<bool> outer(mesh.node.size());
  for (std::size_t face = 0; face < 6; ++face)
    for (const std::uint32_t n : mesh.nodes_on(face)) outer[n] = true;
  std::vector<std::size_t> entries;
  for (std::size_t d = 0; d < static_cast<std::size_t>(mesh.dimension()); ++d)
    for (std::size_t n = 0; n < outer.size(); ++n)
      if (!outer[n]) entries.push_back(d * outer.size() + n);
  return entries;
}

inline Eigen::Matrix3d random_gradient_in(Random& random, int dimension, double size) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
  for (int i = 0; i < dimension; ++i)
    for (int j = 0; j < dimension; ++j) g(i, j) = random.between(-size, size);
  return g;
}

}  // namespace riven::testing
