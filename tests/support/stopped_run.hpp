#pragma once

#include <functional>

#include "solver/solver.hpp"

namespace riven::testing {

struct Stopped {};

/// An observer that stops a run at a safe point, with a snapshot.
template <class Base = Observer>
struct StopsAt : Base {
  void safe_point(const std::function<Snapshot()>& take) override {
    if (points++ != stop_at) return;
    snapshot = take();
    throw Stopped();
  }
  long stop_at = -1, points = 0;
  Snapshot snapshot;
};

}  // namespace riven::testing
