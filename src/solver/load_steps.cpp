#include "solver/load_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace riven {

namespace {

constexpr double kFirstStep = 0.01;  // of the increment: tells the direction in which the body deforms
constexpr double kJump =
    0.02;  // of the energy; the quadrature of the work errs by less after the first steps
constexpr long kStepsOfPoorBalance = 3;
// Steps in which bonds break are halved this often first, so that they break at the load that breaks them.
constexpr int kCutsForBonds = 3;

}  // namespace

LoadSteps::LoadSteps(Model& model, Constraints& constraints, const LoadStepSettings& settings,
                     Methods methods, Observer& observer)
    : model_(model),
      constraints_(constraints),
      settings_(settings),
      methods_(std::move(methods)),
      observer_(observer) {
  state_.u.assign(model.dofs(), 0.0);
  state_.parameter = settings.start;
  start_ = before_ = overloaded_ = state_.u;
}

State LoadSteps::run(const Snapshot* from) {
  if (from != nullptr)
    restore(*from);
  else
    begin();
  while (target_ < settings_.targets.size()) {
    if (!stepping_) begin_step();
    iterate();
    observer_.safe_point([this] { return save(); });
  }
  return std::move(state_);
}

Snapshot LoadSteps::save() const {
  Snapshot to;
  each_member(*this, to.saving());
  work_.save(to);
  constraints_.save(to);
  model_.save(to);
  for (const auto& external : settings_.external) external->save(to);
  method().save(to);
  return to;
}

void LoadSteps::restore(const Snapshot& from) {
  each_member(*this, from.restoring());
  work_.restore(from);
  constraints_.restore(from);
  model_.restore(from);
  for (const auto& external : settings_.external) external->restore(from);
  method().restore(from);
}

void LoadSteps::begin() {
  constraints_.set_parameter(settings_.start);
  work_.begin(constraints_, settings_.start);
  for (const auto& external : settings_.external) external->advance(state_.u, settings_.start);
  offsets_.assign(constraints_.offsets().begin(), constraints_.offsets().end());
  increment_ = settings_.increment;
  skip_reached_targets();
}

void LoadSteps::skip_reached_targets() {
  const auto reached = [this](double target) {
    return std::abs(target - state_.parameter) <= 1e-12 * std::abs(target);
  };
  while (target_ < settings_.targets.size() && reached(settings_.targets[target_])) {
    ++target_;
    increment_ = settings_.increment;
    cuts_ = 0;
  }
}

/// Takes the loads one step further: equal steps to the target, none of them a crumb.
void LoadSteps::begin_step() {
  const double target = settings_.targets[target_];
  const double direction = target < state_.parameter ? -1 : 1;
  const double left = std::abs(target - state_.parameter);
  const double count = std::ceil(left / increment_ - 1e-9);
  step_ = state_.steps == 0 ? std::min(left, kFirstStep * increment_) : left / count;
  next_ = state_.steps == 0 ? state_.parameter + direction * step_ : target - direction * (count - 1) * step_;
  if (step_ > left * (1 - 1e-9)) next_ = target;
  start_ = state_.u;
  constraints_.set_parameter(next_);
  predict(next_);
  constraints_.apply(state_.u);
  begin_iterations();
}

void LoadSteps::begin_iterations() {
  method().begin(state_);
  iteration_ = 0;
  stepping_ = true;
}

/// First guess of the next state: the path so far, as far as the loads repeat their last change (not at all
/// where they stand still), or an affine motion with them.
void LoadSteps::predict(double target) {
  double last2 = 0, repeated = 0;
  const auto offsets = constraints_.offsets();
  for (std::size_t c = 0; c < last_change_.size(); ++c) {
    last2 += last_change_[c] * last_change_[c];
    repeated += last_change_[c] * (offsets[c] - offsets_[c]);
  }
  if (last2 > 0) {
    for (std::size_t i = 0; i < state_.u.size(); ++i)
      state_.u[i] += repeated / last2 * (state_.u[i] - before_[i]);
    return;
  }
  const AffineIncrement affine = constraints_.affine_increment(state_.parameter, target);
  model_.move(state_.u, affine.gradient, affine.shift);
}

void LoadSteps::iterate() {
  const Iteration iteration = method().iterate(state_, iteration_);
  if (iteration.worth_telling) report();
  ++iteration_;
  ++state_.iterations;
  if (iteration.outcome == Iteration::Outcome::failed) return retreat(iteration.failure);
  if (iteration.outcome == Iteration::Outcome::going_on) return;
  if (const auto breakdown = model_.inspect(state_.u)) return retreat(text(*breakdown));
  arrive();
}

/// The body is at rest; bonds that it overloads break, and it must come to rest again.
void LoadSteps::arrive() {
  Snapshot model;
  model_.save(model);
  const EnergyBalance energy = state_.energy;
  const WorkIntegral work = work_;
  const double lost = balance();
  const double broken = break_overloaded();
  if (!(broken > 0)) {
    if (!broken_) tell_jump(lost);
    return accept();
  }
  if (cuts_ < kCutsForBonds && !broken_) {
    model_.restore(model);
    state_.energy = energy;
    work_ = work;
    return cut();
  }
  broken_ = true;
  overloaded_ = state_.u;
  state_.energy.strain -= broken;
  state_.energy.dissipated += broken;
  begin_iterations();
}

/// Energy of the bonds that break in the present state (J).
double LoadSteps::break_overloaded() {
  const double before = model_.dissipated_energy();
  std::vector<double> force(state_.u.size());
  static_cast<void>(model_.advance(state_.u, force));
  return model_.dissipated_energy() - before;
}

void LoadSteps::accept() {
  stepping_ = false;
  before_ = start_;
  keep_offsets();
  state_.parameter = next_;
  ++state_.steps;
  for (const auto& external : settings_.external) external->advance(state_.u, next_);
  observer_.reached(state_, constraints_, next_ == settings_.targets[target_]);
  method_ = 0;
  if (broken_) {
    work_.begin(constraints_, next_);  // the forces fell while the loads stood still
    good_steps_ = 0;
  } else if (cuts_ > 0 && ++good_steps_ >= 4) {
    --cuts_;
    increment_ *= 2;
    good_steps_ = 0;
  }
  broken_ = false;
  skip_reached_targets();
}

void LoadSteps::keep_offsets() {
  const auto offsets = constraints_.offsets();
  last_change_.resize(offsets.size());
  for (std::size_t c = 0; c < offsets.size(); ++c) last_change_[c] = offsets[c] - offsets_[c];
  offsets_.assign(offsets.begin(), offsets.end());
}

/// Back to the start of the load step, to go on with smaller ones.
void LoadSteps::cut() {
  stepping_ = false;
  state_.u = start_;
  constraints_.set_parameter(state_.parameter);
  ++cuts_;
  good_steps_ = 0;
  increment_ = 0.5 * (state_.steps == 0 ? increment_ : step_);
}

/// The load step has failed: back to its start, and on with smaller ones, or by the next method. Where bonds
/// have broken there is no way back.
void LoadSteps::retreat(const std::string& failure) {
  if (!broken_ && cuts_ < method().most_cuts()) {
    cut();
    observer_.remarked(fmt::format("load step to {:.6g} failed ({}); going on with steps of {:.3g}", next_,
                                   failure, increment_));
    return;
  }
  if (method_ + 1 == methods_.size()) give_up(failure);
  ++method_;
  observer_.remarked(fmt::format("load step to {:.6g} failed ({}); going on with {} for this step", next_,
                                 failure, method().name()));
  if (broken_) {
    state_.u = overloaded_;
  } else {
    state_.u = start_;
    predict(next_);
    constraints_.apply(state_.u);
  }
  begin_iterations();
}

[[noreturn]] void LoadSteps::give_up(const std::string& failure) const {
  throw SolverFailure(
      fmt::format("no equilibrium beyond {:.6g} (load step {}), not even with load steps {} times smaller: "
                  "{}. The body may have lost stability there (wrinkling, folding), or the law may not "
                  "stand the load; try {}, or another load",
                  state_.parameter, state_.steps + 1, 1 << cuts_, failure, model_.remedies()));
}

/// Energies of the new state. Returns what the body lost, more than the loads took (J).
double LoadSteps::balance() {
  EnergyBalance& energy = state_.energy;
  const double before = energy.strain + energy.held - energy.external_work;
  energy.strain = model_.strain_energy(state_.u);
  if (!broken_) energy.external_work += work_.since_last_call(constraints_, next_);
  energy.held = 0;
  for (const auto& external : settings_.external) {
    // Where bonds have broken the loads stand still, but they follow the body.
    energy.external_work += broken_ ? external->work(overloaded_, next_, state_.u, next_)
                                    : external->work(start_, state_.parameter, state_.u, next_);
    energy.held += external->held(state_.u, next_);
  }
  // Energies below that of the least strain are rounding, and so is their balance.
  energy.largest = std::max({energy.largest, std::abs(energy.strain), std::abs(energy.external_work),
                             method().forces().least_energy()});
  const double lost = before - (energy.strain + energy.held - energy.external_work);
  if (broken_) energy.dissipated += lost;
  return lost;
}

void LoadSteps::tell_jump(double lost) {
  const double part = lost / state_.energy.largest;
  if (!model_.conservative() || state_.steps < kStepsOfPoorBalance || part <= kJump) return;
  observer_.remarked(
      fmt::format("in the load step to {:.6g} the body lost {:.2g} % of its energy: it has jumped to another "
                  "equilibrium (snapping, "
                  "wrinkling), and what it does in between depends on inertia, which statics leaves out",
                  next_, 100 * part));
}

void LoadSteps::report() const {
  const double left = std::abs(settings_.targets.back() - state_.parameter) / settings_.increment;
  observer_.progressed({.parameter = next_,
                        .reached = state_.parameter,
                        .begin = settings_.start,
                        .end = settings_.targets.back(),
                        .step = state_.steps + 1,
                        .steps = state_.steps + std::max(1L, std::lround(std::ceil(left - 1e-9))),
                        .iteration = iteration_,
                        .iterations = state_.iterations,
                        .evaluations = state_.evaluations,
                        .residual = method().forces().residual(),
                        .tolerance = settings_.tolerance});
}

}  // namespace riven
