#pragma once

#include <cmath>
#include <vector>

namespace riven::testing {

/// f'(x) by five points: the error is h^4 f^(5) / 30 plus rounding of about 1e-16 f / h.
template <class Function>
auto derivative(const Function& f, double x, double h) {
  using Value = decltype(f(x));
  return Value((f(x - 2 * h) - 8 * f(x - h) + 8 * f(x + h) - f(x + 2 * h)) / (12 * h));
}

/// Norm of a - b over that of b.
inline double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference += std::pow(a[i] - b[i], 2);
    norm += b[i] * b[i];
  }
  return std::sqrt(difference / norm);
}

}  // namespace riven::testing
