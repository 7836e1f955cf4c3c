#pragma once

#include <optional>
#include <span>
#include <string>

#include "load/constraints.hpp"
#include "model/model.hpp"

namespace riven {

/// Looks at states for what ends a run whatever the solver: numbers that are none, points that leave the
/// body. One sweep over the state; solvers ask every so many steps, and before a state goes to the observers.
class Watchdog {
 public:
  explicit Watchdog(const Model& model);

  /// What is wrong with a state and its forces (N), if anything. `v`: velocities (m/s), empty in statics.
  [[nodiscard]] std::optional<Breakdown> inspect(const Constraints& constraints, std::span<const double> u,
                                                 std::span<const double> force,
                                                 std::span<const double> v = {}) const;

  /// The entry of largest magnitude: where the largest force pulls, where the body is fastest.
  [[nodiscard]] static std::size_t largest(std::span<const double> entries);

  /// Diagonal of the undeformed body's box (m).
  [[nodiscard]] double size() const { return size_; }

 private:
  const Model& model_;
  double size_ = 0;
};

/// Tells a residual that falls slowly from one that no longer falls.
class StallWatch {
 public:
  /// `iterations`: how long the residual may stay where it is.
  explicit StallWatch(long iterations) : patience_(iterations) {}
  /// Whether the residual has stalled; to be asked in every iteration.
  bool stalled(long iteration, double residual);
  [[nodiscard]] long patience() const { return patience_; }

  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    each("stall.best_at", self.best_at_);
    each("stall.best", self.best_);
  }

 private:
  long patience_;
  long best_at_ = 0;
  double best_ = 0;
};

/// "what at (x, y, z) m"
std::string text(const Breakdown& breakdown);
/// "(x, y, z) m"
std::string text(const Point& place);

}  // namespace riven
