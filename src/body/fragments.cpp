#include "body/fragments.hpp"

#include <algorithm>
#include <utility>

#include "base/disjoint_sets.hpp"

namespace riven {

int Fragments::count(std::size_t least) const {
  return static_cast<int>(
      std::count_if(points.begin(), points.end(), [&](std::size_t size) { return size >= least; }));
}

Fragments find_fragments(const Body& body) {
  // An inclusion is a node behind the stored points.
  DisjointSets sets(body.size() + body.rigid_points.size());
  for (const std::size_t i : body.points) {
    body.for_each_neighbour(i, [&](std::size_t j) {
      if (j < i && body.kind[j] == PointKind::body) sets.join(i, j);
    });
    for (const InterfaceBond& bond : body.interface_of(i)) sets.join(i, body.size() + bond.inclusion);
  }
  std::vector<std::uint32_t> nodes;
  for (const std::size_t i : body.points) nodes.push_back(sets.root(i));
  for (std::size_t n = 0; n < body.rigid_points.size(); ++n) nodes.push_back(sets.root(body.size() + n));

  struct Part {
    std::size_t points = 0, first = 0;
  };
  std::vector<Part> part(body.size() + body.rigid_points.size());  // by root
  std::vector<std::uint32_t> roots;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Part& here = part[nodes[n]];
    if (here.points == 0) {
      here.first = n;
      roots.push_back(nodes[n]);
    }
    ++here.points;
  }
  std::sort(roots.begin(), roots.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(part[b].points, part[a].first) < std::pair(part[a].points, part[b].first);
  });

  Fragments fragments;
  std::vector<std::uint32_t> number(part.size(), 0);
  for (const std::uint32_t root : roots) {
    fragments.points.push_back(part[root].points);
    number[root] = static_cast<std::uint32_t>(fragments.points.size());
  }
  for (const std::uint32_t root : nodes) fragments.number.push_back(number[root]);
  return fragments;
}

}  // namespace riven
