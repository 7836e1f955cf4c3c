#include "spacetime/slab_operator.hpp"

#include <Eigen/LU>
#include <cmath>

namespace riven {

SlabMode mode_of(const SlabScheme& scheme) {
  const Eigen::Matrix2d c = scheme.stiffness().inverse() * scheme.inertia;
  const double half = 0.5 * c.trace();
  const std::complex<double> lambda(half, std::sqrt(c.determinant() - half * half));
  SlabMode mode{lambda, {c(0, 1), lambda - c(0, 0)}, {c(1, 0), lambda - c(0, 0)}};
  const std::complex<double> product = mode.left[0] * mode.right[0] + mode.left[1] * mode.right[1];
  for (auto& entry : mode.left) entry /= product;
  return mode;
}

SlabOperator::SlabOperator(const SlabScheme& scheme)
    : mode_(mode_of(scheme)), inverse_stiffness_(scheme.stiffness().inverse()) {}

void SlabOperator::analyse(const SymmetricMatrix& pattern) {
  factors_.analyse(pattern);
}

void SlabOperator::factor(const SymmetricMatrix& stiffness, std::span<const double> mass, double h) {
  factors_.factor(stiffness, mode_.lambda / (h * h), mass);
}

void SlabOperator::solve(std::span<double> first, std::span<double> second) {
  const Eigen::Matrix2d& q = inverse_stiffness_;
  const std::complex<double> a = mode_.left[0] * q(0, 0) + mode_.left[1] * q(1, 0),
                             b = mode_.left[0] * q(0, 1) + mode_.left[1] * q(1, 1);
  y_.resize(first.size());
  for (std::size_t i = 0; i < y_.size(); ++i) y_[i] = a * first[i] + b * second[i];
  factors_.solve(y_);
  for (std::size_t i = 0; i < y_.size(); ++i) {
    first[i] = 2 * (mode_.right[0] * y_[i]).real();
    second[i] = 2 * (mode_.right[1] * y_[i]).real();
  }
}

}  // namespace riven
