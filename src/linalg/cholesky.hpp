#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "linalg/factor_failure.hpp"
#include "linalg/symmetric_matrix.hpp"

namespace riven {

/// Cholesky factors of a sparse matrix, by MUMPS (Amestoy et al. 2001): an ordering once for a pattern, then
/// factors and solutions for the values that it has. Serial, so results have the same bits on any number of
/// threads.
class SparseCholesky {
 public:
  SparseCholesky();
  ~SparseCholesky();
  SparseCholesky(const SparseCholesky&) = delete;
  SparseCholesky& operator=(const SparseCholesky&) = delete;

  /// Finds an ordering for the pattern. Throws FactorFailure.
  void analyse(const SymmetricMatrix& pattern);
  /// What a factorisation takes, known from `analyse`.
  [[nodiscard]] double flops() const;
  [[nodiscard]] double bytes() const;

  /// Factors the values; false if the matrix is not positive definite, and the factors are then of no use.
  /// Throws FactorFailure.
  [[nodiscard]] bool factor(const SymmetricMatrix& matrix);
  /// Replaces a right side by the solution.
  void solve(std::span<double> x);

 private:
  struct Real;
  std::unique_ptr<Real> mumps_;
};

}  // namespace riven
