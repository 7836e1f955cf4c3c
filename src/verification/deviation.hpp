#pragma once

#include <cmath>
#include <limits>

namespace riven {

/// Collects the relative L2 norm and the largest of a set of deviations; a NaN stays NaN.
class DeviationSum {
 public:
  /// Adds |u - u_ref| and |u_ref|. Returns whether this deviation is the largest so far.
  bool add(double deviation, double reference) {
    deviation2_ += deviation * deviation;
    reference2_ += reference * reference;
    const bool largest = std::isnan(deviation) ? !std::isnan(maximum_) : deviation > maximum_;
    if (largest) maximum_ = deviation;
    return largest;
  }

  /// 0 when both vanish, infinite when only the reference does.
  [[nodiscard]] double relative_l2() const {
    return deviation2_ == 0 ? 0 : std::sqrt(deviation2_ / reference2_);
  }
  [[nodiscard]] double maximum() const { return std::isinf(maximum_) && maximum_ < 0 ? 0 : maximum_; }

 private:
  double deviation2_ = 0;
  double reference2_ = 0;
  double maximum_ = -std::numeric_limits<double>::infinity();
};

}  // namespace riven
