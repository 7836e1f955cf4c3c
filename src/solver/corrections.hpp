#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace riven {

/// The corrections of Newton's method, as parts of what they correct, and what the last one has left: no more
/// than it, times what it was of the one before (Hairer and Wanner, Solving Ordinary Differential Equations
/// II, section IV.8). So the end needs no further correction that only shows how small it is, and what
/// converges slowly is told from what converges quadratically.
class Corrections {
 public:
  void begin() { last_ = left_ = std::numeric_limits<double>::infinity(); }
  /// `whole`: not shortened by a line search; its size says nothing about convergence otherwise.
  void add(double size, bool whole = true) {
    left_ = whole && std::isfinite(last_) ? size * std::min(1.0, size / last_) : size;
    if (size == 0) left_ = 0;
    last_ = size;
  }
  [[nodiscard]] double left() const { return left_; }

  template <class Self, class Each>
  static void each_member(Self& self, const std::string& name, const Each& each) {
    each(name + ".last", self.last_);
    each(name + ".left", self.left_);
  }

 private:
  double last_ = 0, left_ = 0;
};

}  // namespace riven
