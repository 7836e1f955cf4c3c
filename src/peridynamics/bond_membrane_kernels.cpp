// The loop over bonds of the bond-based membrane: every point sums the pair forces on itself.

#include "base/lanes.hpp"
#include "base/parallel.hpp"
#include "peridynamics/bond_membrane.hpp"

namespace riven {

/// Forces on the points of a row of the lattice, eight at a time.
void BondMembrane::gather_row(const LatticeBonds& on, std::size_t row, std::span<const double> u,
                              std::span<double> force) const {
  const std::size_t size = body().size();
  const double *ux = u.data(), *uy = ux + size;
  const auto lanes = [](const double* plane, std::size_t i, std::ptrdiff_t shift = 0) {
    return load(plane + static_cast<std::ptrdiff_t>(i) + shift);
  };
  const std::size_t begin = on.lattice.row_begin(row);
  for (std::size_t i = begin; i < begin + on.lattice.row_length(); i += kLanes) {
    const Lanes gx = lanes(correction_[0].data(), i), gy = lanes(correction_[1].data(), i);
    const Lanes x = lanes(ux, i), y = lanes(uy, i);
    Lanes fx{}, fy{};
    for (std::size_t k = 0; k < stencil_.size(); ++k) {
      const std::uint8_t bits = on.bonds.masks(i / kLanes)[k];
      if (bits == 0) continue;
      const StencilBond& bond = stencil_[k];
      const Lanes yx = bond.x + (lanes(ux, i, bond.shift) - x), yy = bond.y + (lanes(uy, i, bond.shift) - y);
      const Lanes s2 = (yx * yx + yy * yy) * bond.inverse2;
      const Lanes dot = (bond.x * yx + bond.y * yy) * bond.inverse2;  // s times the cosine
      const Lanes mx = 0.5 * (gx + lanes(correction_[0].data(), i, bond.shift)),
                  my = 0.5 * (gy + lanes(correction_[1].data(), i, bond.shift));
      const Lanes mx2 = mx * mx, my2 = my * my;
      const Lanes corrected = square_root(mx2 * my2 / (bond.nx2 * my2 + bond.ny2 * mx2));
      const Lanes pull = bond.stiffness * corrected * lanes(volume_.data(), i, bond.shift) *
                         (dot * dot / s2) * law_.response(s2);
      const LaneMask mask = expand(bits);
      fx += select(mask, pull * yx);
      fy += select(mask, pull * yy);
    }
    const Lanes own = lanes(share_.data(), i) * lanes(volume_.data(), i);
    store(force.data() + i, own * fx);
    store(force.data() + size + i, own * fy);
  }
}

/// Force on a stored point of a listed body.
void BondMembrane::gather_point(std::size_t point, std::span<const double> u, std::span<double> force) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  body().for_each_neighbour(point, [&](std::size_t neighbour) {
    const Bond bond = bond_between(point, neighbour);
    const Eigen::Vector2d y = deformed(point, bond, u);
    sum += pull(point, bond, y) * y;
  });
  const double own = share_[point] * volume_[point];
  force[point] = own * sum.x();
  force[body().size() + point] = own * sum.y();
}

/// Forces of the bonds that end on inclusions; few, so in one thread and in order.
void BondMembrane::pull_inclusions(std::span<const double> u, std::span<double> force) const {
  for (const InterfaceBond& at : body().interface) {
    const Bond bond = bond_to_inclusion(at);
    const Eigen::Vector2d y = deformed(at.point, bond, u);
    const Eigen::Vector2d t = volume_[at.point] * pull(at.point, bond, y) * y;
    force[at.point] += t.x();
    force[body().size() + at.point] += t.y();
    push_inclusion(bond.end, -t, force);
  }
}

std::optional<Breakdown> BondMembrane::internal_force(std::span<const double> u, std::span<double> force) {
  place_inclusions(u);
  std::fill(force.begin(), force.end(), 0.0);
  if (const LatticeBonds* on = body().on_lattice()) {
    parallel_for(static_cast<std::ptrdiff_t>(on->lattice.rows()),
                 [&](std::ptrdiff_t row) { gather_row(*on, static_cast<std::size_t>(row), u, force); });
  } else {
    parallel_for(static_cast<std::ptrdiff_t>(body().size()),
                 [&](std::ptrdiff_t i) { gather_point(static_cast<std::size_t>(i), u, force); });
  }
  pull_inclusions(u, force);
  return std::nullopt;
}

}  // namespace riven
