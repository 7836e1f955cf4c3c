#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "base/snapshot.hpp"
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

  void save(Snapshot& to) const { each_member(*this, to.saving()); }
  void restore(const Snapshot& from) { each_member(*this, from.restoring()); }

 private:
  struct Sample {
    double parameter = 0;
    std::vector<double> offset;
    std::vector<double> force;
  };
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    std::size_t count = self.past_.size();
    each("work.samples", count);
    if constexpr (!std::is_const_v<Self>) self.past_.assign(count, {});
    for (std::size_t n = 0; n < count; ++n) {
      const std::string name = "work." + std::to_string(n);
      each(name + ".parameter", self.past_[n].parameter);
      each(name + ".offset", self.past_[n].offset);
      each(name + ".force", self.past_[n].force);
    }
  }
  static Sample sample(const Constraints& constraints, double parameter);
  Rule rule_;
  std::vector<Sample> past_;  // one, or two for the parabola
};

}  // namespace riven
