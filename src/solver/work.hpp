#pragma once

#include <vector>

#include "load/constraints.hpp"

namespace riven {

/// Work of the loads along a path, the prescribed displacements taken as linear between its states.
class WorkIntegral {
 public:
  enum class Rule {
    trapezoidal,  // the force is linear in between: as exact as Verlet's steps are
    parabolic,  // the force is a parabola of the parameter through the last three states: for long load steps
  };
  explicit WorkIntegral(Rule rule) : rule_(rule) {}

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
  Rule rule_;
  std::vector<Sample> past_;  // one, or two for the parabola
};

}  // namespace riven
