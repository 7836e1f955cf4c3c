#pragma once

#include <complex>
#include <span>
#include <vector>

#include "linalg/complex_factors.hpp"
#include "spacetime/slab_scheme.hpp"

namespace riven {

/// The conjugate pair of eigenvalues of the 2 x 2 matrix Q^-1 P of a scheme: with its eigenvectors a slab's
/// system of 2 n real unknowns becomes one of n complex ones. Space-time theory, 2.2.
struct SlabMode {
  std::complex<double> lambda;
  std::array<std::complex<double>, 2> right, left;  // left . right = 1
};
SlabMode mode_of(const SlabScheme& scheme);

/// Solves (P/h^2 x M + Q x K) x = b of a linear slab by one complex symmetric factorisation of K + lambda/h^2
/// M.
class SlabOperator {
 public:
  explicit SlabOperator(const SlabScheme& scheme);
  void analyse(const SymmetricMatrix& pattern);
  /// `mass`: diagonal of M, an entry per row. Throws FactorFailure.
  void factor(const SymmetricMatrix& stiffness, std::span<const double> mass, double h);
  /// Replaces the right sides of both rows by the solution.
  void solve(std::span<double> first, std::span<double> second);

 private:
  SlabMode mode_;
  Eigen::Matrix2d inverse_stiffness_;  // Q^-1
  ComplexFactors factors_;
  std::vector<std::complex<double>> y_;
};

}  // namespace riven
