#pragma once

namespace riven::testing {

/// f'(x) by five points: the error is h^4 f^(5) / 30 plus rounding of about 1e-16 f / h.
template <class Function>
auto derivative(const Function& f, double x, double h) {
  using Value = decltype(f(x));
  return Value((f(x - 2 * h) - 8 * f(x - h) + 8 * f(x + h) - f(x + 2 * h)) / (12 * h));
}

}  // namespace riven::testing
