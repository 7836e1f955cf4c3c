#include "peridynamics/membrane.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/lanes.hpp"
#include "base/parallel.hpp"

namespace riven {

namespace {

/// From its entries row by row.
Eigen::Matrix2d matrix(const std::array<double, 4>& entries) {
  return Eigen::Map<const Eigen::Matrix<double, 2, 2, Eigen::RowMajor>>(entries.data());
}

InvariantLaw law_of(const Material& material) {
  const auto law = invariant_law(material.law);
  if (!law || !material.incompressible())
    throw InputError("a membrane is incompressible, with a law W(I1, I2)");
  return *law;
}

}  // namespace

Membrane::Membrane(Body body, Material material, double stabilisation)
    : BreakingModel(std::move(body), {material.density}),
      material_(std::move(material)),
      law_(law_of(material_)),
      stabilisation_(stabilisation),
      kernels_(membrane_kernels()) {
  if (this->body().dimension != 2)
    throw InputError("a membrane is two-dimensional: give the box two sizes and a thickness");
  const std::size_t n = this->body().size();
  energy_volume_ = this->body().volume;
  planes_.volume = energy_volume_.data();
  for (auto* plane : {&planes_.kappa, &planes_.mean_s2, &planes_.mean_s4, &planes_.energy_density,
                      &smallest_weight_, &base_weight_, &base_trace_})
    plane->assign(n, 0.0);
  for (auto& plane : planes_.mean_gradient) plane.assign(n, 0.0);
  look_at_bonds();
  make_families();
  sort_incoming();
}

MembraneBond Membrane::listed_bond(std::size_t number) const {
  const ListedFamilyBonds& list = listed_bonds_;
  const End end = list.end[number];
  return {{list.x[number], list.y[number]},
          list.weight[number],
          end,
          is_surface(end) ? static_cast<int>(body().interface[end - body().size()].inclusion) : -1};
}

Eigen::Vector2d Membrane::deformed(std::size_t point, const MembraneBond& bond,
                                   std::span<const double> u) const {
  return bond.reference + displacement(bond.end, u) - Eigen::Vector2d(u[point], u[body().size() + point]);
}

Eigen::Vector2d Membrane::bond_force(const PointForce& law, const MembraneBond& bond,
                                     const Eigen::Vector2d& y) {
  const double inverse2 = 1 / bond.reference.squaredNorm();
  return bond.weight * inverse2 *
         ((law.a + law.b * y.squaredNorm() * inverse2) * y + matrix(law.n) * bond.reference);
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
  std::vector<std::string> lines = {
      fmt::format("weights: {} points by least squares, {} by the deformation gradient",
                  points_by_least_squares(), points_by_gradient())};
  for (std::string& line : describe_limits()) lines.push_back(std::move(line));
  return lines;
}

std::size_t Membrane::bytes() const {
  const std::size_t planes = 12 + (body().on_lattice() != nullptr ? kMoments + 6 : 0);
  constexpr std::size_t per_bond = 5 * sizeof(double) + 2 * sizeof(End);
  return body().bytes() + body().size() * planes * sizeof(double) + lattice_.blocks.size() +
         list_.points.size() * sizeof(MembranePoint) + listed_.size() * sizeof(ListedFamily) +
         listed_bonds_.end.size() * per_bond +
         listed_bonds_.target.size() * (sizeof(End) + sizeof(std::size_t));
}

double Membrane::strain_energy(std::span<const double> u) {
  update_points(u);
  return ordered_sum_of(body().points.size(), [&](std::size_t n) {
    const std::size_t i = body().points[n];
    return energy_volume_[i] * planes_.energy_density[i];
  });
}

std::optional<Breakdown> Membrane::inspect(std::span<const double> u) {
  update_points(u);
  if (auto breakdown = first_collapsed()) return breakdown;
  const auto& g = planes_.mean_gradient;
  for (const std::size_t i : body().points)
    if (is_sound(i) && !(g[0][i] * g[3][i] - g[1][i] * g[2][i] > 0))
      return Breakdown{
          body().position(i),
          "the sheet has folded over itself: the deformation gradient of a point has a determinant <= 0"};
  return std::nullopt;
}

Eigen::Matrix2d Membrane::nominal_stress(std::size_t point, std::span<const double> u) const {
  const PointForce law = point_force(point);
  Eigen::Matrix2d stress = Eigen::Matrix2d::Zero();
  for_each_bond(point, [&](const MembraneBond& bond) {
    stress += bond_force(law, bond, deformed(point, bond, u)) * bond.reference.transpose();
  });
  return stress / body().volume[point];
}

std::vector<ModelField> Membrane::fields(std::span<const double> u) {
  update_points(u);
  ModelField energy{"strain_energy_density", 1, {}, "J/m^3"}, stress{"nominal_stress", 9, {}, "Pa"},
      weight{"weight_minimum", 1, {}, {}};
  for (const std::size_t i : body().points) {
    energy.values.push_back(energy_share(i) * planes_.energy_density[i]);
    weight.values.push_back(smallest_weight_[i]);
    const Eigen::Matrix2d p = nominal_stress(i, u);
    stress.values.insert(stress.values.end(), {p(0, 0), p(0, 1), 0, p(1, 0), p(1, 1), 0, 0, 0, 0});
  }
  const std::size_t shown = positions().size();
  for (ModelField* field : {&energy, &stress, &weight})  // rigid points have none of these
    field->values.resize(shown * static_cast<std::size_t>(field->components), 0.0);
  return {damage(), std::move(energy), std::move(stress), std::move(weight)};
}

/// Half of the deformation gradient of a point's family.
Eigen::Matrix2d Membrane::gradient(std::size_t point) const {
  const auto& g = planes_.mean_gradient;
  return matrix({g[0][point], g[1][point], g[2][point], g[3][point]});
}

const Membrane::ListedFamily* Membrane::listed_family(std::size_t point) const {
  const auto found = std::lower_bound(
      listed_.begin(), listed_.end(), point,
      [](const ListedFamily& family, std::size_t of_point) { return family.point < of_point; });
  return found != listed_.end() && found->point == point ? &*found : nullptr;
}

bool Membrane::by_gradient(std::size_t point) const {
  const ListedFamily* family = listed_family(point);
  return family != nullptr && family->by_gradient;
}

/// Bounds of the second derivatives of a point's energy in its family sums, over the volume: by (a, b - 2 a0
/// a), a0 the present a. In a homogeneous state the second of these does not move, while in a and b alone
/// large numbers would cancel.
std::array<double, 3> Membrane::family_curvature(std::size_t point) const {
  const double a = planes_.mean_s2[point], b = planes_.mean_s4[point];
  if (by_gradient(point)) {  // the energy is a function of F, and the one sum is F itself
    return {material_.plane_stress(2 * gradient(point)).tangent.norm(), 0, 0};
  }
  const FamilyEnergy e = energy_by_averages(a, b);
  const FamilyEnergy k = stiffened_modulus(planes_.kappa[point], a, b);
  const double z2 = a - 2 * gradient(point).squaredNorm();
  const double waa = e.waa + z2 * k.waa, wab = e.wab + z2 * k.wab, wbb = e.wbb + z2 * k.wbb;
  return {std::abs(waa + 4 * a * wab + 4 * a * a * wbb), std::abs(wab + 2 * a * wbb), std::abs(wbb)};
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
    double block;                   // N/m
    double first, second;           // lengths of the gradients of the family sums (1/m)
    double modulus, inhomogeneity;  // of the stabilisation's two factors (Pa/m, 1/m)
  };
  std::vector<BondBound> family;
  for (const std::size_t i : body().points) {
    const PointForce law = point_force(i);
    const ListedFamily* gradient_family = by_gradient(i) ? listed_family(i) : nullptr;
    const FamilyEnergy kappa =
        gradient_family != nullptr
            ? FamilyEnergy{}
            : stiffened_modulus(planes_.kappa[i], planes_.mean_s2[i], planes_.mean_s4[i]);
    const Eigen::Matrix2d f = 2 * gradient(i);
    FamilySum first, second, modulus, inhomogeneity;
    family.clear();
    for_each_bond(i, [&](const MembraneBond& bond) {
      const Eigen::Vector2d y = deformed(i, bond, u);
      const double inverse2 = 1 / bond.reference.squaredNorm(), s2 = y.squaredNorm() * inverse2;
      const double block = bond.weight * inverse2 * (std::abs(law.a + law.b * s2) + 2 * std::abs(law.b) * s2);
      Eigen::Vector2d ga = 2 * bond.weight * inverse2 * y;
      const Eigen::Vector2d gb = 2 * (s2 - planes_.mean_s2[i]) * ga;
      // F moves by an end's displacement times this; long where the bonds lie nearly on one line.
      if (gradient_family != nullptr)
        ga = bond.weight * inverse2 * (gradient_family->inverse_shape * bond.reference);
      first.add(ga);
      second.add(gb);
      const Eigen::Vector2d gk = (kappa.wa + 2 * s2 * kappa.wb) * ga;
      const Eigen::Vector2d gz = 2 * bond.weight * inverse2 * (y - f * bond.reference);
      modulus.add(gk);
      inhomogeneity.add(gz);
      family.push_back({bond, block, ga.norm(), gb.norm(), gk.norm(), gz.norm()});
    });
    const auto [waa, wab, wbb] = family_curvature(i);
    const double per_first = energy_volume_[i] * (waa * first.row() + wab * second.row());
    const double per_second = energy_volume_[i] * (wab * first.row() + wbb * second.row());
    const double per_modulus = energy_volume_[i] * inhomogeneity.row();
    const double per_inhomogeneity = energy_volume_[i] * modulus.row();
    double own = per_first * first.sum.norm() + per_second * second.sum.norm() +
                 per_modulus * modulus.sum.norm() + per_inhomogeneity * inhomogeneity.sum.norm();
    for (const BondBound& b : family) {
      own += 2 * b.block;
      add_row(b.bond.end,
              2 * b.block + per_first * b.first + per_second * b.second + per_modulus * b.modulus +
                  per_inhomogeneity * b.inhomogeneity,
              bound);
    }
    add_row(static_cast<End>(i), own, bound);
  }
}

}  // namespace riven
