#include "report/outer_sides.hpp"

#include <algorithm>
#include <functional>
#include <map>

namespace riven {

namespace {

/// Corners of the sides of a cell, by their places in its list.
std::vector<std::vector<std::size_t>> sides_of(CellKind kind) {
  if (kind == CellKind::tetrahedron) return {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
}

}  // namespace

std::vector<Cells> outer_sides(const std::vector<Cells>& cells) {
  std::vector<Cells> shown;
  std::map<std::vector<std::uint32_t>, std::pair<int, std::vector<std::uint32_t>>>
      sides;  // by sorted corners
  for (const Cells& list : cells) {
    if (list.kind != CellKind::tetrahedron && list.kind != CellKind::hexahedron) {
      shown.push_back(list);
      continue;
    }
    for (std::size_t first = 0; first < list.nodes.size(); first += corners(list.kind))
      for (const auto& side : sides_of(list.kind)) {
        std::vector<std::uint32_t> nodes;
        for (const std::size_t corner : side) nodes.push_back(list.nodes[first + corner]);
        std::vector<std::uint32_t> key = nodes;
        std::sort(key.begin(), key.end());
        auto& [count, kept] = sides[std::move(key)];
        ++count;
        kept = std::move(nodes);
      }
  }
  Cells triangles{CellKind::triangle, {}}, quads{CellKind::quad, {}};
  for (const auto& [key, side] : sides)
    if (side.first == 1) {
      Cells& to = key.size() == 3 ? triangles : quads;
      to.nodes.insert(to.nodes.end(), side.second.begin(), side.second.end());
    }
  for (Cells& list : {std::ref(triangles), std::ref(quads)})
    if (!list.nodes.empty()) shown.push_back(std::move(list));
  return shown;
}

}  // namespace riven
