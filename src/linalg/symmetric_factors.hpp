#pragma once

#include <memory>
#include <span>

#include "linalg/factor_failure.hpp"
#include "linalg/symmetric_matrix.hpp"

namespace riven {

/// Factors L D L^T of a sparse symmetric matrix that need not be definite, by MUMPS with pivoting: an
/// ordering once for a pattern, then factors and solutions for the values that it has. Serial, as
/// SparseCholesky is.
class SymmetricFactors {
 public:
  SymmetricFactors();
  ~SymmetricFactors();
  SymmetricFactors(const SymmetricFactors&) = delete;
  SymmetricFactors& operator=(const SymmetricFactors&) = delete;

  /// Finds an ordering for the pattern. Throws FactorFailure.
  void analyse(const SymmetricMatrix& pattern);
  /// Factors the values; false if the matrix is singular, and the factors are then of no use. Throws
  /// FactorFailure.
  [[nodiscard]] bool factor(const SymmetricMatrix& matrix);
  /// Number of negative eigenvalues of the matrix, by Sylvester's law of inertia.
  [[nodiscard]] int negative() const { return negative_; }
  /// Replaces a right side by the solution.
  void solve(std::span<double> x);

 private:
  struct Real;
  std::unique_ptr<Real> mumps_;
  int negative_ = 0;
};

}  // namespace riven
