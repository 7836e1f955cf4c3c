#include "solver/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/dynamic_relaxation.hpp"
#include "solver/norms.hpp"

namespace riven {

namespace {

constexpr long kMostIterations = 30;  // of a load step
// Shifts of the tangent, in row bounds: far below the softest motion of a square of a thousand points a side
// (about 1e-7; a long beam's comes near, and then needs more iterations), far above rounding; then, from the
// least that may cure an indefinite tangent.
constexpr double kLeastShift = 1e-10, kFirstShift = 1e-4, kShiftFactor = 4, kLargestShift = 10;
// A row without bonds gets this part of the largest bound.
constexpr double kLeastBound = 1e-6;
constexpr int kHalvings = 20;  // a stiff contact that begins needs so many
// Steps are compared with the displacements, or with those of such a strain where there are next to none.
constexpr double kLeastStrain = 1e-6;
// A step overshoots if the force along it ends with more than this part of what it began with, turned round.
constexpr double kOvershoot = 0.8;

}  // namespace

Newton::Newton(Model& model, Constraints& constraints, const LoadStepSettings& settings)
    : model_(model),
      constraints_(constraints),
      tolerance_(settings.tolerance),
      external_(settings.external),
      forces_(model, constraints, settings.external) {}

void Newton::begin(const State& state) {
  // The system's pattern is that of the bonds that exist, no matter which ones did before: a run that is
  // resumed has the same one.
  if (const double broken = model_.dissipated_energy(); broken != broken_) {
    broken_ = broken;
    system_.reset();
  }
  forces_.rescale(state);
  steps_.begin();
}

Iteration Newton::iterate(State& state, long number) {
  if (const auto failure = forces_.evaluate(state)) return {Iteration::Outcome::failed, *failure};
  if (const auto alarm = forces_.alarm(state)) return {Iteration::Outcome::failed, *alarm};
  if (forces_.residual() <= tolerance_ && steps_.left() <= tolerance_) return {Iteration::Outcome::converged};
  if (number == kMostIterations)
    return {Iteration::Outcome::failed,
            fmt::format("not converged in {} iterations: {}", number, forces_.unrest(tolerance_))};
  if (!factor(state)) return {Iteration::Outcome::failed, "no shift makes the tangent positive definite"};
  std::vector<double> step(state.u.size());
  system_->solve(forces_.values(), step);
  const std::string unrest = forces_.unrest(tolerance_);
  if (!move(state, step)) return {Iteration::Outcome::failed, "no way down to an equilibrium: " + unrest};
  return {Iteration::Outcome::going_on};
}

/// Factors the tangent of the state, that of the last force evaluation, with the least shift that makes it
/// positive definite.
bool Newton::factor(const State& state) {
  if (!system_) system_.emplace(model_, constraints_, state.u);
  system_->assemble(state.u, external_, constraints_.parameter());
  diagonal_.assign(forces_.row_bounds().begin(), forces_.row_bounds().end());
  const double least = kLeastBound * *std::max_element(diagonal_.begin(), diagonal_.end());
  for (double& entry : diagonal_) entry = std::max(entry, least);
  double shift = kLeastShift;
  while (!system_->factor(shift, diagonal_)) {
    if (shift > kLargestShift) return false;
    shift = shift < kFirstShift ? kFirstShift : kShiftFactor * shift;
  }
  return true;
}

bool Newton::move(State& state, std::span<const double> step) {
  const std::vector<double> from = state.u;
  const double slope = dot(forces_.values(), step),
               least = kLeastStrain * model_.spacing() * std::sqrt(static_cast<double>(step.size()));
  double part = 1;
  for (int halvings = 0; halvings <= kHalvings; ++halvings, part *= 0.5) {
    for (std::size_t i = 0; i < from.size(); ++i) state.u[i] = from[i] + part * step[i];
    constraints_.apply(state.u);
    if (forces_.evaluate(state) || !(dot(forces_.values(), step) >= -kOvershoot * slope)) continue;
    steps_.add(part * norm(step) / (norm(state.u) + least), part == 1);
    return true;
  }
  return false;
}

State newton(Model& model, Constraints& constraints, const LoadStepSettings& settings, Observer& observer,
             const Snapshot* from) {
  LoadSteps::Methods methods;
  methods.push_back(std::make_unique<Newton>(model, constraints, settings));
  methods.push_back(std::make_unique<DynamicRelaxation>(model, constraints, settings));
  return LoadSteps(model, constraints, settings, std::move(methods), observer).run(from);
}

}  // namespace riven
