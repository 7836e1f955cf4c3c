#pragma once

#include <cstddef>
#include <vector>

namespace riven {

/// The lower triangle of a symmetric sparse matrix: the entries of row i are [begin[i], begin[i + 1]), their
/// columns ascend, and the last one is the diagonal's.
struct SymmetricMatrix {
  std::vector<std::size_t> begin{0};
  std::vector<int> column;
  std::vector<double> value;

  [[nodiscard]] std::size_t rows() const { return begin.size() - 1; }
};

}  // namespace riven
