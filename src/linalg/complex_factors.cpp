#include "linalg/complex_factors.hpp"

#include <zmumps_c.h>

#include "linalg/mumps.hpp"

namespace riven {

struct ComplexFactors::Complex : Mumps<ZMUMPS_STRUC_C, zmumps_c, std::complex<double>> {
  using Mumps::Mumps;
};

ComplexFactors::ComplexFactors() : mumps_(std::make_unique<Complex>(Complex::kSymmetric)) {}

ComplexFactors::~ComplexFactors() = default;

void ComplexFactors::analyse(const SymmetricMatrix& pattern) {
  mumps_->analyse(pattern);
}

void ComplexFactors::factor(const SymmetricMatrix& matrix, std::complex<double> z,
                            std::span<const double> diagonal) {
  if (matrix.rows() == 0) return;
  values_.assign(matrix.value.begin(), matrix.value.end());
  for (std::size_t i = 0; i < matrix.rows(); ++i) values_[matrix.begin[i + 1] - 1] += z * diagonal[i];
  mumps_->factor(values_.data());
  mumps_->check("no factors of the slab");
}

void ComplexFactors::solve(std::span<std::complex<double>> x) {
  mumps_->solve(x);
}

double ComplexFactors::bytes() const {
  return mumps_->bytes();
}

}  // namespace riven
