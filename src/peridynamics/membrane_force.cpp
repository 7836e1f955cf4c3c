// Forces of the membrane: what the kernels do for the points whose weights have a formula, then the others.

#include <Eigen/LU>

#include "base/parallel.hpp"
#include "peridynamics/family_energy.hpp"
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
}

void Membrane::set_point(std::size_t point, double energy, const PointForce& force) {
  planes_.energy_density[point] = energy;
  if (body().on_lattice() != nullptr) {
    lattice_.set_law(point, force);
  } else {
    list_.set_law(point, force);
  }
}

void Membrane::respond_listed(const ListedFamily& family, std::span<const double> u) {
  const std::size_t i = family.point;
  if (family.begin == family.end) {
    planes_.mean_s2[i] = planes_.mean_s4[i] = 1;
    for (std::size_t c = 0; c < 4; ++c) planes_.mean_gradient[c][i] = c % 3 == 0 ? 0.5 : 0;
    return set_point(i, 0, {});
  }
  double a = 0, b = 0;
  Eigen::Matrix2d m = Eigen::Matrix2d::Zero();
  for (std::size_t n = family.begin; n < family.end; ++n) {
    const MembraneBond bond = listed_bond(n);
    const Eigen::Vector2d y = deformed(i, bond, u);
    const double inverse2 = 1 / bond.reference.squaredNorm();
    const double s2 = y.squaredNorm() * inverse2;
    a += bond.weight * s2;
    b += bond.weight * s2 * s2;
    m += bond.weight * inverse2 * y * bond.reference.transpose();
  }
  planes_.mean_s2[i] = a;
  planes_.mean_s4[i] = b;
  const Eigen::Matrix2d f =
      family.by_gradient ? Eigen::Matrix2d(m * family.inverse_shape) : Eigen::Matrix2d(2 * m);
  const auto half_f = entries(0.5 * f);  // as for the points of the formula
  for (std::size_t c = 0; c < 4; ++c) planes_.mean_gradient[c][i] = half_f[c];
  const double v = body().volume[i], kappa = planes_.kappa[i];
  const double z2 = a - f.cwiseProduct(m).sum();  // mean of |Y - F xi|^2 / |xi|^2
  if (family.by_gradient) {
    planes_.mean_s4[i] =
        0.5 * (3 * a * a - f.determinant() * f.determinant());  // so that (7) tells a collapse here too
    const PlaneResponse response = material_.plane_stress(f);
    set_point(i, response.energy + kappa * z2,
              {2 * v * kappa, 0, entries(v * (response.stress * family.inverse_shape - 2 * kappa * f))});
  } else {
    const FamilyEnergy e = std::visit([&](const auto& law) { return family_energy(law, a, b); }, law_);
    const FamilyEnergy k = stiffened_modulus(kappa, a, b);
    set_point(i, e.w + k.w * z2,
              {2 * v * (e.wa + k.w + k.wa * z2), 4 * v * (e.wb + k.wb * z2), entries(-2 * v * k.w * f)});
  }
}

std::optional<Breakdown> Membrane::first_collapsed() const {
  const auto is_collapsed = [&](std::size_t i) { return collapsed(planes_.mean_s2[i], planes_.mean_s4[i]); };
  if (collapsed_ == 0 && std::none_of(listed_.begin(), listed_.end(),
                                      [&](const ListedFamily& family) { return is_collapsed(family.point); }))
    return std::nullopt;
  const auto first = std::find_if(body().points.begin(), body().points.end(), is_collapsed);
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
