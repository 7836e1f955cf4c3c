#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace riven {

/// Sets that are joined, and which of them an element is in (Tarjan's union by size, with path halving).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t elements) : parent_(elements), size_(elements, 1) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  /// The element that stands for the set of `element`.
  [[nodiscard]] std::uint32_t root(std::size_t element) {
    auto at = static_cast<std::uint32_t>(element);
    while (parent_[at] != at) at = parent_[at] = parent_[parent_[at]];
    return at;
  }
  /// Makes one set of the sets of `a` and `b`.
  void join(std::size_t a, std::size_t b) {
    std::uint32_t one = root(a), other = root(b);
    if (one == other) return;
    if (size_[one] < size_[other]) std::swap(one, other);
    parent_[other] = one;
    size_[one] += size_[other];
  }

 private:
  std::vector<std::uint32_t> parent_, size_;
};

}  // namespace riven
