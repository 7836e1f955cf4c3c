#pragma once

#include <algorithm>
#include <cmath>
#include <string>

namespace riven {

/// Steps of equal length that end at a given time exactly.
struct Leg {
  double begin = 0, end = 0, step = 0;  // s
  long steps = 0, done = 0;

  static Leg between(double begin, double end, double longest_step) {
    Leg leg{begin, end};
    leg.steps = std::max(1L, static_cast<long>(std::ceil((end - begin) / longest_step - 1e-9)));
    leg.step = (end - begin) / static_cast<double>(leg.steps);
    return leg;
  }
  /// End of the step that comes next.
  [[nodiscard]] double next() const {
    return done + 1 == steps ? end : begin + static_cast<double>(done + 1) * step;
  }

  template <class Self, class Each>
  static void each_member(Self& self, const std::string& name, const Each& each) {
    each(name + ".begin", self.begin);
    each(name + ".end", self.end);
    each(name + ".step", self.step);
    each(name + ".steps", self.steps);
    each(name + ".done", self.done);
  }
};

/// Times at which something is written: multiples of an interval, and the end.
class Schedule {
 public:
  Schedule(double interval, double end) : interval_(interval), end_(end) {}
  template <class Self, class Each>
  static void each_member(Self& self, const std::string& name, const Each& each) {
    each(name + ".count", self.count_);
  }
  [[nodiscard]] double next() const { return std::min(static_cast<double>(count_) * interval_, end_); }
  /// Whether `time` is one of them; if so, moves on to the next.
  bool due(double time) {
    if (time < next() * (1 - 1e-12)) return false;
    ++count_;
    return true;
  }

 private:
  double interval_, end_;
  long count_ = 1;
};

}  // namespace riven
