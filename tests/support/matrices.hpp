#pragma once

#include <Eigen/Core>

#include "linalg/symmetric_matrix.hpp"

namespace riven::testing {

/// The lower triangle of a symmetric matrix, without its zeros but for those of the diagonal.
inline SymmetricMatrix sparse(const Eigen::MatrixXd& a) {
  SymmetricMatrix m;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j)
      if (a(i, j) != 0 || i == j) {
        m.column.push_back(static_cast<int>(j));
        m.value.push_back(a(i, j));
      }
    m.begin.push_back(m.column.size());
  }
  return m;
}

}  // namespace riven::testing
