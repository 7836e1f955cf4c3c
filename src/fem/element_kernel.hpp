#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fem/dilatation.hpp"
#include "fem/element_law.hpp"
#include "fem/mesh_body.hpp"
#include "fem/point_memory.hpp"
#include "model/model.hpp"

namespace riven {

/// What depends on the shape of the elements, behind one virtual call per sweep.
class ElementKernel {
 public:
  virtual ~ElementKernel() = default;
  /// Returns the first element that the law says nothing of.
  virtual std::optional<std::size_t> force(std::span<const double> u, std::span<double> force) = 0;
  [[nodiscard]] virtual double energy(std::span<const double> u) = 0;
  virtual void tangent(std::span<const double> u, std::size_t first, std::size_t last,
                       TangentBlocks& to) const = 0;
  virtual void bound(std::span<const double> u, std::span<double> bound) = 0;
  [[nodiscard]] virtual std::optional<std::size_t> turned_over(std::span<const double> u) const = 0;
  [[nodiscard]] virtual std::vector<ModelField> fields(std::span<const double> u) const = 0;
  std::vector<double> lumped;    // m^3, of each element's nodes
  std::vector<ElementLaw> laws;  // by material
  PointMemory memory;
  Dilatation dilatation = Dilatation::full;
};

/// For the shape of the mesh's elements; keeps a reference to the mesh.
[[nodiscard]] std::unique_ptr<ElementKernel> make_element_kernel(const MeshBody& mesh,
                                                                 std::vector<ElementLaw> laws,
                                                                 Dilatation dilatation);

}  // namespace riven
