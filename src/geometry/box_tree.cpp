#include "geometry/box_tree.hpp"

#include <numeric>

namespace riven {

BoxTree::BoxTree(std::vector<Bounds> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  if (!boxes_.empty()) build(0, static_cast<std::uint32_t>(boxes_.size()));
}

/// Halves the boxes at the median of their centres along the longest side of the box around them.
void BoxTree::build(std::uint32_t first, std::uint32_t last) {
  constexpr std::uint32_t kLeaf = 4;
  const std::size_t here = nodes_.size();
  Node node{boxes_[order_[first]], first, last, 0};
  for (std::uint32_t n = first; n < last; ++n)
    for (std::size_t k = 0; k < 3; ++k) {
      node.bounds.low[k] = std::min(node.bounds.low[k], boxes_[order_[n]].low[k]);
      node.bounds.high[k] = std::max(node.bounds.high[k], boxes_[order_[n]].high[k]);
    }
  nodes_.push_back(node);
  if (last - first <= kLeaf) return;
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (node.bounds.high[k] - node.bounds.low[k] > node.bounds.high[axis] - node.bounds.low[axis]) axis = k;
  const std::uint32_t middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](std::uint32_t a, std::uint32_t b) {
                     return boxes_[a].low[axis] + boxes_[a].high[axis] <
                            boxes_[b].low[axis] + boxes_[b].high[axis];
                   });
  build(first, middle);
  nodes_[here].right = static_cast<std::uint32_t>(nodes_.size());
  build(middle, last);
}

}  // namespace riven
