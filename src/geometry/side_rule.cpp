#include "geometry/side_rule.hpp"

#include <cmath>

namespace riven {
namespace {

/// Gauss's points between -1 and 1, exact to fifth powers.
const std::array<double, 3> kPlace{-std::sqrt(0.6), 0.0, std::sqrt(0.6)};
constexpr std::array<double, 3> kWeight{5.0 / 9, 8.0 / 9, 5.0 / 9};

std::vector<SidePoint> edge_rule(bool curved) {
  std::vector<SidePoint> rule;
  for (std::size_t q = 0; q < 3; ++q) {
    const double s = kPlace[q];
    if (curved)
      rule.push_back({{0.5 * s * (s - 1), 0.5 * s * (s + 1), 1 - s * s, 0},
                      {{{s - 0.5, s + 0.5, -2 * s, 0}, {}}},
                      kWeight[q]});
    else
      rule.push_back({{0.5 * (1 - s), 0.5 * (1 + s), 0, 0}, {{{-0.5, 0.5, 0, 0}, {}}}, kWeight[q]});
  }
  return rule;
}

/// The middles of the edges: exact to squares, and the normal is constant.
std::vector<SidePoint> triangle_rule() {
  std::vector<SidePoint> rule;
  for (const auto& [x, y] : {std::array{0.5, 0.0}, {0.5, 0.5}, {0.0, 0.5}})
    rule.push_back({{1 - x - y, x, y, 0}, {{{-1, 1, 0, 0}, {-1, 0, 1, 0}}}, 1.0 / 6});
  return rule;
}

std::vector<SidePoint> quadrilateral_rule() {
  constexpr std::array<std::array<int, 2>, 4> kCorners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  std::vector<SidePoint> rule;
  for (std::size_t p = 0; p < 9; ++p) {
    const double x = kPlace[p % 3], y = kPlace[p / 3];
    SidePoint point{.weight = kWeight[p % 3] * kWeight[p / 3]};
    for (std::size_t a = 0; a < 4; ++a) {
      const auto [r, s] = kCorners[a];
      point.value[a] = 0.25 * (1 + r * x) * (1 + s * y);
      point.slope[0][a] = 0.25 * r * (1 + s * y);
      point.slope[1][a] = 0.25 * s * (1 + r * x);
    }
    rule.push_back(point);
  }
  return rule;
}

}  // namespace

const std::vector<SidePoint>& side_rule(int dimension, std::size_t nodes) {
  static const std::vector<SidePoint> straight = edge_rule(false), curved = edge_rule(true),
                                      triangle = triangle_rule(), quadrilateral = quadrilateral_rule();
  if (dimension == 2) return nodes == 3 ? curved : straight;
  return nodes == 3 ? triangle : quadrilateral;
}

}  // namespace riven
