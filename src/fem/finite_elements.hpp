#pragma once

#include <memory>

#include "fem/dilatation.hpp"
#include "fem/mesh_body.hpp"
#include "material/material.hpp"
#include "material/plane.hpp"
#include "model/model.hpp"

namespace riven {

class ElementKernel;

struct FiniteElementsSettings {
  std::vector<Material> materials;  // by their numbers in the mesh
  Plane plane = Plane::stress;      // in two dimensions
  /// Where a material has a volumetric part and something holds the body across, `mean` unless given, of
  /// eight-node quadrilaterals `linear`.
  std::optional<Dilatation> dilatation{};
};

/// Finite elements with displacements as unknowns, at any deformation: force and tangent of eq. (14) to (16)
/// of the space-time theory, by Gauss's rule. A state holds u_x of all nodes, then u_y (and u_z). Elements
/// write their forces apart; a node sums those of its elements in their order, so that bits do not depend on
/// threads. Materials that relax remember their past at quadrature points; energies then are the work taken
/// up, stored or not.
class FiniteElements final : public Model {
 public:
  /// Throws InputError for elements that are turned over, a dilatation that no material has or that does not
  /// fit the elements, and incompressible materials in anything but plane stress.
  FiniteElements(MeshBody mesh, FiniteElementsSettings settings);
  ~FiniteElements() override;
  FiniteElements(FiniteElements&&) = delete;  // the kernel looks at the mesh

  [[nodiscard]] std::size_t dofs() const override { return dimension_ * mesh_.node.size(); }
  [[nodiscard]] std::optional<Breakdown> internal_force(std::span<const double> u,
                                                        std::span<double> force) override;
  [[nodiscard]] double strain_energy(std::span<const double> u) override;
  [[nodiscard]] bool conservative() const override { return true; }
  [[nodiscard]] bool has_memory() const override;
  void go_on(double dt) override;
  void go_back() override;
  [[nodiscard]] Passage advance(std::span<const double> u, std::span<double> force) override;
  void save(Snapshot& to) const override;
  void restore(const Snapshot& from) override;
  void mass(std::span<double> mass) const override;
  void stiffness_bound(std::span<const double> u, std::span<double> bound) override;
  /// A part is an element.
  [[nodiscard]] std::size_t tangent_parts() const override { return mesh_.elements(); }
  void tangent(std::span<const double> u, std::size_t first, std::size_t last,
               TangentBlocks& to) const override;
  [[nodiscard]] double spacing() const override { return body_.spacing; }
  [[nodiscard]] std::optional<Breakdown> inspect(std::span<const double> u) override;
  void move(std::span<double> u, const std::array<std::array<double, 3>, 3>& gradient,
            const Point& shift) const override;
  [[nodiscard]] std::vector<Point> positions() const override { return mesh_.node; }
  [[nodiscard]] std::vector<Point> displacements(std::span<const double> u) const override;
  /// Means at the nodes of what quadrature points have, weighted with the squares of shape functions.
  [[nodiscard]] std::vector<ModelField> fields(std::span<const double> u) override;
  [[nodiscard]] Point place(std::size_t entry) const override {
    return mesh_.node[entry % mesh_.node.size()];
  }
  [[nodiscard]] std::string remedies() const override { return "a finer mesh"; }
  [[nodiscard]] std::vector<std::string> describe() const override;
  [[nodiscard]] std::size_t points() const override { return mesh_.node.size(); }
  [[nodiscard]] std::size_t bonds() const override { return 0; }

  [[nodiscard]] const MeshBody& mesh() const { return mesh_; }
  /// The nodes, as points without bonds.
  [[nodiscard]] const Body& body() const { return body_; }

 private:
  MeshBody mesh_;
  Body body_;
  std::size_t dimension_;
  std::unique_ptr<ElementKernel> kernel_;
};

}  // namespace riven
