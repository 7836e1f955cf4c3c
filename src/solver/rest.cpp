#include "solver/rest.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "solver/newton.hpp"

namespace riven {

namespace {

constexpr double kLeastPart = 1.0 / 256;

/// A part of a force.
class PartOf final : public ExternalForce {
 public:
  PartOf(std::shared_ptr<ExternalForce> whole, const double& part) : whole_(std::move(whole)), part_(part) {}

  void add(std::span<const double> u, std::span<const double> v, double parameter,
           std::span<double> force) override {
    std::vector<double> own(force.size(), 0.0);
    whole_->add(u, v, parameter, own);
    for (std::size_t i = 0; i < own.size(); ++i) force[i] += part_ * own[i];
  }
  void tangent(std::span<const double> u, double parameter, TangentBlocks& to) const override {
    const std::size_t before = to.values.size();
    whole_->tangent(u, parameter, to);
    for (std::size_t n = before; n < to.values.size(); ++n) to.values[n] *= part_;
  }
  void stiffness_bound(std::span<const double> u, double parameter, std::span<double> bound) const override {
    std::vector<double> own(bound.size(), 0.0);
    whole_->stiffness_bound(u, parameter, own);
    for (std::size_t i = 0; i < own.size(); ++i) bound[i] += part_ * own[i];
  }
  [[nodiscard]] double work(std::span<const double> u_before, double before, std::span<const double> u,
                            double parameter) const override {
    return part_ * whole_->work(u_before, before, u, parameter);
  }

 private:
  std::shared_ptr<ExternalForce> whole_;
  const double& part_;
};

/// Why there is no equilibrium, if there is none.
std::optional<std::string> settle(Newton& newton, State& state) {
  newton.begin(state);
  for (long number = 0;; ++number) {
    const Iteration iteration = newton.iterate(state, number);
    if (iteration.outcome == Iteration::Outcome::converged) return std::nullopt;
    if (iteration.outcome == Iteration::Outcome::failed) return iteration.failure;
  }
}

}  // namespace

void bring_to_rest(Model& model, Constraints& constraints, const ExternalForces& external, double tolerance,
                   State& state) {
  double part = 0, step = 1;
  LoadStepSettings settings{.targets = {}, .tolerance = tolerance};
  for (const auto& force : external) settings.external.push_back(std::make_shared<PartOf>(force, part));
  Newton newton(model, constraints, settings);
  const Constraints::Prescribed whole = constraints.prescribed();
  std::fill(state.u.begin(), state.u.end(), 0.0);
  std::vector<double> from = state.u;
  double reached = 0;
  while (reached < 1) {
    part = std::min(1.0, reached + step);
    Constraints::Prescribed some = whole;
    for (double& offset : some.offset) offset *= part;
    constraints.set(some);
    for (std::size_t i = 0; i < from.size(); ++i)
      state.u[i] = reached > 0 ? part / reached * from[i] : 0;  // on the line through the last one
    constraints.apply(state.u);
    if (const auto failure = settle(newton, state)) {
      step *= 0.5;
      if (step < kLeastPart)
        throw SolverFailure(fmt::format(
            "the body finds no rest under the loads of time 0, beyond {:.3g} of them: {}. It may be "
            "free to move or to turn as a whole; try a load that holds it, smaller loads at time "
            "0, or {}",
            reached, *failure, model.remedies()));
      continue;
    }
    from = state.u;
    reached = part;
  }
  constraints.set(whole);
}

}  // namespace riven
