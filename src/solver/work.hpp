#pragma once

#include <vector>

#include "load/constraints.hpp"

namespace riven {

/// Work of the loads along a path of equilibria. The force is taken as a parabola of the load parameter through
/// the last three states (error of fourth order in the step), the prescribed displacements as linear in between.
class ParabolicWork {
 public:
  void begin(const Constraints& constraints, double parameter);
  /// Work (J) from the last call, or from `begin`, to the constraints' present state.
  double since_last_call(const Constraints& constraints, double parameter);

 private:
  struct Sample {
    double parameter = 0;
    std::vector<double> offset;
    std::vector<double> force;
  };
  static Sample sample(const Constraints& constraints, double parameter);
  std::vector<Sample> past_;  // one or two
};

}  // namespace riven
