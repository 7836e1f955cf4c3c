#include "body/crack_extent.hpp"

#include <cmath>
#include <numbers>

#include "base/parallel.hpp"

namespace riven {

namespace {

/// Damage of a long flat crack summed over a line across it (m): 1 would be a layer of points without bonds.
double depth_of_crack(const Body& body) {
  if (const LatticeBonds* on = body.on_lattice()) {
    // A bond that spans n rows crosses a crack from n places per spacing, and is lost to both of its ends.
    const auto axis = static_cast<std::size_t>(body.dimension - 1);
    double rows = 0;
    for (const Cell& offset : on->stencil.offset) rows += std::abs(offset[axis]);
    return rows / static_cast<double>(on->stencil.size()) * body.spacing;
  }
  // Twice the integral of `share_beyond` over the distances.
  constexpr std::array<double, 3> depth{0.5, 4 / (3 * std::numbers::pi), 3.0 / 8};
  return depth[static_cast<std::size_t>(body.dimension - 1)] * body.horizon;
}

}  // namespace

std::vector<double> damages(const Body& body) {
  std::vector<double> damage(body.points.size());
  parallel_for(static_cast<std::ptrdiff_t>(damage.size()), [&](std::ptrdiff_t n) {
    const auto at = static_cast<std::size_t>(n);
    damage[at] = body.damage(body.points[at]);
  });
  return damage;
}

double share_beyond(int dimension, double distance) {
  const double x = distance;
  if (dimension == 1) return 0.5 * (1 - x);
  if (dimension == 2) return (std::acos(x) - x * std::sqrt(1 - x * x)) / std::numbers::pi;
  return 0.25 * (2 + x) * (1 - x) * (1 - x);
}

double crack_area(const Body& body, std::span<const std::size_t> among, std::span<const double> before,
                  std::span<const double> now) {
  const double volume = ordered_sum_of(among.size(), [&](std::size_t n) {
    return (now[among[n]] - before[among[n]]) * body.volume[body.points[among[n]]];
  });
  return volume / depth_of_crack(body);
}

}  // namespace riven
