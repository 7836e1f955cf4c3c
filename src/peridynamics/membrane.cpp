#include "peridynamics/membrane.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "peridynamics/family_energy.hpp"

namespace riven {

namespace {

// Where the family is cut, short waves are held by fewer bonds and a full stabilisation would stiffen edges
// (5a, 5).
constexpr double kCutFamilyStabilisation = 0.1;

// Determinant of a family's shape tensor (trace 1) below which all its bonds lie on one line: two of a
// lattice's bonds that do not have one of 0.02 and more.
constexpr double kFlatFamily = 1e-4;

Eigen::Vector2d plane(const Point& p) {
  return {p[0], p[1]};
}

}  // namespace

Membrane::Membrane(LatticeBody body, Material material, double stabilisation)
    : body_(std::move(body)), material_(std::move(material)), stabilisation_(stabilisation) {
  if (body_.lattice.dimension() != 2)
    throw InputError("a membrane is two-dimensional: give the box two sizes and a thickness");
  const std::size_t n = body_.lattice.size();
  for (auto* plane :
       {&kappa_, &smallest_weight_, &mean_s2_, &mean_s4_, &energy_density_, &force_a_, &force_b_})
    plane->assign(n, 0.0);
  for (auto& plane : coefficient_) plane.assign(n, 0.0);
  for (auto& plane : mean_gradient_) plane.assign(n, 0.0);
  for (auto& plane : force_n_) plane.assign(n, 0.0);
  collapsed_in_row_.assign(body_.lattice.rows(), -1);
  listed_index_.assign(n, -1);
  for (std::size_t k = 0; k < body_.stencil.size(); ++k) {
    const PlaneBond bond{body_.stencil.bond[k][0], body_.stencil.bond[k][1]};
    const double length = body_.stencil.length[k];
    Moments weight = angular_functions(bond);
    for (double& w : weight) w /= length;
    stencil_.push_back({body_.stencil.shift[k], bond.x, bond.y, 1 / (length * length), weight});
  }
  make_inclusions();
  make_families();
}

void Membrane::make_inclusions() {
  for (const Shape& shape : body_.defects.inclusions) {
    Inclusion inclusion;
    double area = 0;
    if (const auto* disc = std::get_if<Disc>(&shape)) {
      inclusion.center = plane(disc->center);
      inclusion.gyration = disc->radius / std::sqrt(2.0);
      area = std::numbers::pi * disc->radius * disc->radius;
    } else if (const auto* box = std::get_if<Box>(&shape)) {
      inclusion.center = plane(box->center);
      inclusion.gyration = std::hypot(box->half_size[0], box->half_size[1]) / std::sqrt(3.0);
      area = 4 * box->half_size[0] * box->half_size[1];
    } else {
      throw InputError("an inclusion of a membrane is a disc or a box");
    }
    inclusion.mass = material_.density * area * body_.thickness;
    inclusions_.push_back(inclusion);
  }
}

/// Bonds of a point without weights: those of the lattice, then those that end on inclusions.
std::vector<MembraneBond> Membrane::bonds_of(std::size_t point) const {
  std::vector<MembraneBond> bonds;
  for (std::size_t k = 0; k < stencil_.size(); ++k)
    if (body_.bonds.exists(k, point))
      bonds.push_back(
          {{stencil_[k].x, stencil_[k].y}, 0, BondPlanes::neighbour(body_.stencil, k, point), -1, {0, 0}});
  const Eigen::Vector2d x = plane(body_.lattice.position(point));
  for (const InterfaceBond& bond : body_.interface_of(point)) {
    const Eigen::Vector2d end = plane(bond.end);
    bonds.push_back(
        {end - x, 0, 0, static_cast<int>(bond.inclusion), end - inclusions_[bond.inclusion].center});
  }
  return bonds;
}

/// Directions of a family at the lattice's own lengths: a bond to an inclusion keeps the weight that it had
/// before it was shortened (theory 5a, rule 4). The order is that of `bonds_of`.
std::vector<PlaneBond> Membrane::unshortened_bonds_of(std::size_t point) const {
  std::vector<PlaneBond> bonds;
  for (std::size_t k = 0; k < stencil_.size(); ++k)
    if (body_.bonds.exists(k, point)) bonds.push_back({stencil_[k].x, stencil_[k].y});
  for (const InterfaceBond& bond : body_.interface_of(point))
    bonds.push_back({stencil_[bond.offset].x, stencil_[bond.offset].y});
  return bonds;
}

double Membrane::stabilisation_modulus(std::size_t point) const {
  const bool whole = body_.family_size(point) == body_.stencil.size();
  return stabilisation_ * 0.5 * shear_modulus(material_.law) * (whole ? 1.0 : kCutFamilyStabilisation);
}

void Membrane::make_families() {
  FamilyWeights whole;  // most points have the whole stencil: solve for it once
  for (const std::size_t i : body_.points) {
    kappa_[i] = stabilisation_modulus(i);
    const std::size_t size = body_.family_size(i);
    directed_bonds_ += size;
    const bool at_interface = !body_.interface_of(i).empty();
    const bool is_whole = size == body_.stencil.size() && !at_interface;
    FamilyWeights weights =
        is_whole && !whole.weight.empty() ? whole : moment_corrected_weights(unshortened_bonds_of(i));
    if (is_whole && whole.weight.empty()) whole = weights;
    smallest_weight_[i] = weights.smallest_ratio;
    if (weights.kind == FamilyWeights::Kind::smooth && !at_interface) {
      for (std::size_t m = 0; m < kMoments; ++m) coefficient_[m][i] = weights.coefficients[m];
      continue;
    }
    ListedFamily family;
    family.point = i;
    family.by_least_squares = weights.kind == FamilyWeights::Kind::listed;
    family.by_gradient = weights.kind == FamilyWeights::Kind::gradient;
    family.bonds = bonds_of(i);
    Eigen::Matrix2d shape = Eigen::Matrix2d::Zero();
    for (std::size_t j = 0; j < family.bonds.size(); ++j) {
      family.bonds[j].weight = weights.weight[j];
      const Eigen::Vector2d n = family.bonds[j].reference.normalized();
      shape += weights.weight[j] * n * n.transpose();
    }
    if (family.by_gradient && shape.determinant() < kFlatFamily) {
      family.by_gradient = false;  // no weights, no gradient: the point hangs on its neighbours' forces alone
      family.bonds.clear();
    }
    if (family.by_gradient) family.inverse_shape = shape.inverse();
    listed_index_[i] = static_cast<std::ptrdiff_t>(listed_.size());
    listed_.push_back(std::move(family));
  }
}

Eigen::Vector2d Membrane::deformed(std::size_t point, const MembraneBond& bond,
                                   std::span<const double> u) const {
  const std::size_t n = body_.lattice.size();
  const Eigen::Vector2d here(u[point], u[n + point]);
  if (bond.inclusion < 0)
    return bond.reference + Eigen::Vector2d(u[bond.neighbour], u[n + bond.neighbour]) - here;
  const auto inclusion = static_cast<std::size_t>(bond.inclusion);
  const std::size_t dof = inclusion_dof(inclusion);
  return bond.reference + inclusions_[inclusion].displacement(bond.arm, u, dof) - here;
}

Eigen::Vector2d Membrane::bond_force(const PointForce& law, const MembraneBond& bond,
                                     const Eigen::Vector2d& y) {
  const double inverse2 = 1 / bond.reference.squaredNorm();
  return bond.weight * inverse2 * ((law.a + law.b * y.squaredNorm() * inverse2) * y + law.n * bond.reference);
}

std::size_t Membrane::dofs() const {
  return 2 * body_.lattice.size() + 3 * inclusions_.size();
}

std::size_t Membrane::inclusion_dof(std::size_t inclusion) const {
  return 2 * body_.lattice.size() + 3 * inclusion;
}

std::size_t Membrane::points_by_least_squares() const {
  return static_cast<std::size_t>(std::count_if(
      listed_.begin(), listed_.end(), [](const ListedFamily& family) { return family.by_least_squares; }));
}

std::size_t Membrane::points_by_gradient() const {
  return static_cast<std::size_t>(std::count_if(
      listed_.begin(), listed_.end(), [](const ListedFamily& family) { return family.by_gradient; }));
}

std::vector<std::string> Membrane::describe() const {
  const double mu = shear_modulus(material_.law);
  return {fmt::format("material {}: shear modulus {:.6g} Pa, Young's modulus {:.6g} Pa (incompressible)",
                      material_.name, mu, 3 * mu),
          fmt::format("weights: {} points by least squares, {} by the deformation gradient",
                      points_by_least_squares(), points_by_gradient())};
}

std::size_t Membrane::bytes() const {
  const std::size_t n = body_.lattice.size();
  constexpr std::size_t planes =
      kMoments + 4 + 4 + 7 + 1;  // doubles per stored point; the last is the body's volume
  std::size_t listed = 0;
  for (const ListedFamily& family : listed_)
    listed += sizeof family + family.bonds.size() * sizeof(MembraneBond);
  return n * (planes * sizeof(double) + sizeof(std::ptrdiff_t) + sizeof(PointKind) + sizeof(std::uint16_t)) +
         n * body_.stencil.size() / 8 + body_.points.size() * sizeof(std::size_t) + listed;
}

double Membrane::strain_energy(std::span<const double> u) {
  update_points(u);
  return ordered_sum_of(body_.points.size(), [&](std::size_t n) {
    const std::size_t i = body_.points[n];
    return body_.volume[i] * energy_density_[i];
  });
}

void Membrane::mass(std::span<double> mass) const {
  const std::size_t n = body_.lattice.size();
  std::fill(mass.begin(), mass.end(), 0.0);
  for (const std::size_t i : body_.points) mass[i] = mass[n + i] = material_.density * body_.volume[i];
  for (std::size_t c = 0; c < inclusions_.size(); ++c)
    for (std::size_t d = 0; d < 3; ++d) mass[inclusion_dof(c) + d] = inclusions_[c].mass;
}

std::optional<Breakdown> Membrane::inspect(std::span<const double> u) {
  update_points(u);
  if (auto breakdown = first_collapsed()) return breakdown;
  const auto& g = mean_gradient_;
  for (const std::size_t i : body_.points)
    if (!(g[0][i] * g[3][i] - g[1][i] * g[2][i] > 0))
      return Breakdown{
          body_.lattice.position(i),
          "the sheet has folded over itself: the deformation gradient of a point has a determinant <= 0"};
  return std::nullopt;
}

void Membrane::move(std::span<double> u, const std::array<std::array<double, 3>, 3>& gradient,
                    const Point& shift) const {
  const auto displacement = [&](const Point& x, std::size_t axis) {
    return shift[axis] + gradient[axis][0] * x[0] + gradient[axis][1] * x[1];
  };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (const std::size_t i : body_.points)
      u[axis * body_.lattice.size() + i] += displacement(body_.lattice.position(i), axis);
    for (std::size_t c = 0; c < inclusions_.size(); ++c)
      u[inclusion_dof(c) + axis] +=
          displacement({inclusions_[c].center.x(), inclusions_[c].center.y(), 0}, axis);
  }
}

std::vector<Point> Membrane::positions() const {
  std::vector<Point> positions;
  for (const std::size_t i : body_.points) positions.push_back(body_.lattice.position(i));
  for (const auto& inclusion : body_.rigid_points)
    for (const std::size_t i : inclusion) positions.push_back(body_.lattice.position(i));
  return positions;
}

std::vector<Point> Membrane::displacements(std::span<const double> u) const {
  std::vector<Point> displacements;
  for (const std::size_t i : body_.points) displacements.push_back({u[i], u[body_.lattice.size() + i], 0});
  for (std::size_t c = 0; c < inclusions_.size(); ++c) {
    const std::size_t dof = inclusion_dof(c);
    Inclusion inclusion = inclusions_[c];
    inclusion.rotation = Eigen::Rotation2Dd(u[dof + 2] / inclusion.gyration);
    for (const std::size_t i : body_.rigid_points[c]) {
      const Eigen::Vector2d d =
          inclusion.displacement(plane(body_.lattice.position(i)) - inclusion.center, u, dof);
      displacements.push_back({d.x(), d.y(), 0});
    }
  }
  return displacements;
}

Eigen::Matrix2d Membrane::nominal_stress(std::size_t point, std::span<const double> u) const {
  const PointForce law = point_force(point);
  Eigen::Matrix2d stress = Eigen::Matrix2d::Zero();
  for_each_bond(point, [&](const MembraneBond& bond) {
    stress += bond_force(law, bond, deformed(point, bond, u)) * bond.reference.transpose();
  });
  return stress / body_.volume[point];
}

std::vector<ModelField> Membrane::fields(std::span<const double> u) {
  update_points(u);
  ModelField damage{"damage", 1, {}}, energy{"strain_energy_density", 1, {}}, stress{"nominal_stress", 9, {}},
      weight{"weight_minimum", 1, {}};
  for (const std::size_t i : body_.points) {
    const double whole = body_.whole_family[i];  // 0 for a point that holes have cut off from all others
    damage.values.push_back(whole > 0 ? 1 - static_cast<double>(body_.family_size(i)) / whole : 0);
    energy.values.push_back(energy_density_[i]);
    weight.values.push_back(smallest_weight_[i]);
    const Eigen::Matrix2d p = nominal_stress(i, u);
    stress.values.insert(stress.values.end(), {p(0, 0), p(0, 1), 0, p(1, 0), p(1, 1), 0, 0, 0, 0});
  }
  const std::size_t shown = positions().size();
  for (ModelField* field : {&damage, &energy, &stress, &weight})  // rigid points have none of these
    field->values.resize(shown * static_cast<std::size_t>(field->components), 0.0);
  return {std::move(damage), std::move(energy), std::move(stress), std::move(weight)};
}

/// The family of a point that goes by its deformation gradient, or null.
const Membrane::ListedFamily* Membrane::gradient_family(std::size_t point) const {
  if (listed_index_[point] < 0) return nullptr;
  const ListedFamily& family = listed_[static_cast<std::size_t>(listed_index_[point])];
  return family.by_gradient ? &family : nullptr;
}

/// Bounds of the second derivatives of a point's energy in its family sums, over the volume: by (a, b - 2 a0
/// a), a0 the present a. In a homogeneous state the second of these does not move, while in a and b alone
/// large numbers would cancel.
std::array<double, 3> Membrane::family_curvature(std::size_t point) const {
  const double a = mean_s2_[point], b = mean_s4_[point];
  if (gradient_family(point)) {  // the energy is a function of F, and the one sum is F itself
    Eigen::Matrix2d half_f;
    half_f << mean_gradient_[0][point], mean_gradient_[1][point], mean_gradient_[2][point],
        mean_gradient_[3][point];
    return {material_.plane_stress(2 * half_f).tangent.norm(), 0, 0};
  }
  const FamilyEnergy e = std::visit([&](const auto& law) { return family_energy(law, a, b); }, material_.law);
  return {std::abs(e.waa + 4 * a * e.wab + 4 * a * a * e.wbb), std::abs(e.wab + 2 * a * e.wbb),
          std::abs(e.wbb)};
}

namespace {

/// Length of the sum and sum of the lengths of a family's vectors: bounds rows of the outer product of the
/// sums.
struct FamilySum {
  Eigen::Vector2d sum{0, 0};
  double lengths = 0;

  void add(const Eigen::Vector2d& g) {
    sum += g;
    lengths += g.norm();
  }
  [[nodiscard]] double row() const { return lengths + sum.norm(); }
};

}  // namespace

void Membrane::stiffness_bound(std::span<const double> u, std::span<double> bound) {
  update_points(u);
  std::fill(bound.begin(), bound.end(), 0.0);
  struct BondBound {
    const MembraneBond bond;
    double block, first, second;  // N/m; lengths of the gradients of the family sums (1/m)
  };
  std::vector<BondBound> family;
  for (const std::size_t i : body_.points) {
    const PointForce law = point_force(i);
    const ListedFamily* by_gradient = gradient_family(i);
    FamilySum first, second;
    family.clear();
    for_each_bond(i, [&](const MembraneBond& bond) {
      const Eigen::Vector2d y = deformed(i, bond, u);
      const double inverse2 = 1 / bond.reference.squaredNorm(), s2 = y.squaredNorm() * inverse2;
      const double block = bond.weight * inverse2 * (std::abs(law.a + law.b * s2) + 2 * std::abs(law.b) * s2);
      Eigen::Vector2d ga = 2 * bond.weight * inverse2 * y;
      const Eigen::Vector2d gb = 2 * (s2 - mean_s2_[i]) * ga;
      // F moves by an end's displacement times this; long where the bonds lie nearly on one line.
      if (by_gradient) ga = bond.weight * inverse2 * (by_gradient->inverse_shape * bond.reference);
      first.add(ga);
      second.add(gb);
      family.push_back({bond, block, ga.norm(), gb.norm()});
    });
    const auto [waa, wab, wbb] = family_curvature(i);
    const double per_first = body_.volume[i] * (waa * first.row() + wab * second.row());
    const double per_second = body_.volume[i] * (wab * first.row() + wbb * second.row());
    bound[i] += per_first * first.sum.norm() + per_second * second.sum.norm();
    for (const BondBound& b : family) {
      bound[i] += 2 * b.block;
      add_far_bound(b.bond, 2 * b.block + per_first * b.first + per_second * b.second, bound);
    }
  }
  for (std::size_t i = 0; i < body_.lattice.size(); ++i) bound[body_.lattice.size() + i] = bound[i];
}

/// Adds to the row bound of a bond's far end.
void Membrane::add_far_bound(const MembraneBond& bond, double row, std::span<double> bound) const {
  if (bond.inclusion < 0) {
    bound[bond.neighbour] += row;
    return;
  }
  const auto inclusion = static_cast<std::size_t>(bond.inclusion);
  const std::size_t dof = inclusion_dof(inclusion);
  const double lever = bond.arm.norm() / inclusions_[inclusion].gyration;
  // The bond's end moves by the translation and by the lever times the rotation's entry: each row has both.
  bound[dof] += row * (1 + lever);
  bound[dof + 1] += row * (1 + lever);
  bound[dof + 2] += row * lever * (1 + lever);
}

}  // namespace riven
