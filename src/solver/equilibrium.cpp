#include "solver/equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.hpp"

namespace riven {

namespace {

// Reactions below those of such strains set no scale: a body that nothing loads.
constexpr double kLeastStrain = 1e-6;

}  // namespace

FreeForces::FreeForces(Model& model, Constraints& constraints, const ExternalForces& external)
    : model_(model),
      constraints_(constraints),
      external_(external),
      watchdog_(model),
      force_(model.dofs(), 0.0),
      previous_(force_),
      bound_(force_) {}

void FreeForces::rescale(const State& state) {
  model_.stiffness_bound(state.u, bound_);
  for (const auto& external : external_) external->stiffness_bound(state.u, constraints_.parameter(), bound_);
  constraints_.fold(bound_);
  const double rows2 = ordered_sum_of(bound_.size(), [&](std::size_t i) { return bound_[i] * bound_[i]; });
  least_reaction_ = kLeastStrain * model_.spacing() * std::sqrt(rows2);
}

std::optional<std::string> FreeForces::evaluate(State& state) {
  ++state.evaluations;
  std::swap(force_, previous_);
  std::fill(force_.begin(), force_.end(), 0.0);  // models leave out points without bonds
  if (const auto breakdown = model_.internal_force(state.u, force_))
    return text(watchdog_.inspect(constraints_, state.u, state.u).value_or(*breakdown));
  add_external(state);
  constraints_.reduce(force_);
  return std::nullopt;
}

void FreeForces::add_external(const State& state) {
  if (external_.empty()) return;
  applied_.assign(force_.size(), 0.0);
  for (const auto& external : external_) external->add(state.u, {}, constraints_.parameter(), applied_);
  for (std::size_t i = 0; i < force_.size(); ++i) force_[i] += applied_[i];
  external_norm_ =
      std::sqrt(ordered_sum_of(applied_.size(), [&](std::size_t i) { return applied_[i] * applied_[i]; }));
}

double FreeForces::residual() const {
  const double force2 = ordered_sum_of(force_.size(), [&](std::size_t i) { return force_[i] * force_[i]; });
  if (force2 == 0) return 0;  // and where no bond is left no scale either
  return std::sqrt(force2) / scale();
}

double FreeForces::scale() const {
  return std::max(constraints_.reaction_norm() + external_norm_, least_reaction_);
}

std::optional<std::string> FreeForces::alarm(const State& state) const {
  const auto breakdown = watchdog_.inspect(constraints_, state.u, force_);
  return breakdown ? std::optional(text(*breakdown)) : std::nullopt;
}

std::string FreeForces::unrest(double tolerance) const {
  return fmt::format("a residual of {:.2g} is left (solver.tolerance {:.2g}), the largest force at {}",
                     residual(), tolerance, text(model_.place(Watchdog::largest(force_))));
}

double FreeForces::least_energy() const {
  return kLeastStrain * model_.spacing() * least_reaction_;
}

}  // namespace riven
