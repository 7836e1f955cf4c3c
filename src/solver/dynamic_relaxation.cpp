#include "solver/dynamic_relaxation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"

namespace riven {

namespace {

constexpr double kLargestDamping = 1.9;  // below the critical 2 of eq. (11)
constexpr int kProgressEvery = 50;       // iterations
constexpr long kPatience =
    1000;  // iterations without progress; a quarter of solver.max_iterations if that is more

}  // namespace

DynamicRelaxation::DynamicRelaxation(Model& model, Constraints& constraints, const LoadStepSettings& settings)
    : constraints_(constraints),
      tolerance_(settings.tolerance),
      max_iterations_(settings.max_iterations),
      forces_(model, constraints, settings.external),
      stall_(std::max(kPatience, settings.max_iterations / 4)),
      velocity_(model.dofs(), 0.0) {}

void DynamicRelaxation::begin(const State& state) {
  std::fill(velocity_.begin(), velocity_.end(), 0.0);
  forces_.rescale(state);
}

Iteration DynamicRelaxation::iterate(State& state, long number) {
  if (const auto failure = forces_.evaluate(state)) return {Iteration::Outcome::failed, *failure};
  const Sums sums = sweep();
  const double residual = forces_.residual();
  const bool converged = residual <= tolerance_;
  const bool look = number % kProgressEvery == 0 || converged || !std::isfinite(residual);
  if (look)
    if (const auto alarm = forces_.alarm(state)) return {Iteration::Outcome::failed, *alarm};
  if (converged) return {Iteration::Outcome::converged};
  if (stall_.stalled(number, residual))
    return {Iteration::Outcome::failed, fmt::format("the residual has stalled for {} iterations: {}",
                                                    stall_.patience(), forces_.unrest(tolerance_))};
  advance(state, damping(sums), number == 0);
  if (number + 1 == max_iterations_)
    return {Iteration::Outcome::failed,
            fmt::format("not converged in the {} iterations of solver.max_iterations: {}", max_iterations_,
                        forces_.unrest(tolerance_))};
  return {Iteration::Outcome::going_on, {}, look};
}

/// Slaves and padding hold zero force.
DynamicRelaxation::Sums DynamicRelaxation::sweep() const {
  const auto force = forces_.values(), old_force = forces_.previous();
  return ordered_sum<Sums>(force.size(), [&](std::size_t begin, std::size_t end) {
    Sums sums;
    for (std::size_t i = begin; i < end; ++i) {
      sums.stiffness -= (force[i] - old_force[i]) * velocity_[i];
      sums.inertia += mass(i) * velocity_[i] * velocity_[i];
    }
    return sums;
  });
}

/// Critical damping of the frequency at which the body moves now. Eq. (11) takes the quotient over the
/// displacement since the last load step, entry by entry; where that is mostly the load's own affine part
/// it says nothing of the motion that is left.
double DynamicRelaxation::damping(const Sums& sums) {
  if (!(sums.stiffness > 0) || !(sums.inertia > 0)) return 0;
  return std::min(2 * std::sqrt(sums.stiffness / sums.inertia), kLargestDamping);
}

void DynamicRelaxation::advance(State& state, double c, bool first) {
  const double keep = first ? 0 : (2 - c) / (2 + c), push = first ? 0.5 : 2 / (2 + c);
  const auto force = forces_.values();
  parallel_pieces(velocity_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (mass(i) == 0) continue;
      velocity_[i] = keep * velocity_[i] + push * force[i] / mass(i);
      state.u[i] += velocity_[i];
    }
  });
  constraints_.apply(state.u);
}

State relax(Model& model, Constraints& constraints, const LoadStepSettings& settings, Observer& observer,
            const Snapshot* from) {
  LoadSteps::Methods methods;
  methods.push_back(std::make_unique<DynamicRelaxation>(model, constraints, settings));
  return LoadSteps(model, constraints, settings, std::move(methods), observer).run(from);
}

}  // namespace riven
