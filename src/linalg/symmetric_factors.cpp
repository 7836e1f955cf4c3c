#include "linalg/symmetric_factors.hpp"

#include <dmumps_c.h>

#include "linalg/mumps.hpp"

namespace riven {

struct SymmetricFactors::Real : Mumps<DMUMPS_STRUC_C, dmumps_c, double> {
  using Mumps::Mumps;
};

SymmetricFactors::SymmetricFactors() : mumps_(std::make_unique<Real>(Real::kSymmetric)) {}

SymmetricFactors::~SymmetricFactors() = default;

void SymmetricFactors::analyse(const SymmetricMatrix& pattern) {
  mumps_->analyse(pattern);
}

bool SymmetricFactors::factor(const SymmetricMatrix& matrix) {
  negative_ = 0;
  if (matrix.rows() == 0) return true;
  mumps_->factor(matrix.value.data());
  if (mumps_->info(1) == Real::kSingular) return false;
  mumps_->check("no factors of the tangent");
  negative_ = mumps_->info(12);
  return true;
}

void SymmetricFactors::solve(std::span<double> x) {
  mumps_->solve(x);
}

}  // namespace riven
