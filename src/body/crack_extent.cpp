#include "body/crack_extent.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.hpp"

namespace riven {

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

double crack_depth(const Body& body) {
  // A bond along xi crosses a plane from places |xi_n| deep along its normal n, and is a share 1 / N of its
  // family: the depth is the mean |xi_n| of a family, here over all axes.
  const auto axes = static_cast<std::size_t>(body.dimension);
  double reach = 0, bonds = 0;
  const auto add = [&](const Point& bond) {
    for (std::size_t a = 0; a < axes; ++a) reach += std::abs(bond[a]) / static_cast<double>(axes);
    ++bonds;
  };
  if (const LatticeBonds* on = body.on_lattice()) {
    for (const Point& bond : on->stencil.bond) add(bond);
    return reach / bonds;
  }
  const auto& list = std::get<ListedBonds>(body.bonds);
  const bool any = std::find(body.complete.begin(), body.complete.end(), true) != body.complete.end();
  for (const std::size_t i : body.points) {
    if (any && !body.complete[i]) continue;
    for (std::size_t b = list.begin[i]; b < list.begin[i + 1]; ++b) {
      const Point &x = list.position[i], &y = list.position[list.neighbour[b]];
      add({y[0] - x[0], y[1] - x[1], y[2] - x[2]});
    }
  }
  return reach / bonds;
}

double crack_area(const Body& body, double depth, std::span<const std::size_t> among,
                  std::span<const double> before, std::span<const double> now) {
  const double volume = ordered_sum_of(among.size(), [&](std::size_t n) {
    return (now[among[n]] - before[among[n]]) * body.volume[body.points[among[n]]];
  });
  return volume / depth;
}

}  // namespace riven
