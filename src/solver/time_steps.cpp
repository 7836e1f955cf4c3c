#include "solver/time_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "solver/norms.hpp"
#include "solver/rest.hpp"
#include "solver/velocity_verlet.hpp"

namespace riven {

namespace {

// Of the step given, or of the first one: where shorter steps would be needed the run ends.
constexpr double kLeastStep = 1e-4;
// Energy from nowhere beyond this part of it is no error of a step.
constexpr double kRunaway = 0.1;
// Steps that are chosen: the energy that a method takes grows with the fourth power of its step, so that a
// step twice as long would take sixteen times as much.
constexpr double kGrowth = 16;
constexpr int kMostDoublings = 3;     // at a time
constexpr long kPatience = 4;         // steps after one that was too long
constexpr double kFirstStep = 2;      // stable steps of explicit methods
constexpr double kFirstPart = 1e-3;   // without inertia: of the run
constexpr double kLongestStep = 0.1;  // of the run

}  // namespace

TimeSteps::TimeSteps(Model& model, Constraints& constraints, const TimeStepSettings& settings,
                     std::unique_ptr<TimeStepMethod> method, Observer& observer)
    : model_(model),
      constraints_(constraints),
      settings_(settings),
      method_(std::move(method)),
      observer_(observer),
      watchdog_(model),
      mass_(settings.inertia ? free_mass(model, constraints) : std::vector<double>(model.dofs(), 0.0)),
      internal_(model.dofs(), 0.0),
      force_(model.dofs(), 0.0),
      outputs_(settings.every, settings.until),
      history_(settings.history_every, settings.until) {
  state_.parameter = 0;
  state_.u.assign(model.dofs(), 0.0);
  state_.v.assign(model.dofs(), 0.0);
}

State TimeSteps::run(const Snapshot* from) {
  if (from != nullptr) {
    restore(*from);
  } else {
    begin();
  }
  while (unfinished()) {
    take_step();
    observer_.safe_point([this] { return save(); });
  }
  return std::move(state_);
}

Snapshot TimeSteps::save() const {
  Snapshot to;
  each_member(*this, to.saving());
  method_->save(to);
  constraints_.save(to);
  model_.save(to);
  for (const auto& external : settings_.external) external->save(to);
  return to;
}

void TimeSteps::restore(const Snapshot& from) {
  each_member(*this, from.restoring());
  constraints_.restore(from);
  model_.restore(from);
  for (const auto& external : settings_.external) external->restore(from);
  method_->restore(from);
}

void TimeSteps::begin() {
  rest_energy_ = model_.strain_energy(state_.u);
  if (!settings_.initial_u.empty()) state_.u = settings_.initial_u;
  if (!settings_.initial_v.empty()) state_.v = settings_.initial_v;
  for (std::size_t i = 0; i < mass_.size(); ++i)
    if (mass_[i] == 0) state_.v[i] = 0;
  constraints_.set_parameter(0);
  constraints_.apply(state_.u);
  if (settings_.rest_tolerance) {
    for (const auto& external : settings_.external) external->advance(state_.u, 0);
    bring_to_rest(model_, constraints_, settings_.external, *settings_.rest_tolerance, state_);
    std::fill(state_.v.begin(), state_.v.end(), 0.0);
  }
  if (const auto breakdown = evaluate(state_)) fail(state_, text(*breakdown));
  for (const auto& external : settings_.external) external->advance(state_.u, 0);
  if (break_bonds() && settings_.rest_tolerance)
    throw SolverFailure(
        "bonds would break under the loads of time 0 already, before the motion starts; try smaller loads at "
        "time 0");
  method_->restart(state_, internal_, force_);
  wanted_ = settings_.step.value_or(
      settings_.inertia ? kFirstStep * stable_step(model_, constraints_, state_.u, settings_.external)
                        : kFirstPart * settings_.until);
  least_ = kLeastStep * wanted_;
  balance(state_);
  state_.energy.external_work = state_.energy.total();
  observer_.reached(state_, constraints_, true);
  plan();
}

void TimeSteps::take_step() {
  const Constraints::Prescribed start = constraints_.prescribed();
  State end;
  for (;;) {
    end = state_;
    auto failure = attempt(end);
    if (!failure && !is_too_long(end)) break;
    constraints_.set(start);
    shorten(failure.value_or("its steps take too much of the energy"));
  }
  show(state_, end, start);
  accept(std::move(end));
  tell_progress();
  lengthen();
}

/// The next step, all of it or not at all.
std::optional<std::string> TimeSteps::attempt(State& end) {
  auto failure = method_->step(state_, leg_.next());
  state_.evaluations += method_->evaluations();
  state_.iterations += method_->iterations();
  end.evaluations = state_.evaluations;
  end.iterations = state_.iterations;
  if (failure) return failure;
  end.parameter = leg_.next();
  ++end.steps;
  method_->displacement(1, end.u);
  method_->velocity(1, end.v);
  end.energy.external_work += method_->work(1);
  end.energy.damped += method_->dissipated();
  end.evaluations += method_->lead_model_to(1);
  if (const auto breakdown = evaluate(end)) return text(*breakdown);
  if (const auto breakdown = watchdog_.inspect(constraints_, end.u, force_, end.v)) return text(*breakdown);
  balance(end);
  return std::nullopt;
}

bool TimeSteps::is_too_long(const State& end) {
  const double energy = end.energy.largest;
  taken_ = energy > rounding_energy() ? std::abs(method_->dissipated()) / energy : 0;
  return !settings_.step && taken_ > settings_.step_tolerance;
}

void TimeSteps::shorten(const std::string& failure) {
  if (0.5 * leg_.step < least_)
    fail(state_,
         fmt::format("{} cannot go on: {}, with steps of {:.3g} s", method_->name(), failure, wanted_));
  wanted_ = 0.5 * leg_.step;
  good_ = 0;
  plan();
}

/// Longer steps, up to the given one, or as long as little energy is taken.
void TimeSteps::lengthen() {
  ++leg_.done;
  ++good_;
  double longer = wanted_;
  if (settings_.step) {
    if (good_ >= kPatience) longer = std::min(2 * wanted_, *settings_.step);
  } else if (good_ == state_.steps || good_ >= kPatience) {
    for (int n = 0; n < kMostDoublings && std::pow(kGrowth, n + 1) * taken_ < settings_.step_tolerance; ++n)
      longer *= 2;
    longer = std::min(longer, std::max(wanted_, kLongestStep * settings_.until));
  }
  if (longer == wanted_) return;
  wanted_ = longer;
  good_ = good_ == state_.steps ? good_ : 0;
  if (unfinished()) plan();
}

/// What is written at times inside the step, and at its end but for what breaks there.
void TimeSteps::show(const State& from, const State& end, const Constraints::Prescribed& start) {
  const Constraints::Prescribed at_end = constraints_.prescribed();
  const double h = end.parameter - from.parameter;
  bool inside = false;
  for (;;) {
    const double time = std::min(outputs_.next(), history_.next());
    if (time >= end.parameter * (1 - 1e-12)) break;
    inside = true;
    const double s = (time - from.parameter) / h;
    State state = end;
    state.parameter = time;
    method_->displacement(s, state.u);
    method_->velocity(s, state.v);
    state.energy = from.energy;
    state.energy.external_work += method_->work(s);
    state.energy.damped += method_->dissipated();
    constraints_.set(start);
    constraints_.set_parameter(time);
    constraints_.apply(state.u);
    state.evaluations += method_->lead_model_to(s);
    if (const auto breakdown = evaluate(state)) fail(state, text(*breakdown));
    balance(state);
    const bool output = outputs_.due(time);
    static_cast<void>(history_.due(time));
    if (output) check_points(state);
    observer_.reached(state, constraints_, output);
  }
  constraints_.set(at_end);
  if (!inside) return;
  State again = end;  // the forces there are what goes on
  static_cast<void>(method_->lead_model_to(1));
  static_cast<void>(evaluate(again));
}

void TimeSteps::accept(State end) {
  state_ = std::move(end);
  check_energy();
  const bool output = outputs_.due(state_.parameter), row = history_.due(state_.parameter);
  if (output) check_points(state_);
  for (const auto& external : settings_.external) external->advance(state_.u, state_.parameter);
  if (break_bonds()) {
    balance(state_);
    method_->restart(state_, internal_, force_);
  } else {
    method_->accept(internal_, force_);
  }
  if (output || row) observer_.reached(state_, constraints_, output);
}

bool TimeSteps::break_bonds() {
  const Passage passage = model_.advance(state_.u, internal_);
  if (passage.breakdown) fail(state_, text(*passage.breakdown));
  if (passage.broken == 0) return false;
  ++state_.evaluations;
  take_forces(state_);
  return true;
}

std::optional<Breakdown> TimeSteps::evaluate(State& state) {
  ++state.evaluations;
  std::fill(internal_.begin(), internal_.end(), 0.0);  // models leave out points without bonds
  if (const auto breakdown = model_.internal_force(state.u, internal_))
    return watchdog_.inspect(constraints_, state.u, state.u, state.v).value_or(*breakdown);
  take_forces(state);
  return std::nullopt;
}

void TimeSteps::take_forces(const State& state) {
  force_ = internal_;
  for (const auto& external : settings_.external) external->add(state.u, state.v, state.parameter, force_);
  constraints_.reduce(force_);
}

void TimeSteps::balance(State& state) {
  EnergyBalance& energy = state.energy;
  energy.kinetic =
      ordered_sum_of(mass_.size(), [&](std::size_t i) { return 0.5 * mass_[i] * state.v[i] * state.v[i]; });
  energy.strain = model_.strain_energy(state.u) - rest_energy_;
  energy.dissipated = model_.dissipated_energy();
  energy.held = 0;
  for (const auto& external : settings_.external) energy.held += external->held(state.u, state.parameter);
  energy.largest = std::max({energy.largest, energy.kinetic, std::abs(energy.strain), energy.dissipated,
                             energy.damped, std::abs(energy.held), std::abs(energy.external_work)});
}

/// Energy of motions too small to tell from rounding.
double TimeSteps::rounding_energy() const {
  const double mass = ordered_sum_of(mass_.size(), [&](std::size_t i) { return mass_[i]; });
  const double speed = watchdog_.size() / leg_.step;
  return 1e-18 * mass * speed * speed;
}

void TimeSteps::check_energy() const {
  const EnergyBalance& energy = state_.energy;
  // A bond that breaks does so at the first step beyond its limit: its energy is uncertain by all of it.
  if (!model_.conservative() || !method_->never_adds_energy() || energy.largest <= rounding_energy() ||
      energy.error() * energy.largest <= kRunaway * energy.largest + energy.dissipated)
    return;
  fail(state_, fmt::format("the energy runs away: {:.1f} % of it came from nowhere", 100 * energy.error()));
}

void TimeSteps::check_points(const State& state) const {
  if (const auto breakdown = model_.inspect(state.u)) fail(state, text(*breakdown));
}

void TimeSteps::tell_progress() const {
  observer_.progressed({.parameter = state_.parameter,
                        .reached = state_.parameter,
                        .end = settings_.until,
                        .step = state_.steps,
                        .evaluations = state_.evaluations});
}

void TimeSteps::fail(const State& state, const std::string& what) const {
  throw SolverFailure(fmt::format(
      "at t = {:.6g} s, step {}: {}. The load may be too fast or too large for this body and law; "
      "try a slower load, a smaller solver.step, a larger solver.tolerance, {}",
      state.parameter, state.steps, what, model_.remedies()));
}

}  // namespace riven
