#include "linalg/cholesky.hpp"

#include <dmumps_c.h>

#include "linalg/mumps.hpp"

namespace riven {

struct SparseCholesky::Real : Mumps<DMUMPS_STRUC_C, dmumps_c, double> {
  using Mumps::Mumps;
};

SparseCholesky::SparseCholesky() : mumps_(std::make_unique<Real>(Real::kPositiveDefinite)) {}

SparseCholesky::~SparseCholesky() = default;

void SparseCholesky::analyse(const SymmetricMatrix& pattern) {
  mumps_->analyse(pattern);
}

double SparseCholesky::flops() const {
  return mumps_->flops();
}

double SparseCholesky::bytes() const {
  return mumps_->bytes();
}

bool SparseCholesky::factor(const SymmetricMatrix& matrix) {
  if (matrix.rows() == 0) return true;
  mumps_->factor(matrix.value.data());
  if (mumps_->info(1) == Real::kSingular || mumps_->info(1) == Real::kNegativePivot) return false;
  mumps_->check("no factors of the tangent");
  return mumps_->info(12) == 0;  // negative pivots
}

void SparseCholesky::solve(std::span<double> x) {
  mumps_->solve(x);
}

}  // namespace riven
