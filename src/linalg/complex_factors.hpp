#pragma once

#include <complex>
#include <memory>
#include <span>
#include <vector>

#include "linalg/factor_failure.hpp"
#include "linalg/symmetric_matrix.hpp"

namespace riven {

/// Factors L D L^T of K + z M, where K is real, symmetric and sparse, M diagonal and z complex: an ordering
/// once for a pattern, then factors and solutions. Serial, as SparseCholesky is.
class ComplexFactors {
 public:
  ComplexFactors();
  ~ComplexFactors();
  ComplexFactors(const ComplexFactors&) = delete;
  ComplexFactors& operator=(const ComplexFactors&) = delete;

  /// Finds an ordering for the pattern. Throws FactorFailure.
  void analyse(const SymmetricMatrix& pattern);
  /// `diagonal`: of M, an entry per row. Throws FactorFailure, for a singular matrix too.
  void factor(const SymmetricMatrix& matrix, std::complex<double> z, std::span<const double> diagonal);
  /// Replaces a right side by the solution.
  void solve(std::span<std::complex<double>> x);

  /// Of a factorisation, known from `analyse`.
  [[nodiscard]] double bytes() const;

 private:
  struct Complex;
  std::unique_ptr<Complex> mumps_;
  std::vector<std::complex<double>> values_;
};

}  // namespace riven
