// Forces of the bond-based membrane: every point sums the pair forces on itself.

#include "base/parallel.hpp"
#include "peridynamics/bond_membrane.hpp"

namespace riven {

namespace {

constexpr std::size_t kPiece = 256;  // points that a thread takes at a time

}  // namespace

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
  const std::size_t size = body().size();
  std::fill(force.begin() + static_cast<std::ptrdiff_t>(2 * size), force.end(), 0.0);
  lattice_.u = {u.data(), u.data() + size};
  lattice_.force = {force.data(), force.data() + size};
  parallel_pieces(
      size,
      [&](std::size_t begin, std::size_t end) {
        if (body().on_lattice() != nullptr) return kernel_(lattice_, begin, end);
        for (std::size_t i = begin; i < end; ++i) gather_point(i, u, force);
      },
      kPiece);
  pull_inclusions(u, force);
  return std::nullopt;
}

}  // namespace riven
