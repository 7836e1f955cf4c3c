#pragma once

#include <vector>

#include "base/snapshot.hpp"

namespace riven {

/// What quadrature points remember, in three states: the one that the body last went through, the one that
/// the next forces follow on, and that of the last forces.
class PointMemory {
 public:
  void begin(std::vector<double> at_rest) {
    passed_ = at_rest;
    start_ = at_rest;
    last_ = std::move(at_rest);
  }
  [[nodiscard]] bool empty() const { return passed_.empty(); }

  void go_on(double dt) {
    start_ = last_;
    elapsed_ = dt;
  }
  void go_back() {
    start_ = passed_;
    last_ = passed_;
    elapsed_ = 0;
  }
  void pass() {
    passed_ = last_;
    go_back();
  }

  [[nodiscard]] const double* start() const { return start_.data(); }
  [[nodiscard]] double* last() { return last_.data(); }
  /// From the start to the next forces (s).
  [[nodiscard]] double elapsed() const { return elapsed_; }

  void save(Snapshot& to) const { to.saving()("elements.memory", passed_); }
  void restore(const Snapshot& from) {
    from.restoring()("elements.memory", passed_);
    go_back();
  }

 private:
  std::vector<double> passed_, start_, last_;
  double elapsed_ = 0;
};

}  // namespace riven
