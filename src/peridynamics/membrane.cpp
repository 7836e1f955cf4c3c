#include "peridynamics/membrane.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/lanes.hpp"
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
    : PointModel(std::move(body), {material.density}),
      material_(std::move(material)),
      law_(law_of(material_)),
      stabilisation_(stabilisation),
      kernels_(membrane_kernels()) {
  if (this->body().dimension != 2)
    throw InputError("a membrane is two-dimensional: give the box two sizes and a thickness");
  const std::size_t n = this->body().size();
  planes_.volume = this->body().volume.data();
  for (auto* plane :
       {&planes_.kappa, &planes_.mean_s2, &planes_.mean_s4, &planes_.energy_density, &smallest_weight_})
    plane->assign(n, 0.0);
  for (auto& plane : planes_.mean_gradient) plane.assign(n, 0.0);
  look_at_bonds();
  make_families();
  sort_incoming();
}

/// Shows the kernels the body's bonds.
void Membrane::look_at_bonds() {
  const std::size_t n = body().size();
  if (const auto* list = std::get_if<ListedBonds>(&body().bonds)) {
    list_.begin = list->begin.data();
    list_.neighbour = list->neighbour.data();
    list_.masks = list->masks.data();
    list_.points.resize(n);
    for (std::size_t i = 0; i < n; ++i) list_.points[i].x = {list->position[i][0], list->position[i][1]};
    return;
  }
  const LatticeBonds& on = *body().on_lattice();
  lattice_.masks = on.bonds.masks(0);
  for (std::size_t block = 0; block < n / kLanes; ++block) lattice_.blocks.push_back(on.bonds.kind(block));
  for (std::size_t k = 0; k < on.stencil.size(); ++k) {
    const PlaneBond bond{on.stencil.bond[k][0], on.stencil.bond[k][1]};
    const double length = on.stencil.length[k];
    Moments weight = WeightFormula::terms(angular_functions(bond));
    for (double& w : weight) w /= length * length * length;
    lattice_.stencil.push_back({on.stencil.shift[k], bond.x, bond.y, 1 / (length * length), weight});
  }
  for (auto* plane : {&lattice_.a, &lattice_.b}) plane->assign(n, 0.0);
  for (auto& plane : lattice_.coefficient) plane.assign(n, 0.0);
  for (auto& plane : lattice_.n) plane.assign(n, 0.0);
}

Moments Membrane::coefficients(std::size_t point) const {
  if (body().on_lattice() == nullptr) return list_.points[point].coefficient;
  Moments c{};
  for (std::size_t m = 0; m < kMoments; ++m) c[m] = lattice_.coefficient[m][point];
  return c;
}

void Membrane::set_coefficients(std::size_t point, const Moments& coefficients) {
  if (body().on_lattice() == nullptr) {
    list_.points[point].coefficient = coefficients;
    return;
  }
  for (std::size_t m = 0; m < kMoments; ++m) lattice_.coefficient[m][point] = coefficients[m];
}

/// A block stays intact only where its points and all their neighbours have the weights of a whole family.
void Membrane::find_intact_blocks(const Moments& whole) {
  for (MembraneBondOffset& bond : lattice_.stencil) {
    bond.whole_weight = 0;
    for (std::size_t m = 0; m < kMoments; ++m) bond.whole_weight += whole[m] * bond.weight[m];
  }
  const auto is_whole = [&](std::size_t i) { return coefficients(i) == whole; };
  for (std::size_t i = 0; i < body().size(); ++i) {
    BlockKind& kind = lattice_.blocks[i / kLanes];
    if (kind != BlockKind::intact) continue;
    bool sound = is_whole(i);
    body().for_each_neighbour(i, [&](std::size_t j) { sound = sound && is_whole(j); });
    if (!sound) kind = BlockKind::partial;
  }
}

/// Bonds of a point without weights: those to other points, then those that end on inclusions.
std::vector<MembraneBond> Membrane::bonds_of(std::size_t point) const {
  std::vector<MembraneBond> bonds;
  const Eigen::Vector2d x = plane(body().position(point));
  body().for_each_neighbour(point, [&](std::size_t j) {
    bonds.push_back({plane(body().position(j)) - x, 0, static_cast<End>(j), -1});
  });
  for (const InterfaceBond& bond : body().interface_of(point))
    bonds.push_back({plane(bond.end) - x, 0,
                     end_of(static_cast<std::size_t>(&bond - body().interface.data())),
                     static_cast<int>(bond.inclusion)});
  return bonds;
}

/// Directions of a family at its whole lengths: a bond to an inclusion keeps the weight that it had
/// before it was shortened (theory 5a, rule 4). The order is that of `bonds_of`.
std::vector<PlaneBond> Membrane::unshortened_bonds_of(std::size_t point) const {
  std::vector<PlaneBond> bonds;
  const Point x = body().position(point);
  const auto add = [&](std::size_t j) {
    const Point y = body().position(j);
    bonds.push_back({y[0] - x[0], y[1] - x[1]});
  };
  body().for_each_neighbour(point, add);
  for (const InterfaceBond& bond : body().interface_of(point)) add(bond.neighbour);
  return bonds;
}

double Membrane::stabilisation_modulus(std::size_t point) const {
  return stabilisation_ * 0.5 * material_.small_strain().shear *
         (body().complete[point] ? 1.0 : kCutFamilyStabilisation);
}

void Membrane::make_families() {
  FamilyWeights whole;  // most points of a lattice have the whole stencil: solve for it once
  for (const std::size_t i : body().points) {
    planes_.kappa[i] = stabilisation_modulus(i);
    const bool at_interface = !body().interface_of(i).empty();
    const bool is_whole = body().complete[i] && !at_interface && body().on_lattice() != nullptr;
    FamilyWeights weights =
        is_whole && !whole.weight.empty() ? whole : moment_corrected_weights(unshortened_bonds_of(i));
    if (is_whole && whole.weight.empty()) whole = weights;
    smallest_weight_[i] = weights.smallest_ratio;
    if (weights.kind == FamilyWeights::Kind::smooth && !at_interface) {
      set_coefficients(i, WeightFormula::coefficients(weights.coefficients));
    } else {
      add_listed_family(i, weights, bonds_of(i));
    }
  }
  if (body().on_lattice() != nullptr) find_intact_blocks(WeightFormula::coefficients(whole.coefficients));
}

void Membrane::add_listed_family(std::size_t point, const FamilyWeights& weights,
                                 std::vector<MembraneBond> bonds) {
  ListedFamily family;
  family.point = point;
  family.by_least_squares = weights.kind == FamilyWeights::Kind::listed;
  family.by_gradient = weights.kind == FamilyWeights::Kind::gradient;
  Eigen::Matrix2d shape = Eigen::Matrix2d::Zero();
  for (std::size_t j = 0; j < bonds.size(); ++j) {
    bonds[j].weight = weights.weight[j];
    const Eigen::Vector2d n = bonds[j].reference.normalized();
    shape += weights.weight[j] * n * n.transpose();
  }
  if (family.by_gradient && shape.determinant() < kFlatFamily) {
    family.by_gradient = false;  // no weights, no gradient: the point hangs on its neighbours' forces alone
    bonds.clear();
  }
  if (family.by_gradient) family.inverse_shape = shape.inverse();
  ListedFamilyBonds& list = listed_bonds_;
  family.begin = list.end.size();
  for (const MembraneBond& bond : bonds) {
    list.x.push_back(bond.reference.x());
    list.y.push_back(bond.reference.y());
    list.weight.push_back(bond.weight);
    list.end.push_back(bond.end);
  }
  family.end = list.end.size();
  listed_.push_back(family);
}

/// Sorts the bonds of the listed families by their far ends.
void Membrane::sort_incoming() {
  ListedFamilyBonds& list = listed_bonds_;
  list.force_x.assign(list.end.size(), 0.0);
  list.force_y.assign(list.end.size(), 0.0);
  std::vector<std::size_t> count(body().size(), 0);
  for (std::uint32_t b = 0; b < list.end.size(); ++b) {
    if (is_surface(list.end[b])) {
      list.surface.push_back(b);
    } else {
      ++count[list.end[b]];
    }
  }
  list.incoming_begin.push_back(0);
  std::vector<std::size_t> next(body().size(), 0);
  for (std::size_t i = 0; i < body().size(); ++i) {
    if (count[i] == 0) continue;
    next[i] = list.incoming_begin.back();
    list.target.push_back(static_cast<std::uint32_t>(i));
    list.incoming_begin.push_back(next[i] + count[i]);
  }
  list.incoming.resize(list.incoming_begin.back());
  for (std::uint32_t b = 0; b < list.end.size(); ++b)
    if (!is_surface(list.end[b])) list.incoming[next[list.end[b]]++] = b;
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
  return {fmt::format("weights: {} points by least squares, {} by the deformation gradient",
                      points_by_least_squares(), points_by_gradient())};
}

std::size_t Membrane::bytes() const {
  const std::size_t planes = 9 + (body().on_lattice() != nullptr ? kMoments + 6 : 0);
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
    return body().volume[i] * planes_.energy_density[i];
  });
}

std::optional<Breakdown> Membrane::inspect(std::span<const double> u) {
  update_points(u);
  if (auto breakdown = first_collapsed()) return breakdown;
  const auto& g = planes_.mean_gradient;
  for (const std::size_t i : body().points)
    if (!(g[0][i] * g[3][i] - g[1][i] * g[2][i] > 0))
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
    energy.values.push_back(planes_.energy_density[i]);
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
  const FamilyEnergy e = std::visit([&](const auto& law) { return family_energy(law, a, b); }, law_);
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
    const double per_first = body().volume[i] * (waa * first.row() + wab * second.row());
    const double per_second = body().volume[i] * (wab * first.row() + wbb * second.row());
    const double per_modulus = body().volume[i] * inhomogeneity.row();
    const double per_inhomogeneity = body().volume[i] * modulus.row();
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
