#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "input/expression.hpp"

namespace riven {

/// The way that a prescribed velocity makes: its integral from time 0, summed once at many times, and from
/// the last of these on again at each call. It depends on the time alone: a run that goes on later gets the
/// same.
class Way {
 public:
  Way(const Expression& velocity, const Point& place, double until)
      : velocity_(velocity), place_(place), panel_(until / kPanels) {
    for (int n = 0; n < kPanels; ++n) sums_.push_back(sums_.back() + piece(n * panel_, (n + 1) * panel_));
  }
  double operator()(double time) const {
    const auto n =
        static_cast<std::size_t>(std::clamp(std::floor(time / panel_), 0.0, static_cast<double>(kPanels)));
    const double from = static_cast<double>(n) * panel_;
    return time == from ? sums_[n] : sums_[n] + piece(from, time);
  }

 private:
  static constexpr int kPanels = 1000;

  /// By Gauss's rule of three points.
  [[nodiscard]] double piece(double from, double to) const {
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from), at = std::sqrt(0.6);
    return half / 9 * (5 * speed(middle - at * half) + 8 * speed(middle) + 5 * speed(middle + at * half));
  }
  [[nodiscard]] double speed(double time) const {
    return velocity_(Variables{.position = place_, .t = time});
  }

  Expression velocity_;
  Point place_;
  double panel_;
  std::vector<double> sums_{0.0};
};

}  // namespace riven
