// The loops over points and bonds of the membrane: first the averages over each family, then the forces. A
// row of the lattice is one task and writes only its own points.

#include <Eigen/LU>
#include <cmath>

#include "base/lanes.hpp"
#include "base/parallel.hpp"
#include "peridynamics/family_energy.hpp"
#include "peridynamics/membrane.hpp"

namespace riven {

namespace {

// Below this share of a^2 the squared area ratio says that the family has collapsed: far above rounding, and
// far below what sound states reach. Uniaxial stretch l has the share 4/l^3, so the 1e-3 of theory section 5
// would stop at l = 16, which points at the corners of a slot pass on fine lattices.
constexpr double kCollapse = 1e-7;

const double* at(const double* plane, std::size_t i, std::ptrdiff_t shift = 0) {
  return plane + static_cast<std::ptrdiff_t>(i) + shift;
}

struct Vector {
  Lanes x, y;
};

template <std::size_t N>
std::array<Lanes, N> load_all(const std::array<std::vector<double>, N>& planes, std::size_t i,
                              std::ptrdiff_t shift = 0) {
  std::array<Lanes, N> lanes;
  for (std::size_t n = 0; n < N; ++n) lanes[n] = load(at(planes[n].data(), i, shift));
  return lanes;
}

/// Weight of a bond of the stencil in the families of eight points, from their coefficients; eq. (10).
Lanes weight_of(const std::array<Lanes, kMoments>& coefficients, const Moments& bond) {
  Lanes weight = coefficients[0] * bond[0];
  for (std::size_t m = 1; m < kMoments; ++m) weight += coefficients[m] * bond[m];
  return weight;
}

/// u_neighbour - u_point of eight points.
Vector difference(const double* ux, const double* uy, std::size_t i, std::ptrdiff_t shift) {
  return {load(at(ux, i, shift)) - load(at(ux, i)), load(at(uy, i, shift)) - load(at(uy, i))};
}

}  // namespace

void Membrane::update_points(std::span<const double> u) {
  place_inclusions(u);
  if (const LatticeBonds* on = body().on_lattice())
    parallel_for(static_cast<std::ptrdiff_t>(on->lattice.rows()), [&](std::ptrdiff_t r) {
      const auto row = static_cast<std::size_t>(r);
      average_row(*on, row, u);
      std::visit([&](const auto& law) { respond_row(law, on->lattice, row); }, material_.law);
    });
  parallel_for(static_cast<std::ptrdiff_t>(listed_.size()),
               [&](std::ptrdiff_t n) { respond_listed(listed_[static_cast<std::size_t>(n)], u); });
}

/// Family averages of the points of a row that follow the lattice's formula.
void Membrane::average_row(const LatticeBonds& on, std::size_t row, std::span<const double> u) {
  const double* ux = u.data();
  const double* uy = ux + body().size();
  const std::size_t begin = on.lattice.row_begin(row);
  for (std::size_t i = begin; i < begin + on.lattice.row_length(); i += kLanes) {
    const auto coefficients = load_all(coefficient_, i);
    Lanes s2_sum{}, s4_sum{}, gxx{}, gxy{}, gyx{}, gyy{};
    for (std::size_t k = 0; k < stencil_.size(); ++k) {
      const std::uint8_t bits = on.bonds.masks(i / kLanes)[k];
      if (bits == 0) continue;
      const StencilBond& bond = stencil_[k];
      const Vector du = difference(ux, uy, i, bond.shift);
      const Vector y = {bond.x + du.x, bond.y + du.y};
      const Lanes w = select(expand(bits), weight_of(coefficients, bond.weight));
      const Lanes s2 = (y.x * y.x + y.y * y.y) * bond.inverse2;
      const Lanes ws2 = w * s2;
      s2_sum += ws2;
      s4_sum += ws2 * s2;
      const Lanes wx = w * (bond.x * bond.inverse2), wy = w * (bond.y * bond.inverse2);
      gxx += wx * y.x;
      gxy += wy * y.x;
      gyx += wx * y.y;
      gyy += wy * y.y;
    }
    store(mean_s2_.data() + i, s2_sum);
    store(mean_s4_.data() + i, s4_sum);
    store(mean_gradient_[0].data() + i, gxx);
    store(mean_gradient_[1].data() + i, gxy);
    store(mean_gradient_[2].data() + i, gyx);
    store(mean_gradient_[3].data() + i, gyy);
  }
}

/// Energy and force law of the points of a row, from their averages; theory eq. (9), and rule 5 of 5a.
template <class Law>
void Membrane::respond_row(const Law& law, const Lattice& lattice, std::size_t row) {
  collapsed_in_row_[row] = -1;
  const std::size_t begin = lattice.row_begin(row);
  for (std::size_t i = begin; i < begin + lattice.row_length(); ++i) {
    if (coefficient_[0][i] == 0) continue;  // no body point, or a listed one
    const double a = mean_s2_[i], b = mean_s4_[i];
    if (!(area_ratio_squared(a, b) > kCollapse * a * a)) {
      if (collapsed_in_row_[row] < 0) collapsed_in_row_[row] = static_cast<std::ptrdiff_t>(i);
      continue;
    }
    const FamilyEnergy e = family_energy(law, a, b);
    const double v = body().volume[i];
    const FamilyEnergy k = stiffened_modulus(kappa_[i], a, b);
    double gradient2 = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      gradient2 += mean_gradient_[c][i] * mean_gradient_[c][i];
      force_n_[c][i] = -4 * v * k.w * mean_gradient_[c][i];
    }
    const double z2 = a - 2 * gradient2;  // mean of |Y - F xi|^2 / |xi|^2
    energy_density_[i] = e.w + k.w * z2;
    force_a_[i] = 2 * v * (e.wa + k.w + k.wa * z2);
    force_b_[i] = 4 * v * (e.wb + k.wb * z2);
  }
}

void Membrane::set_point(std::size_t point, double energy, const PointForce& force) {
  energy_density_[point] = energy;
  force_a_[point] = force.a;
  force_b_[point] = force.b;
  for (std::size_t c = 0; c < 4; ++c)
    force_n_[c][point] = force.n(static_cast<Eigen::Index>(c / 2), static_cast<Eigen::Index>(c % 2));
}

PointForce Membrane::point_force(std::size_t point) const {
  PointForce force{force_a_[point], force_b_[point], {}};
  force.n << force_n_[0][point], force_n_[1][point], force_n_[2][point], force_n_[3][point];
  return force;
}

void Membrane::respond_listed(const ListedFamily& family, std::span<const double> u) {
  const std::size_t i = family.point;
  if (family.begin == family.end) {
    mean_s2_[i] = mean_s4_[i] = 1;
    for (std::size_t c = 0; c < 4; ++c) mean_gradient_[c][i] = c % 3 == 0 ? 0.5 : 0;
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
  mean_s2_[i] = a;
  mean_s4_[i] = b;
  const Eigen::Matrix2d f =
      family.by_gradient ? Eigen::Matrix2d(m * family.inverse_shape) : Eigen::Matrix2d(2 * m);
  for (std::size_t c = 0; c < 4; ++c)  // half of F, as for the points of the formula
    mean_gradient_[c][i] = 0.5 * f(static_cast<Eigen::Index>(c / 2), static_cast<Eigen::Index>(c % 2));
  const double v = body().volume[i], kappa = kappa_[i];
  const double z2 = a - f.cwiseProduct(m).sum();  // mean of |Y - F xi|^2 / |xi|^2
  if (family.by_gradient) {
    mean_s4_[i] =
        0.5 * (3 * a * a - f.determinant() * f.determinant());  // so that (7) tells a collapse here too
    const PlaneResponse response = material_.plane_stress(f);
    set_point(i, response.energy + kappa * z2,
              {2 * v * kappa, 0, v * (response.stress * family.inverse_shape - 2 * kappa * f)});
  } else {
    const FamilyEnergy e =
        std::visit([&](const auto& law) { return family_energy(law, a, b); }, material_.law);
    const FamilyEnergy k = stiffened_modulus(kappa, a, b);
    set_point(i, e.w + k.w * z2,
              {2 * v * (e.wa + k.w + k.wa * z2), 4 * v * (e.wb + k.wb * z2), -2 * v * k.w * f});
  }
}

std::optional<Breakdown> Membrane::first_collapsed() const {
  const auto breakdown = [&](std::size_t i) {
    return Breakdown{body().position(i), "the sheet collapses: the area ratio of a family falls to zero"};
  };
  for (const std::ptrdiff_t i : collapsed_in_row_)
    if (i >= 0) return breakdown(static_cast<std::size_t>(i));
  for (const ListedFamily& family : listed_) {
    const double a = mean_s2_[family.point], b = mean_s4_[family.point];
    if (!(area_ratio_squared(a, b) > kCollapse * a * a)) return breakdown(family.point);
  }
  return std::nullopt;
}

/// Forces on the points of a row: from their own law and from those of their neighbours (theory, eq. (1)).
void Membrane::gather_row(const LatticeBonds& on, std::size_t row, std::span<const double> u,
                          std::span<double> force) const {
  const std::size_t size = body().size();
  const double* ux = u.data();
  const double* uy = ux + size;
  const std::size_t begin = on.lattice.row_begin(row);
  for (std::size_t i = begin; i < begin + on.lattice.row_length(); i += kLanes) {
    const auto coefficients = load_all(coefficient_, i);
    const Lanes a = load(at(force_a_.data(), i)), b = load(at(force_b_.data(), i));
    const auto n_own = load_all(force_n_, i);
    Lanes fx{}, fy{};
    for (std::size_t k = 0; k < stencil_.size(); ++k) {
      const std::uint8_t bits = on.bonds.masks(i / kLanes)[k];
      if (bits == 0) continue;
      const StencilBond& bond = stencil_[k];
      const Vector du = difference(ux, uy, i, bond.shift);
      const Vector y = {bond.x + du.x, bond.y + du.y};
      const Lanes s2 = (y.x * y.x + y.y * y.y) * bond.inverse2;
      const LaneMask mask = expand(bits);
      const Lanes own = select(mask, weight_of(coefficients, bond.weight) * bond.inverse2);
      const Lanes far =
          select(mask, weight_of(load_all(coefficient_, i, bond.shift), bond.weight) * bond.inverse2);
      const Lanes t = own * (a + b * s2) + far * (load(at(force_a_.data(), i, bond.shift)) +
                                                  load(at(force_b_.data(), i, bond.shift)) * s2);
      const auto n_far = load_all(force_n_, i, bond.shift);
      std::array<Lanes, 4> n;
      for (std::size_t c = 0; c < 4; ++c) n[c] = own * n_own[c] + far * n_far[c];
      fx += t * y.x + n[0] * bond.x + n[1] * bond.y;
      fy += t * y.y + n[2] * bond.x + n[3] * bond.y;
    }
    store(force.data() + i, fx);
    store(force.data() + size + i, fy);
  }
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
  std::fill(force.begin(), force.end(), 0.0);
  if (const LatticeBonds* on = body().on_lattice())
    parallel_for(static_cast<std::ptrdiff_t>(on->lattice.rows()),
                 [&](std::ptrdiff_t row) { gather_row(*on, static_cast<std::size_t>(row), u, force); });
  parallel_for(static_cast<std::ptrdiff_t>(listed_.size()),
               [&](std::ptrdiff_t n) { pull_listed(listed_[static_cast<std::size_t>(n)], u, force); });
  push_far_ends(force);
  return std::nullopt;
}

}  // namespace riven
