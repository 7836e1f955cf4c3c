#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "load/external_force.hpp"

namespace riven::testing {

/// A dead force on all entries of a state, by time.
class TimeDependentForce final : public ExternalForce {
 public:
  explicit TimeDependentForce(std::function<std::vector<double>(double)> force) : force_(std::move(force)) {}
  void add(std::span<const double>, std::span<const double>, double parameter,
           std::span<double> force) override {
    const std::vector<double> values = force_(parameter);
    for (std::size_t i = 0; i < values.size(); ++i) force[i] += values[i];
  }
  [[nodiscard]] double work(std::span<const double> u_before, double before, std::span<const double> u,
                            double parameter) const override {
    const std::vector<double> first = force_(before), last = force_(parameter);
    double work = 0;
    for (std::size_t i = 0; i < first.size(); ++i) work += 0.5 * (first[i] + last[i]) * (u[i] - u_before[i]);
    return work;
  }

 private:
  std::function<std::vector<double>(double)> force_;
};

}  // namespace riven::testing
