#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/shape.hpp"

namespace riven {

/// A box parallel to the axes (m).
struct Bounds {
  Point low{};
  Point high{};
};

/// Boxes in a binary tree of boxes around them: finds those near a place without looking at all.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Bounds> boxes);

  /// Whether `test(n)` is true for any box n that meets `region`; other boxes are not asked.
  template <class Test>
  [[nodiscard]] bool any_in(const Bounds& region, const Test& test) const {
    return !nodes_.empty() && any_below(0, region, test);
  }

  /// Smallest `distance(n)` over the boxes (m), each of which is at least the distance from p to box n;
  /// infinite without boxes.
  template <class Distance>
  [[nodiscard]] double nearest(const Point& p, const Distance& distance) const {
    double best = std::numeric_limits<double>::infinity();
    if (!nodes_.empty()) improve(0, p, distance, best);
    return best;
  }

 private:
  struct Node {
    Bounds bounds;
    std::uint32_t first = 0, last = 0;  // its boxes, in `order_`
    std::uint32_t right = 0;            // its second child; the first one follows it; 0: it has none
  };

  void build(std::uint32_t first, std::uint32_t last);

  static bool meet(const Bounds& a, const Bounds& b) {
    for (std::size_t k = 0; k < 3; ++k)
      if (a.low[k] > b.high[k] || b.low[k] > a.high[k]) return false;
    return true;
  }
  static double distance_to(const Bounds& box, const Point& p) {
    Point out{};
    for (std::size_t k = 0; k < 3; ++k) out[k] = std::max({box.low[k] - p[k], p[k] - box.high[k], 0.0});
    return std::hypot(out[0], out[1], out[2]);
  }

  template <class Test>
  bool any_below(std::uint32_t at, const Bounds& region, const Test& test) const {
    const Node& node = nodes_[at];
    if (!meet(node.bounds, region)) return false;
    if (node.right != 0) return any_below(at + 1, region, test) || any_below(node.right, region, test);
    for (std::uint32_t n = node.first; n < node.last; ++n)
      if (meet(boxes_[order_[n]], region) && test(order_[n])) return true;
    return false;
  }

  template <class Distance>
  void improve(std::uint32_t at, const Point& p, const Distance& distance, double& best) const {
    const Node& node = nodes_[at];
    if (node.right == 0) {
      for (std::uint32_t n = node.first; n < node.last; ++n) best = std::min(best, distance(order_[n]));
      return;
    }
    std::uint32_t near = at + 1, far = node.right;
    double to_near = distance_to(nodes_[near].bounds, p), to_far = distance_to(nodes_[far].bounds, p);
    if (to_far < to_near) {
      std::swap(near, far);
      std::swap(to_near, to_far);
    }
    if (to_near < best) improve(near, p, distance, best);
    if (to_far < best) improve(far, p, distance, best);
  }

  std::vector<Bounds> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;  // the root first
};

}  // namespace riven
