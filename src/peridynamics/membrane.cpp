#include "peridynamics/membrane.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "peridynamics/family_energy.hpp"

namespace riven {

namespace {

// Where the family is cut, short waves are held by fewer bonds and a full stabilisation would stiffen edges (5a, 5).
constexpr double kCutFamilyStabilisation = 0.1;

Eigen::Vector2d plane(const Point& p) { return {p[0], p[1]}; }

Eigen::Vector2d rotated(const Eigen::Vector2d& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

}  // namespace

Membrane::Membrane(LatticeBody body, Material material, double stabilisation)
    : body_(std::move(body)), material_(std::move(material)), stabilisation_(stabilisation) {
  if (body_.lattice.dimension() != 2) throw InputError("a membrane is two-dimensional: give the box two sizes and a thickness");
  spacing_ = body_.lattice.spacing();
  const std::size_t n = body_.lattice.size();
  for (auto* plane : {&kappa_, &mean_s2_, &mean_s4_, &energy_density_, &force_a_, &force_b_}) plane->assign(n, 0.0);
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
      bonds.push_back({{stencil_[k].x, stencil_[k].y}, 0, BondPlanes::neighbour(body_.stencil, k, point), -1, {0, 0}});
  const auto first = std::lower_bound(body_.interface.begin(), body_.interface.end(), point,
                                      [](const InterfaceBond& bond, std::size_t p) { return bond.point < p; });
  const Eigen::Vector2d x = plane(body_.lattice.position(point));
  for (auto bond = first; bond != body_.interface.end() && bond->point == point; ++bond) {
    const Eigen::Vector2d end = plane(bond->end);
    bonds.push_back({end - x, 0, 0, static_cast<int>(bond->inclusion), end - inclusions_[bond->inclusion].center});
  }
  return bonds;
}

/// Directions of a family at the lattice's own lengths: a bond to an inclusion keeps the weight that it had before it
/// was shortened (theory 5a, rule 4).
static std::vector<PlaneBond> unshortened(const LatticeBody& body, std::size_t point) {
  std::vector<PlaneBond> bonds;
  for (std::size_t k = 0; k < body.stencil.size(); ++k)
    if (body.bonds.exists(k, point)) bonds.push_back({body.stencil.bond[k][0], body.stencil.bond[k][1]});
  for (const InterfaceBond& bond : body.interface)
    if (bond.point == point) bonds.push_back({body.stencil.bond[bond.offset][0], body.stencil.bond[bond.offset][1]});
  return bonds;
}

double Membrane::stabilisation_modulus(std::size_t point) const {
  const bool whole = body_.family_size(point) == body_.stencil.size();
  return stabilisation_ * 0.5 * shear_modulus(material_.law) * (whole ? 1.0 : kCutFamilyStabilisation);
}

void Membrane::make_families() {
  std::vector<bool> at_interface(body_.lattice.size(), false);
  for (const InterfaceBond& bond : body_.interface) at_interface[bond.point] = true;
  FamilyWeights whole;  // most points have the whole stencil: solve for it once
  for (const std::size_t i : body_.points) {
    kappa_[i] = stabilisation_modulus(i);
    const std::size_t size = body_.family_size(i);
    directed_bonds_ += size;
    const bool is_whole = size == body_.stencil.size() && !at_interface[i];
    FamilyWeights weights = is_whole && !whole.weight.empty() ? whole : moment_corrected_weights(unshortened(body_, i));
    if (is_whole && whole.weight.empty()) whole = weights;
    if (weights.kind == FamilyWeights::Kind::smooth && !at_interface[i]) {
      for (std::size_t m = 0; m < kMoments; ++m) coefficient_[m][i] = weights.coefficients[m];
      continue;
    }
    ListedFamily family;
    family.point = i;
    family.by_gradient = weights.kind == FamilyWeights::Kind::gradient;
    family.bonds = bonds_of(i);
    Eigen::Matrix2d shape = Eigen::Matrix2d::Zero();
    for (std::size_t j = 0; j < family.bonds.size(); ++j) {
      family.bonds[j].weight = weights.weight[j];
      const Eigen::Vector2d n = family.bonds[j].reference.normalized();
      shape += weights.weight[j] * n * n.transpose();
    }
    if (family.by_gradient) family.inverse_shape = shape.inverse();
    listed_index_[i] = static_cast<std::ptrdiff_t>(listed_.size());
    listed_.push_back(std::move(family));
  }
}

std::vector<MembraneBond> Membrane::family(std::size_t point) const {
  if (listed_index_[point] >= 0) return listed_[static_cast<std::size_t>(listed_index_[point])].bonds;
  std::vector<MembraneBond> bonds;
  for (std::size_t k = 0; k < stencil_.size(); ++k) {
    if (!body_.bonds.exists(k, point)) continue;
    double weight = 0;
    for (std::size_t m = 0; m < kMoments; ++m) weight += coefficient_[m][point] * stencil_[k].weight[m];
    bonds.push_back({{stencil_[k].x, stencil_[k].y}, weight, BondPlanes::neighbour(body_.stencil, k, point), -1, {0, 0}});
  }
  return bonds;
}

Eigen::Vector2d Membrane::deformed(std::size_t point, const MembraneBond& bond, std::span<const double> u) const {
  const std::size_t n = body_.lattice.size();
  const Eigen::Vector2d here(u[point], u[n + point]);
  if (bond.inclusion < 0) return bond.reference + Eigen::Vector2d(u[bond.neighbour], u[n + bond.neighbour]) - here;
  const auto inclusion = static_cast<std::size_t>(bond.inclusion);
  const std::size_t dof = inclusion_dof(inclusion);
  const double angle = u[dof + 2] / inclusions_[inclusion].gyration;
  return bond.reference + Eigen::Vector2d(u[dof], u[dof + 1]) + rotated(bond.arm, angle) - bond.arm - here;
}

std::size_t Membrane::dofs() const { return 2 * body_.lattice.size() + 3 * inclusions_.size(); }

std::size_t Membrane::inclusion_dof(std::size_t inclusion) const { return 2 * body_.lattice.size() + 3 * inclusion; }

std::size_t Membrane::points_by_gradient() const {
  return static_cast<std::size_t>(
      std::count_if(listed_.begin(), listed_.end(), [](const ListedFamily& family) { return family.by_gradient; }));
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
      return Breakdown{body_.lattice.position(i),
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
      u[inclusion_dof(c) + axis] += displacement({inclusions_[c].center.x(), inclusions_[c].center.y(), 0}, axis);
  }
}

std::vector<Point> Membrane::positions() const {
  std::vector<Point> positions;
  positions.reserve(body_.points.size());
  for (const std::size_t i : body_.points) positions.push_back(body_.lattice.position(i));
  return positions;
}

std::vector<ModelField> Membrane::fields(std::span<const double> u) {
  update_points(u);
  const std::size_t n = body_.lattice.size();
  ModelField displacement{"displacement", 3, {}}, damage{"damage", 1, {}}, energy{"strain_energy_density", 1, {}},
      stress{"nominal_stress", 9, {}};
  for (const std::size_t i : body_.points) {
    displacement.values.insert(displacement.values.end(), {u[i], u[n + i], 0.0});
    damage.values.push_back(1.0 - static_cast<double>(body_.family_size(i)) / body_.whole_family[i]);
    energy.values.push_back(energy_density_[i]);
    const PointForce law = point_force(i);
    Eigen::Matrix2d p = Eigen::Matrix2d::Zero();
    for (const MembraneBond& bond : family(i)) {
      const Eigen::Vector2d y = deformed(i, bond, u);
      const double inverse2 = 1 / bond.reference.squaredNorm();
      p += bond.weight * inverse2 *
           ((law.a + law.b * y.squaredNorm() * inverse2) * y + law.n * bond.reference) * bond.reference.transpose();
    }
    p /= body_.volume[i];
    stress.values.insert(stress.values.end(), {p(0, 0), p(0, 1), 0, p(1, 0), p(1, 1), 0, 0, 0, 0});
  }
  return {displacement, damage, energy, stress};
}

/// Bounds the tangent of one point's energy bond by bond. `per_bond` gets a bound for the rows of each far end; returned is
/// the bound for the point's own rows. The family term is written in (a, b - 2 a0 a), a0 the present a: in a homogeneous
/// state its second part vanishes, where a and b alone would cancel to nothing from large numbers.
double Membrane::bond_stiffness_sum(std::size_t point, std::span<const double> u, std::vector<double>& per_bond) const {
  const std::vector<MembraneBond> bonds = family(point);
  const PointForce law = point_force(point);
  const double a = mean_s2_[point], b = mean_s4_[point], v = body_.volume[point];
  const bool by_gradient =
      listed_index_[point] >= 0 && listed_[static_cast<std::size_t>(listed_index_[point])].by_gradient;

  struct FamilyTerm {
    Eigen::Vector2d sum{0, 0};
    double norms = 0;
    void add(const Eigen::Vector2d& g) {
      sum += g;
      norms += g.norm();
    }
    [[nodiscard]] double total() const { return norms + sum.norm(); }
  };
  FamilyTerm first, second;
  std::vector<std::array<double, 2>> norm;
  double own = 0;
  per_bond.clear();
  for (const MembraneBond& bond : bonds) {
    const Eigen::Vector2d y = deformed(point, bond, u);
    const double inverse2 = 1 / bond.reference.squaredNorm();
    const double s2 = y.squaredNorm() * inverse2;
    const double block = bond.weight * inverse2 * (std::abs(law.a + law.b * s2) + 2 * std::abs(law.b) * s2);
    per_bond.push_back(2 * block);
    own += 2 * block;
    const Eigen::Vector2d ga = 2 * bond.weight * inverse2 * y;
    const Eigen::Vector2d gb = 2 * (s2 - a) * ga;
    first.add(ga);
    second.add(gb);
    norm.push_back({ga.norm(), gb.norm()});
  }
  double waa = 0, wab = 0, wbb = 0;
  if (by_gradient) {
    // The energy is a function of F; its tangent is bounded through the stretches of the same family.
    Eigen::Matrix2d f;
    f << mean_gradient_[0][point], mean_gradient_[1][point], mean_gradient_[2][point], mean_gradient_[3][point];
    waa = material_.plane_stress(2 * f).tangent.norm() / a;
  } else {
    const FamilyEnergy e = std::visit([&](const auto& w) { return family_energy(w, a, b); }, material_.law);
    waa = std::abs(e.waa + 4 * a * e.wab + 4 * a * a * e.wbb);
    wab = std::abs(e.wab + 2 * a * e.wbb);
    wbb = std::abs(e.wbb);
  }
  const double per_first = v * (waa * first.total() + wab * second.total());
  const double per_second = v * (wab * first.total() + wbb * second.total());
  for (std::size_t j = 0; j < bonds.size(); ++j) per_bond[j] += per_first * norm[j][0] + per_second * norm[j][1];
  return own + per_first * first.sum.norm() + per_second * second.sum.norm();
}

void Membrane::stiffness_bound(std::span<const double> u, std::span<double> bound) {
  update_points(u);
  std::fill(bound.begin(), bound.end(), 0.0);
  const std::size_t n = body_.lattice.size();
  std::vector<double> per_bond;
  for (const std::size_t i : body_.points) {
    bound[i] += bond_stiffness_sum(i, u, per_bond);
    const std::vector<MembraneBond> bonds = family(i);
    for (std::size_t j = 0; j < bonds.size(); ++j) {
      if (bonds[j].inclusion < 0) {
        bound[bonds[j].neighbour] += per_bond[j];
        continue;
      }
      const auto inclusion = static_cast<std::size_t>(bonds[j].inclusion);
      const std::size_t dof = inclusion_dof(inclusion);
      bound[dof] += per_bond[j];
      bound[dof + 1] += per_bond[j];
      const double lever = bonds[j].arm.norm() / inclusions_[inclusion].gyration;
      bound[dof + 2] += per_bond[j] * std::max(lever, lever * lever);
    }
  }
  for (std::size_t i = 0; i < n; ++i) bound[n + i] = bound[i];
}

}  // namespace riven
