#include "solver/velocity_verlet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "solver/dynamic_relaxation.hpp"
#include "solver/time_schedule.hpp"
#include "solver/watchdog.hpp"
#include "solver/work.hpp"

namespace riven {

namespace {

constexpr long kLeastEstimateInterval = 5, kMostEstimateInterval = 100;  // steps
// Verlet keeps the energy to the square of step times frequency, a few per cent at the most; beyond this the
// run is lost.
constexpr double kRunaway = 0.1;
constexpr double kMuchShorter = 0.95;  // stable step over the one before: it is falling

/// How fast time goes on: by whole steps, or by parts of them while bonds break too late.
class Pace {
 public:
  explicit Pace(double most_excess) : most_excess_(most_excess) {}
  /// Of the step's length.
  [[nodiscard]] double part() const { return 1.0 / static_cast<double>(1 << halvings_); }
  [[nodiscard]] bool has_changed() const { return changed_; }
  void look(const Passage& passage) {
    changed_ = false;
    if (passage.broken == 0 ? ++quiet_ < kPatience : passage.excess <= most_excess_) return;
    const int before = halvings_;
    halvings_ = passage.broken == 0 ? std::max(0, halvings_ - 1) : std::min(kMostHalvings, halvings_ + 1);
    quiet_ = 0;
    changed_ = halvings_ != before;
  }
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    each("verlet.pace.halvings", self.halvings_);
    each("verlet.pace.quiet", self.quiet_);
  }

 private:
  static constexpr int kMostHalvings = 3, kPatience = 16;
  double most_excess_;
  int halvings_ = 0, quiet_ = 0;
  bool changed_ = false;
};

class Verlet {
 public:
  Verlet(Model& model, Constraints& constraints, const VelocityVerletSettings& settings, Observer& observer)
      : model_(model),
        constraints_(constraints),
        settings_(settings),
        observer_(observer),
        watchdog_(model),
        n_(model.dofs()),
        outputs_(settings.every, settings.until),
        history_(settings.history_every, settings.until) {
    state_.parameter = 0;
    state_.u.assign(n_, 0.0);
    state_.v.assign(n_, 0.0);
    force_.assign(n_, 0.0);
    internal_.assign(n_, 0.0);
    inverse_mass_.assign(n_, 0.0);
    model_.mass(inverse_mass_);
    for (std::size_t i = 0; i < n_; ++i)
      inverse_mass_[i] = constraints_.is_free(i) && inverse_mass_[i] > 0 ? 1 / inverse_mass_[i] : 0;
  }

  State run(const Snapshot* from) {
    if (from != nullptr) restore(*from);
    if (from == nullptr || resting_) begin();
    while (unfinished()) {
      take_step();
      observer_.safe_point([this] { return save(); });
    }
    return std::move(state_);
  }

 private:
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    State::each_member(self.state_, "state", each);
    each("verlet.force", self.force_);
    each("verlet.step", self.step_);
    each("verlet.resting", self.resting_);
    each("verlet.limit", self.limit_);
    each("verlet.next_estimate", self.next_estimate_);
    each("verlet.estimate_interval", self.estimate_interval_);
    each("verlet.rest_energy", self.rest_energy_);
    Leg::each_member(self.leg_, "verlet.leg", each);
    Pace::each_member(self.pace_, each);
    Schedule::each_member(self.outputs_, "verlet.outputs", each);
    Schedule::each_member(self.history_, "verlet.history", each);
  }
  [[nodiscard]] Snapshot save() const {
    Snapshot to;
    each_member(*this, to.saving());
    work_.save(to);
    constraints_.save(to);
    model_.save(to);
    for (const auto& external : settings_.external) external->save(to);
    return to;
  }
  void restore(const Snapshot& from) {
    each_member(*this, from.restoring());
    work_.restore(from);
    constraints_.restore(from);
    model_.restore(from);
    for (const auto& external : settings_.external) external->restore(from);
  }

  [[nodiscard]] bool unfinished() const { return state_.parameter < settings_.until * (1 - 1e-12); }

  void begin() {
    std::fill(state_.u.begin(), state_.u.end(), 0.0);
    rest_energy_ = model_.strain_energy(state_.u);
    if (!settings_.initial_u.empty()) state_.u = settings_.initial_u;
    if (!settings_.initial_v.empty()) state_.v = settings_.initial_v;
    for (std::size_t i = 0; i < n_; ++i)
      if (inverse_mass_[i] == 0) state_.v[i] = 0;
    constraints_.set_parameter(0);
    constraints_.apply(state_.u);
    if (settings_.rest_tolerance) come_to_rest();
    evaluate();
    for (const auto& external : settings_.external) external->advance(state_.u, 0);
    break_bonds();
    if (settings_.rest_tolerance && model_.dissipated_energy() > 0)
      throw SolverFailure(
          "bonds would break under the loads of time 0 already, before the motion starts; try smaller loads "
          "at time 0, or solver.start = \"initial\"");
    work_.begin(constraints_, 0);
    estimate_step();
    balance();
    state_.energy.external_work = state_.energy.total();
    observer_.reached(state_, constraints_, true);
    plan();
  }

  /// Dynamic relaxation under the loads of time 0.
  void come_to_rest() {
    const LoadStepSettings settings{
        .targets = {}, .tolerance = *settings_.rest_tolerance, .external = settings_.external};
    DynamicRelaxation relaxation(model_, constraints_, settings);
    relaxation.begin(state_);
    resting_ = true;
    for (long number = 0;; ++number) {
      const Iteration iteration = relaxation.iterate(state_, number);
      if (iteration.outcome == Iteration::Outcome::converged) break;
      if (iteration.outcome == Iteration::Outcome::failed)
        throw SolverFailure(fmt::format(
            "the body finds no rest under the loads of time 0: {}. It may be free to move or to turn as a "
            "whole; try a load that holds it, smaller loads at time 0, a larger solver.start_tolerance, or "
            "solver.start = \"initial\"",
            iteration.failure));
      if (iteration.worth_telling) tell_progress();
      observer_.safe_point([this] { return save(); });
    }
    resting_ = false;
    std::fill(state_.v.begin(), state_.v.end(), 0.0);
  }

  /// Steps from here to the next time at which something is written.
  void plan() {
    leg_ = Leg::between(state_.parameter, std::min(outputs_.next(), history_.next()), pace_.part() * step_);
  }

  /// Every so many steps the stable step is estimated again and the body looked at.
  void take_step() {
    const bool last = leg_.done + 1 == leg_.steps, look = state_.steps + 1 == next_estimate_;
    step(leg_.step, leg_.next());
    ++leg_.done;
    if (look) look_around();
    if (last) write();
    if ((look || last || pace_.has_changed()) && unfinished()) plan();
  }

  void tell_progress() const {
    observer_.progressed({.parameter = state_.parameter,
                          .reached = state_.parameter,
                          .end = settings_.until,
                          .step = state_.steps,
                          .evaluations = state_.evaluations});
  }

  void look_around() {
    tell_progress();
    look_at_body();
    estimate_step();
    balance();
    check_energy();
    check_points();
  }

  void write() {
    look_at_body();
    balance();
    check_energy();
    const bool output = outputs_.due(leg_.end), row = history_.due(leg_.end);
    if (output) check_points();
    if (output || row) observer_.reached(state_, constraints_, output);
  }

  void step(double dt, double time) {
    const double before = state_.parameter;
    if (!settings_.external.empty()) u_before_ = state_.u;
    damp(0.5 * dt);
    kick(0.5 * dt, dt);
    state_.parameter = time;
    ++state_.steps;
    constraints_.set_parameter(time);
    constraints_.apply(state_.u);
    model_.go_on(dt);
    evaluate();
    kick(0.5 * dt, 0);
    damp(0.5 * dt);
    state_.energy.external_work += work_.since_last_call(constraints_, time);
    for (const auto& external : settings_.external) {
      state_.energy.external_work += external->work(u_before_, before, state_.u, time);
      external->advance(state_.u, time);
    }
    break_bonds();
  }

  /// Bonds that the step has stretched too far have done their work in it, so that the balance stays as exact
  /// as without them; they are gone from the next one on. Steps that find them late are followed by shorter
  /// ones.
  void break_bonds() {
    const Passage passage = model_.advance(state_.u, internal_);
    if (passage.breakdown) fail(*passage.breakdown);
    if (passage.broken > 0) {
      ++state_.evaluations;
      take_forces();
      work_.begin(constraints_, state_.parameter);
      if (passage.stiffer) estimate_soon();
    }
    pace_.look(passage);
  }

  /// The motion of dv/dt = -c v, exact over each half step, before and after the step of the other forces
  /// (Strang's splitting): stable for any c, and what it takes is known exactly.
  void damp(double duration) {
    if (settings_.damping == 0) return;
    const double before = kinetic_energy(), keep = std::exp(-settings_.damping * duration);
    parallel_pieces(n_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) state_.v[i] *= keep;
    });
    state_.energy.damped += before * (1 - keep * keep);
  }

  /// v += kick * F / m, then u += drift * v.
  void kick(double kick, double drift) {
    parallel_pieces(n_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        state_.v[i] += kick * force_[i] * inverse_mass_[i];
        state_.u[i] += drift * state_.v[i];
      }
    });
  }

  void evaluate() {
    ++state_.evaluations;
    if (const auto breakdown = model_.internal_force(state_.u, internal_))
      fail(watchdog_.inspect(constraints_, state_.u, state_.u, state_.v).value_or(*breakdown));
    take_forces();
  }

  /// All forces on the free entries, from the internal ones.
  void take_forces() {
    parallel_pieces(n_, [&](std::size_t begin, std::size_t end) {
      std::copy_n(internal_.data() + begin, end - begin, force_.data() + begin);
    });
    for (const auto& external : settings_.external)
      external->add(state_.u, state_.v, state_.parameter, force_);
    constraints_.reduce(force_);
  }

  void estimate_step() {
    const double limit = stable_step(model_, constraints_, state_.u, settings_.external, state_.parameter);
    estimate_interval_ = limit < kMuchShorter * limit_
                             ? kLeastEstimateInterval
                             : std::min(2 * estimate_interval_, kMostEstimateInterval);
    next_estimate_ = state_.steps + estimate_interval_;
    limit_ = limit;
    if (!settings_.step) {
      step_ = settings_.safety * limit;
      return;
    }
    step_ = *settings_.step;
    if (step_ <= limit) return;
    const std::string what = fmt::format("the step {:.4g} s is above the stable one, {:.4g} s", step_, limit);
    if (state_.steps == 0) throw InputError(what + "; leave solver.step out to have it chosen");
    throw SolverFailure(
        fmt::format("at t = {:.6g} s {}: the body has stiffened as it deformed; leave solver.step out to "
                    "have it follow",
                    state_.parameter, what));
  }

  void estimate_soon() {
    estimate_interval_ = kLeastEstimateInterval;
    next_estimate_ = std::min(next_estimate_, state_.steps + estimate_interval_);
  }

  [[nodiscard]] double mass(std::size_t i) const { return inverse_mass_[i] > 0 ? 1 / inverse_mass_[i] : 0; }

  /// Energy of motions too small to tell from rounding: a body at rest keeps no balance worth watching.
  [[nodiscard]] double rounding_energy() const {
    const double total = ordered_sum_of(n_, [&](std::size_t i) { return mass(i); });
    const double speed = watchdog_.size() / step_;
    return 1e-18 * total * speed * speed;
  }

  [[nodiscard]] double kinetic_energy() const {
    return ordered_sum_of(n_, [&](std::size_t i) { return 0.5 * mass(i) * state_.v[i] * state_.v[i]; });
  }

  void balance() {
    EnergyBalance& energy = state_.energy;
    energy.kinetic = kinetic_energy();
    energy.strain = model_.strain_energy(state_.u) - rest_energy_;
    energy.dissipated = model_.dissipated_energy();
    energy.held = 0;
    for (const auto& external : settings_.external) energy.held += external->held(state_.u, state_.parameter);
    energy.largest = std::max({energy.largest, energy.kinetic, std::abs(energy.strain), energy.dissipated,
                               energy.damped, std::abs(energy.held), std::abs(energy.external_work)});
  }

  void look_at_body() const {
    if (const auto breakdown = watchdog_.inspect(constraints_, state_.u, force_, state_.v)) fail(*breakdown);
  }

  void check_points() {
    if (const auto breakdown = model_.inspect(state_.u)) fail(*breakdown);
  }

  void check_energy() const {
    const EnergyBalance& energy = state_.energy;
    const double error = energy.error();
    // A bond that breaks does so at the first step beyond its limit: its energy is uncertain by what that
    // step adds, at the most by all of it.
    const double allowed = kRunaway * energy.largest + energy.dissipated;
    if (!model_.conservative() || std::abs(error) * energy.largest <= allowed ||
        energy.largest <= rounding_energy())
      return;
    const std::size_t fastest = Watchdog::largest(state_.v);
    throw SolverFailure(
        fmt::format("at t = {:.6g} s, step {}, the energy runs away: {:.1f} % of it came from nowhere; the "
                    "fastest point, {:.3g} m/s, is that at {}. The step of {:.4g} s is likely too long for "
                    "this deformation; try a smaller {}",
                    state_.parameter, state_.steps, 100 * error, std::abs(state_.v[fastest]),
                    text(model_.place(fastest)), step_, step_key()));
  }

  /// What sets the length of a step.
  [[nodiscard]] const char* step_key() const { return settings_.step ? "solver.step" : "solver.safety"; }

  [[noreturn]] void fail(const Breakdown& breakdown) const {
    throw SolverFailure(fmt::format(
        "at t = {:.6g} s, step {}: {}. The load may be too fast or too large for this lattice and "
        "law; try a slower load, a smaller {}, {}",
        state_.parameter, state_.steps, text(breakdown), step_key(), model_.remedies()));
  }

  Model& model_;
  Constraints& constraints_;
  const VelocityVerletSettings& settings_;
  Observer& observer_;
  Watchdog watchdog_;
  std::size_t n_;
  State state_;
  WorkIntegral work_{WorkIntegral::Rule::trapezoidal};
  std::vector<double> internal_, force_;
  std::vector<double> u_before_;      // at the start of the step, where there are external forces
  std::vector<double> inverse_mass_;  // 0 where nothing is free to move
  double step_ = 0;
  bool resting_ =
      false;  // on the way to the equilibrium that the motion starts from, which a resumed run begins anew
  double limit_ = 0;                                // stable step as estimated last (s)
  long next_estimate_ = 0;                          // number of the step after which it is estimated again
  long estimate_interval_ = kMostEstimateInterval;  // steps from one estimate to the next
  double rest_energy_ = 0;                          // that the model has without displacement (J)
  Leg leg_;
  Pace pace_{settings_.excess};
  Schedule outputs_, history_;
};

}  // namespace

double stable_step(Model& model, const Constraints& constraints, std::span<const double> u,
                   const ExternalForces& external, double time) {
  std::vector<double> bound(model.dofs()), mass(model.dofs());
  model.stiffness_bound(u, bound);
  for (const auto& force : external) force->stiffness_bound(u, time, bound);
  constraints.fold(bound);
  model.mass(mass);
  double largest = 0;  // bound of the highest squared frequency
  for (std::size_t i = 0; i < bound.size(); ++i)
    if (constraints.is_free(i) && mass[i] > 0) largest = std::max(largest, bound[i] / mass[i]);
  return 2 / std::sqrt(largest);
}

State march(Model& model, Constraints& constraints, const VelocityVerletSettings& settings,
            Observer& observer, const Snapshot* from) {
  return Verlet(model, constraints, settings, observer).run(from);
}

}  // namespace riven
