#pragma once

#include <set>

#include "support/point_states.hpp"

namespace riven::testing {

/// Cuts a bond of a lattice body or a list, seen from both ends.
inline void cut_bond(Body& body, std::size_t i, std::size_t j) {
  if (auto* on = std::get_if<LatticeBonds>(&body.bonds)) {
    for (std::size_t k = 0; k < on->stencil.size(); ++k)
      if (BondPlanes::neighbour(on->stencil, k, i) == j) on->bonds.cut(on->stencil, k, i);
    return;
  }
  auto& list = std::get<ListedBonds>(body.bonds);
  for (const auto& [from, to] : {std::pair(i, j), std::pair(j, i)})
    for (std::size_t b = list.begin[from]; b < list.begin[from + 1]; ++b)
      if (list.neighbour[b] == to) {
        const std::size_t n = b - list.begin[from];
        list.masks[list.begin[from] / 8 + from + n / 8] &= static_cast<std::uint8_t>(~(1U << (n % 8)));
      }
}

inline std::vector<std::size_t> neighbours_of(const Body& body, std::size_t i) {
  std::vector<std::size_t> found;
  body.for_each_neighbour(i, [&](std::size_t j) { found.push_back(j); });
  return found;
}

/// Cuts `count` random bonds between body points.
inline void cut_bonds(Body& body, Random& random, int count) {
  const int last = static_cast<int>(body.points.size()) - 1;
  for (int n = 0; n < count; ++n) {
    const std::size_t i = body.points[static_cast<std::size_t>(random.integer(0, last))];
    const auto found = neighbours_of(body, i);
    if (found.empty()) continue;
    const std::size_t j =
        found[static_cast<std::size_t>(random.integer(0, static_cast<int>(found.size()) - 1))];
    if (body.kind[j] == PointKind::body) cut_bond(body, i, j);
  }
}

/// A state of a body's points alone.
inline std::vector<double> rest_of(const Body& body) {
  return std::vector<double>(static_cast<std::size_t>(body.dimension) * body.size(), 0.0);
}

inline Eigen::Vector3d deformed(const Body& body, const std::vector<double>& u, std::size_t i) {
  return place(body, i) + vector_of(u, body, i);
}

}  // namespace riven::testing
