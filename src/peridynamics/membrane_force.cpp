// Forces of the membrane: what the kernels do for the points whose weights have a formula, then the others.

#include <Eigen/LU>
#include <algorithm>

#include "base/parallel.hpp"
#include "peridynamics/membrane.hpp"

namespace riven {

namespace {

constexpr std::size_t kPiece = 256;  // points that a thread takes at a time

/// Entries row by row.
std::array<double, 4> entries(const Eigen::Matrix2d& m) {
  return {m(0, 0), m(0, 1), m(1, 0), m(1, 1)};
}

}  // namespace

/// Energies and force laws of all points.
void Membrane::update_points(std::span<const double> u) {
  place_inclusions(u);
  const std::size_t size = body().size();
  lattice_.u = {u.data(), u.data() + size};
  parallel_pieces(list_.points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) list_.points[i].u = {u[i], u[size + i]};
  });
  collapsed_ = ordered_sum<std::size_t>(
      size,
      [&](std::size_t begin, std::size_t end) {
        return body().on_lattice() != nullptr ? kernels_.lattice.respond(law_, lattice_, planes_, begin, end)
                                              : kernels_.list.respond(law_, list_, planes_, begin, end);
      },
      kPiece);
  parallel_for(static_cast<std::ptrdiff_t>(listed_.size()),
               [&](std::ptrdiff_t n) { respond_listed(listed_[static_cast<std::size_t>(n)], u); });
  find_crushed();
}

void Membrane::set_point(std::size_t point, double energy, const PointForce& force) {
  planes_.energy_density[point] = energy;
  if (body().on_lattice() != nullptr) {
    lattice_.set_law(point, force);
  } else {
    list_.set_law(point, force);
  }
}

Membrane::FamilyAverages Membrane::averages(std::size_t point, std::span<const double> u) const {
  FamilyAverages of;
  for_each_bond(point, [&](const MembraneBond& bond) {
    const Eigen::Vector2d y = deformed(point, bond, u);
    const double inverse2 = 1 / bond.reference.squaredNorm();
    const double s2 = y.squaredNorm() * inverse2;
    of.a += bond.weight * s2;
    of.b += bond.weight * s2 * s2;
    of.m += bond.weight * inverse2 * y * bond.reference.transpose();
  });
  return of;
}

/// By the averages; theory, eq. (9), and rule 5 of 5a.
Membrane::FamilyResponse Membrane::respond(std::size_t point, const FamilyAverages& of) const {
  const Eigen::Matrix2d f = 2 * of.m;
  const double v = energy_volume_[point], z2 = of.a - f.cwiseProduct(of.m).sum();
  const FamilyEnergy e = energy_by_averages(of.a, of.b);
  const FamilyEnergy k = stiffened_modulus(planes_.kappa[point], of.a, of.b);
  return {e.w + k.w * z2,
          {2 * v * (e.wa + k.w + k.wa * z2), 4 * v * (e.wb + k.wb * z2), entries(-2 * v * k.w * f)},
          f};
}

/// By the deformation gradient; theory, eq. (5).
Membrane::FamilyResponse Membrane::respond(const ListedFamily& family, const FamilyAverages& of) const {
  const Eigen::Matrix2d f = of.m * family.inverse_shape;
  const double v = energy_volume_[family.point], kappa = planes_.kappa[family.point];
  const PlaneResponse response = material_.plane_stress(f);
  return {response.energy + kappa * (of.a - f.cwiseProduct(of.m).sum()),
          {2 * v * kappa, 0, entries(v * (response.stress * family.inverse_shape - 2 * kappa * f))},
          f};
}

double Membrane::family_energy(std::size_t point, std::span<const double> u) const {
  if (energy_volume_[point] == 0) return 0;
  const ListedFamily* family = listed_family(point);
  if (family != nullptr && family->begin == family->end) return 0;
  const FamilyAverages of = averages(point, u);
  return energy_volume_[point] *
         (family != nullptr && family->by_gradient ? respond(*family, of).energy : respond(point, of).energy);
}

/// What a family holds beyond the limit a step has put into it that went too far.
double Membrane::crushed_energy(std::size_t point, std::span<const double> u) const {
  return std::min(BreakingModel::crushed_energy(point, u), body().volume[point] * most_energy_density_);
}

/// The state of a family without energy.
void Membrane::rest(std::size_t point) {
  planes_.mean_s2[point] = planes_.mean_s4[point] = 1;
  for (std::size_t c = 0; c < 4; ++c) planes_.mean_gradient[c][point] = c % 3 == 0 ? 0.5 : 0;
  set_point(point, 0, {});
}

void Membrane::respond_listed(const ListedFamily& family, std::span<const double> u) {
  const std::size_t i = family.point;
  if (family.begin == family.end) return rest(i);
  const FamilyAverages of = averages(i, u);
  const FamilyResponse response = family.by_gradient ? respond(family, of) : respond(i, of);
  planes_.mean_s2[i] = of.a;
  planes_.mean_s4[i] = of.b;
  if (family.by_gradient) {  // so that (7) tells a collapse here too
    const double j = response.f.determinant();
    planes_.mean_s4[i] = 0.5 * (3 * of.a * of.a - j * j);
  }
  const auto half_f = entries(0.5 * response.f);  // as for the points of the formula
  for (std::size_t c = 0; c < 4; ++c) planes_.mean_gradient[c][i] = half_f[c];
  set_point(i, response.energy, response.force);
}

/// In a sheet that breaks. Ahead of a crack bonds of a family differ much, and the area ratio (7), exact in
/// homogeneous states, falls far below the real one: a family that seems as compressed as where it loses
/// stability changes to its deformation gradient, which is debris when it is turned inside out or holds more
/// than a family all of whose bonds are about to break.
void Membrane::find_crushed() {
  if (!breaks()) return;
  parallel_for(static_cast<std::ptrdiff_t>(body().points.size()), [&](std::ptrdiff_t n) {
    const std::size_t i = body().points[static_cast<std::size_t>(n)];
    const double a = planes_.mean_s2[i], b = planes_.mean_s4[i];
    const bool has_collapsed = collapsed(a, b);
    const bool is_over = times_crushed(i) == 0 ? compression(a, b) > kUnstableCompression
                                               : planes_.energy_density[i] > most_energy_density_;
    const bool inside_out = !is_sound(i) && !(gradient(i).determinant() > 0);
    crushed()[i] = has_collapsed || is_over || inside_out ? 1 : 0;
    if (has_collapsed && !is_sound(i)) rest(i);
  });
}

std::optional<Breakdown> Membrane::first_collapsed() const {
  const auto is_collapsed = [&](std::size_t i) { return collapsed(planes_.mean_s2[i], planes_.mean_s4[i]); };
  if (collapsed_ == 0 && std::none_of(listed_.begin(), listed_.end(),
                                      [&](const ListedFamily& family) { return is_collapsed(family.point); }))
    return std::nullopt;
  const auto first = std::find_if(body().points.begin(), body().points.end(), is_collapsed);
  if (first == body().points.end()) return std::nullopt;  // taken care of
  return Breakdown{body().position(*first), "the sheet collapses: the area ratio of a family falls to zero"};
}

/// Forces of a listed family on its point, kept for the bonds' far ends.
void Membrane::pull_listed(const ListedFamily& family, std::span<const double> u, std::span<double> force) {
  const std::size_t i = family.point;
  const PointForce law = point_force(i);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t n = family.begin; n < family.end; ++n) {
    const MembraneBond bond = listed_bond(n);
    const Eigen::Vector2d t = bond_force(law, bond, deformed(i, bond, u));
    listed_bonds_.force_x[n] = t.x();
    listed_bonds_.force_y[n] = t.y();
    sum += t;
  }
  force[i] += sum.x();
  force[body().size() + i] += sum.y();
}

/// The opposite forces on the far ends of the listed families' bonds.
void Membrane::push_far_ends(std::span<double> force) const {
  const ListedFamilyBonds& list = listed_bonds_;
  parallel_for(static_cast<std::ptrdiff_t>(list.target.size()), [&](std::ptrdiff_t t) {
    const auto target = static_cast<std::size_t>(t);
    double x = 0, y = 0;
    for (std::size_t n = list.incoming_begin[target]; n < list.incoming_begin[target + 1]; ++n) {
      x += list.force_x[list.incoming[n]];
      y += list.force_y[list.incoming[n]];
    }
    force[list.target[target]] -= x;
    force[body().size() + list.target[target]] -= y;
  });
  for (const std::uint32_t b : list.surface)
    push_inclusion(list.end[b], -Eigen::Vector2d(list.force_x[b], list.force_y[b]), force);
}

std::optional<Breakdown> Membrane::internal_force(std::span<const double> u, std::span<double> force) {
  update_points(u);
  if (auto breakdown = first_collapsed()) return breakdown;
  const std::size_t size = body().size();
  lattice_.force = list_.force = {force.data(), force.data() + size};
  std::fill(force.begin() + static_cast<std::ptrdiff_t>(2 * size), force.end(), 0.0);
  parallel_pieces(
      size,
      [&](std::size_t begin, std::size_t end) {
        if (body().on_lattice() != nullptr) {
          kernels_.lattice.gather(lattice_, begin, end);
        } else {
          kernels_.list.gather(list_, begin, end);
        }
      },
      kPiece);
  parallel_for(static_cast<std::ptrdiff_t>(listed_.size()),
               [&](std::ptrdiff_t n) { pull_listed(listed_[static_cast<std::size_t>(n)], u, force); });
  push_far_ends(force);
  return std::nullopt;
}

}  // namespace riven
