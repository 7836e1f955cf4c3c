#include "fem/finite_elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.hpp"
#include "fem/element_kernel.hpp"

namespace riven {

namespace {

Kinematics kinematics_of(int dimension, Plane plane) {
  if (dimension == 3) return Kinematics::solid;
  return plane == Plane::strain ? Kinematics::plane_strain : Kinematics::plane_stress;
}

std::vector<ElementLaw> element_laws(const FiniteElementsSettings& settings, int dimension) {
  const Kinematics kinematics = kinematics_of(dimension, settings.plane);
  const bool sheet = kinematics == Kinematics::plane_stress;
  std::vector<ElementLaw> laws;
  bool any_mean = false;
  for (const Material& material : settings.materials) {
    if (material.incompressible() && !sheet)
      throw InputError(
          fmt::format("material {} is incompressible, and its pressure does not follow from the "
                      "deformation; expected a bulk_modulus, or plane stress",
                      material.name));
    if (!material.relaxation.empty() && !has_isochoric_part(material))
      throw InputError(fmt::format(
          "material {} relaxes, but its law has no part of the shape alone that could; expected one with a "
          "bulk_modulus of its own, such as \"neo-hookean\"",
          material.name));
    const bool mean = material.volumetric && !sheet && settings.dilatation != Dilatation::full;
    any_mean = any_mean || mean;
    laws.emplace_back(material, kinematics, mean);
  }
  if (sheet && settings.dilatation == Dilatation::selective)
    throw InputError(
        "in plane stress selective integration would take the pressure with one thickness stretch, and the "
        "rest with that of each point: a stress would be left across the sheet, in which nothing locks; "
        "expected dilatation = \"full\", or none");
  if (settings.dilatation.value_or(Dilatation::full) != Dilatation::full && !any_mean)
    throw InputError(
        sheet ? "in plane stress nothing locks; expected dilatation = \"full\", or none"
              : "no material has a bulk_modulus, so that none has a part of its energy that is of the "
                "volume alone; expected dilatation = \"full\", or none");
  return laws;
}

}  // namespace

FiniteElements::FiniteElements(MeshBody mesh, FiniteElementsSettings settings)
    : mesh_(std::move(mesh)),
      body_(nodes_as_body(mesh_)),
      dimension_(static_cast<std::size_t>(mesh_.dimension())) {
  check_elements(mesh_);
  std::vector<ElementLaw> laws = element_laws(settings, mesh_.dimension());
  const bool is_q8 = mesh_.shape == ElementShape::q8;
  if (settings.dilatation == Dilatation::linear && !is_q8)
    throw InputError(
        fmt::format("a linear dilatation belongs to elements q8, and locks others; found {}, expected "
                    "dilatation = \"mean\", or none",
                    name_of(mesh_.shape)));
  const Dilatation dilatation = settings.dilatation.value_or(is_q8 ? Dilatation::linear : Dilatation::mean);
  kernel_ = make_element_kernel(mesh_, std::move(laws), dilatation);
}

FiniteElements::~FiniteElements() = default;

std::optional<Breakdown> FiniteElements::internal_force(std::span<const double> u, std::span<double> force) {
  const auto wrong = kernel_->force(u, force);
  if (!wrong) return std::nullopt;
  if (const auto turned = kernel_->turned_over(u))
    return Breakdown{mesh_.centre(*turned),
                     fmt::format("element {} is turned inside out", mesh_.label(*turned))};
  return Breakdown{mesh_.centre(*wrong),
                   fmt::format("the law says nothing of the strain of element {}", mesh_.label(*wrong))};
}

double FiniteElements::strain_energy(std::span<const double> u) {
  return kernel_->energy(u);
}

void FiniteElements::mass(std::span<double> mass) const {
  std::fill(mass.begin(), mass.end(), 0.0);
  const std::size_t nodes = mesh_.node.size(), per_element = nodes_of(mesh_.shape);
  for (std::size_t s = 0; s < mesh_.corner.size(); ++s) {
    const double density = kernel_->laws[mesh_.material_of(s / per_element)].local.density;
    for (std::size_t d = 0; d < dimension_; ++d)
      mass[d * nodes + mesh_.corner[s]] += density * kernel_->lumped[s];
  }
}

void FiniteElements::stiffness_bound(std::span<const double> u, std::span<double> bound) {
  kernel_->bound(u, bound);
}

void FiniteElements::tangent(std::span<const double> u, std::size_t first, std::size_t last,
                             TangentBlocks& to) const {
  kernel_->tangent(u, first, last, to);
}

std::optional<Breakdown> FiniteElements::inspect(std::span<const double> u) {
  const auto turned = kernel_->turned_over(u);
  if (!turned) return std::nullopt;
  return Breakdown{mesh_.centre(*turned),
                   fmt::format("element {} is turned inside out", mesh_.label(*turned))};
}

void FiniteElements::move(std::span<double> u, const std::array<std::array<double, 3>, 3>& gradient,
                          const Point& shift) const {
  const std::size_t nodes = mesh_.node.size();
  for (std::size_t n = 0; n < nodes; ++n)
    for (std::size_t d = 0; d < dimension_; ++d)
      u[d * nodes + n] += shift[d] + gradient[d][0] * mesh_.node[n][0] + gradient[d][1] * mesh_.node[n][1] +
                          gradient[d][2] * mesh_.node[n][2];
}

std::vector<Point> FiniteElements::displacements(std::span<const double> u) const {
  const std::size_t nodes = mesh_.node.size();
  std::vector<Point> list(nodes);
  for (std::size_t n = 0; n < nodes; ++n)
    for (std::size_t d = 0; d < dimension_; ++d) list[n][d] = u[d * nodes + n];
  return list;
}

std::vector<ModelField> FiniteElements::fields(std::span<const double> u) {
  return kernel_->fields(u);
}

bool FiniteElements::has_memory() const {
  return !kernel_->memory.empty();
}

void FiniteElements::go_on(double dt) {
  kernel_->memory.go_on(dt);
}

void FiniteElements::go_back() {
  kernel_->memory.go_back();
}

Passage FiniteElements::advance(std::span<const double> /*u*/, std::span<double> /*force*/) {
  kernel_->memory.pass();
  return {};
}

void FiniteElements::save(Snapshot& to) const {
  if (has_memory()) kernel_->memory.save(to);
}

void FiniteElements::restore(const Snapshot& from) {
  if (has_memory()) kernel_->memory.restore(from);
}

std::vector<std::string> FiniteElements::describe() const {
  const bool mean = std::any_of(kernel_->laws.begin(), kernel_->laws.end(),
                                [](const ElementLaw& law) { return law.mean.has_value(); });
  const std::size_t points =
      with_element(mesh_.shape, []<class E>(E) { return static_cast<std::size_t>(E::Q); });
  const std::map<Dilatation, const char*> ways{
      {Dilatation::full, "at every quadrature point"},
      {Dilatation::mean, "its mean over each element"},
      {Dilatation::linear, "a linear fit over each element"},
      {Dilatation::selective, "that of the mean gradient of each element"}};
  return {fmt::format("mesh: {} elements {} of {} quadrature points, {} nodes, mean size {:.6g} m",
                      mesh_.elements(), name_of(mesh_.shape), points, mesh_.node.size(), body_.spacing),
          fmt::format("change of volume: {}", ways.at(mean ? kernel_->dilatation : Dilatation::full))};
}

}  // namespace riven
