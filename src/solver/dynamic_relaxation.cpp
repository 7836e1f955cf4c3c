#include "solver/dynamic_relaxation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "solver/watchdog.hpp"
#include "solver/work.hpp"

namespace riven {

namespace {

constexpr int kMostCuts = 8;  // a step may be halved this often before the run gives up
constexpr double kLeastStrain =
    1e-6;  // reactions below those of such strains set no scale: a body that nothing loads
constexpr double kFirstStep = 0.01;  // of the increment: tells the direction in which the body deforms
constexpr double kJump =
    0.02;  // of the energy; the quadrature of the work errs by less after the first steps
constexpr long kStepsOfPoorBalance = 3;
constexpr double kLargestDamping = 1.9;  // below the critical 2 of eq. (11)
constexpr int kProgressEvery = 50;       // iterations
constexpr long kPatience =
    1000;  // iterations without progress; a quarter of solver.max_iterations if that is more

/// Sums that one iteration needs, gathered in one sweep.
struct Sums {
  double force2 = 0;     // F.F over free entries
  double stiffness = 0;  // v.K v, with K v = -(change of F) since the last step moved u by v
  double inertia = 0;    // v.D v

  Sums& operator+=(const Sums& other) {
    force2 += other.force2;
    stiffness += other.stiffness;
    inertia += other.inertia;
    return *this;
  }
};

class Relaxation {
 public:
  Relaxation(Model& model, Constraints& constraints, const DynamicRelaxationSettings& settings,
             Observer& observer)
      : model_(model),
        constraints_(constraints),
        settings_(settings),
        observer_(observer),
        watchdog_(model),
        stall_(std::max(kPatience, settings.max_iterations / 4)),
        n_(model.dofs()) {
    state_.u.assign(n_, 0.0);
    state_.parameter = settings.start;
    for (auto* vector : {&start_, &force_, &old_force_, &velocity_, &mass_, &before_})
      vector->assign(n_, 0.0);
  }

  State run(const Snapshot* from) {
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

 private:
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    State::each_member(self.state_, "state", each);
    each("relaxation.force", self.force_);
    each("relaxation.velocity", self.velocity_);
    each("relaxation.mass", self.mass_);
    each("relaxation.least_reaction", self.least_reaction_);
    each("relaxation.start", self.start_);
    each("relaxation.before", self.before_);
    each("relaxation.offsets", self.offsets_);
    each("relaxation.last_change", self.last_change_);
    each("relaxation.target", self.target_);
    each("relaxation.stepping", self.stepping_);
    each("relaxation.next", self.next_);
    each("relaxation.step", self.step_);
    each("relaxation.iteration", self.iteration_);
    StallWatch::each_member(self.stall_, each);
    each("relaxation.increment", self.increment_);
    each("relaxation.cuts", self.cuts_);
    each("relaxation.good_steps", self.good_steps_);
  }
  [[nodiscard]] Snapshot save() const {
    Snapshot to;
    each_member(*this, to.saving());
    work_.save(to);
    constraints_.save(to);
    model_.save(to);
    return to;
  }
  void restore(const Snapshot& from) {
    each_member(*this, from.restoring());
    work_.restore(from);
    constraints_.restore(from);
    model_.restore(from);
  }

  void begin() {
    constraints_.set_parameter(settings_.start);
    work_.begin(constraints_, settings_.start);
    offsets_.assign(constraints_.offsets().begin(), constraints_.offsets().end());
    increment_ = settings_.increment;
    skip_reached_targets();
  }

  void skip_reached_targets() {
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
  void begin_step() {
    const double target = settings_.targets[target_];
    const double direction = target < state_.parameter ? -1 : 1;
    const double left = std::abs(target - state_.parameter);
    const double count = std::ceil(left / increment_ - 1e-9);
    step_ = state_.steps == 0 ? std::min(left, kFirstStep * increment_) : left / count;
    next_ =
        state_.steps == 0 ? state_.parameter + direction * step_ : target - direction * (count - 1) * step_;
    if (step_ > left * (1 - 1e-9)) next_ = target;
    start_ = state_.u;
    constraints_.set_parameter(next_);
    predict(next_);
    std::fill(velocity_.begin(), velocity_.end(), 0.0);
    constraints_.apply(state_.u);
    set_masses();
    iteration_ = 0;
    stepping_ = true;
  }

  /// The load step has come to equilibrium.
  void accept() {
    stepping_ = false;
    before_ = start_;
    keep_offsets();
    state_.parameter = next_;
    ++state_.steps;
    balance();
    observer_.reached(state_, constraints_, next_ == settings_.targets[target_]);
    if (cuts_ > 0 && ++good_steps_ >= 4) {
      --cuts_;
      increment_ *= 2;
      good_steps_ = 0;
    }
    skip_reached_targets();
  }

  /// The load step has failed: back to its start, and on with smaller ones.
  void retreat(const std::string& failure) {
    stepping_ = false;
    state_.u = start_;
    constraints_.set_parameter(state_.parameter);
    if (++cuts_ > kMostCuts) give_up(failure);
    good_steps_ = 0;
    increment_ = 0.5 * (state_.steps == 0 ? increment_ : step_);
    observer_.remarked(fmt::format("load step to {:.6g} failed ({}); going on with steps of {:.3g}", next_,
                                   failure, increment_));
  }

  [[noreturn]] void give_up(const std::string& failure) const {
    throw SolverFailure(
        fmt::format("no equilibrium beyond {:.6g} (load step {}), not even with load steps {} times smaller: "
                    "{}. The body may have lost stability there (wrinkling, folding), or the law may not "
                    "stand the load; try {}, or another load",
                    state_.parameter, state_.steps + 1, 1 << kMostCuts, failure, model_.remedies()));
  }

  void keep_offsets() {
    const auto offsets = constraints_.offsets();
    last_change_.resize(offsets.size());
    for (std::size_t c = 0; c < offsets.size(); ++c) last_change_[c] = offsets[c] - offsets_[c];
    offsets_.assign(offsets.begin(), offsets.end());
  }

  /// First guess of the next state: the path so far, as far as the loads repeat their last change (not at all
  /// where they stand still), or an affine motion with them.
  void predict(double target) {
    double last2 = 0, repeated = 0;
    const auto offsets = constraints_.offsets();
    for (std::size_t c = 0; c < last_change_.size(); ++c) {
      last2 += last_change_[c] * last_change_[c];
      repeated += last_change_[c] * (offsets[c] - offsets_[c]);
    }
    if (last2 > 0) {
      for (std::size_t i = 0; i < n_; ++i) state_.u[i] += repeated / last2 * (state_.u[i] - before_[i]);
      return;
    }
    const AffineIncrement affine = constraints_.affine_increment(state_.parameter, target);
    model_.move(state_.u, affine.gradient, affine.shift);
  }

  void iterate() {
    std::swap(force_, old_force_);
    if (const auto breakdown = evaluate()) return retreat(text(*breakdown));
    const Sums sums = sweep();
    const double residual = std::sqrt(sums.force2) / std::max(constraints_.reaction_norm(), least_reaction_);
    const bool converged = residual <= settings_.tolerance;
    if (iteration_ % kProgressEvery == 0 || converged || !std::isfinite(residual)) {
      if (const auto breakdown = watchdog_.inspect(constraints_, state_.u, force_))
        return retreat(text(*breakdown));
      report(residual);
    }
    if (converged) {
      const auto breakdown = model_.inspect(state_.u);
      return breakdown ? retreat(text(*breakdown)) : accept();
    }
    if (stall_.stalled(iteration_, residual))
      return retreat(
          fmt::format("the residual has stalled for {} iterations: {}", stall_.patience(), unrest(residual)));
    advance(damping(sums), iteration_ == 0);
    if (++iteration_ == settings_.max_iterations)
      retreat(fmt::format("not converged in the {} iterations of solver.max_iterations: {}",
                          settings_.max_iterations, unrest(residual)));
  }

  /// How far from equilibrium the present state is, and where most.
  [[nodiscard]] std::string unrest(double residual) const {
    return fmt::format("a residual of {:.2g} is left (solver.tolerance {:.2g}), the largest force at {}",
                       residual, settings_.tolerance, text(model_.place(Watchdog::largest(force_))));
  }

  std::optional<Breakdown> evaluate() {
    ++state_.evaluations;
    if (const auto breakdown = model_.internal_force(state_.u, force_))
      return watchdog_.inspect(constraints_, state_.u, state_.u).value_or(*breakdown);
    constraints_.reduce(force_);
    return std::nullopt;
  }

  void set_masses() {
    model_.stiffness_bound(state_.u, mass_);
    constraints_.fold(mass_);
    const double rows2 = ordered_sum_of(n_, [&](std::size_t i) { return mass_[i] * mass_[i]; });
    least_reaction_ = kLeastStrain * model_.spacing() * std::sqrt(rows2);
    for (double& mass : mass_) mass *= 0.25;
  }

  /// Norm of the free force and the quotient for the damping. Slaves and padding hold zero force.
  Sums sweep() const {
    return ordered_sum<Sums>(n_, [&](std::size_t begin, std::size_t end) {
      Sums sums;
      for (std::size_t i = begin; i < end; ++i) {
        sums.force2 += force_[i] * force_[i];
        sums.stiffness -= (force_[i] - old_force_[i]) * velocity_[i];
        sums.inertia += mass_[i] * velocity_[i] * velocity_[i];
      }
      return sums;
    });
  }

  /// Critical damping of the frequency at which the body moves now. Eq. (11) takes the quotient over the
  /// displacement since the last load step, entry by entry; where that is mostly the load's own affine part
  /// it says nothing of the motion that is left.
  static double damping(const Sums& sums) {
    if (!(sums.stiffness > 0) || !(sums.inertia > 0)) return 0;
    return std::min(2 * std::sqrt(sums.stiffness / sums.inertia), kLargestDamping);
  }

  void advance(double c, bool first) {
    const double keep = first ? 0 : (2 - c) / (2 + c), push = first ? 0.5 : 2 / (2 + c);
    parallel_pieces(n_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (mass_[i] == 0) continue;
        velocity_[i] = keep * velocity_[i] + push * force_[i] / mass_[i];
        state_.u[i] += velocity_[i];
      }
    });
    constraints_.apply(state_.u);
  }

  /// Energies of the new state. A body that has jumped to another equilibrium lost energy that no load took.
  void balance() {
    EnergyBalance& energy = state_.energy;
    const double before = energy.strain - energy.external_work;
    energy.strain = model_.strain_energy(state_.u);
    energy.external_work += work_.since_last_call(constraints_, state_.parameter);
    // Energies below that of the least strain are rounding, and so is their balance.
    energy.largest = std::max({energy.largest, std::abs(energy.strain), std::abs(energy.external_work),
                               kLeastStrain * model_.spacing() * least_reaction_});
    const double lost = before - (energy.strain - energy.external_work);
    if (model_.conservative() && state_.steps > kStepsOfPoorBalance && lost > kJump * energy.largest)
      observer_.remarked(
          fmt::format("in the load step to {:.6g} the body lost {:.2g} % of its energy: it has jumped to "
                      "another equilibrium (snapping, "
                      "wrinkling), and what it does in between depends on inertia, which statics leaves out",
                      state_.parameter, 100 * lost / energy.largest));
  }

  void report(double residual) const {
    const double left = std::abs(settings_.targets.back() - state_.parameter) / settings_.increment;
    observer_.progressed({.parameter = next_,
                          .reached = state_.parameter,
                          .begin = settings_.start,
                          .end = settings_.targets.back(),
                          .step = state_.steps + 1,
                          .steps = state_.steps + std::max(1L, std::lround(std::ceil(left - 1e-9))),
                          .iteration = iteration_,
                          .evaluations = state_.evaluations,
                          .residual = residual,
                          .tolerance = settings_.tolerance});
  }

  Model& model_;
  Constraints& constraints_;
  const DynamicRelaxationSettings& settings_;
  Observer& observer_;
  Watchdog watchdog_;
  StallWatch stall_;
  std::size_t n_;
  State state_;
  WorkIntegral work_{WorkIntegral::Rule::parabolic};
  std::vector<double> force_, old_force_, velocity_, mass_;
  std::vector<double> start_, before_;         // states at the start of this load step, and of the last one
  double least_reaction_ = 0;                  // N, scale of the residual where there is next to no reaction
  std::vector<double> offsets_, last_change_;  // of the constraints (m): here, and in the last load step
  std::size_t target_ = 0;                     // number of the target that is aimed at
  bool stepping_ = false;                      // in the middle of a load step
  double next_ = 0, step_ = 0;                 // parameter at the end of this load step, and its length
  long iteration_ = 0;                         // of this load step
  double increment_ = 0;                       // largest load step, as it is cut now
  int cuts_ = 0;
  int good_steps_ = 0;  // since the last cut
};

}  // namespace

State relax(Model& model, Constraints& constraints, const DynamicRelaxationSettings& settings,
            Observer& observer, const Snapshot* from) {
  return Relaxation(model, constraints, settings, observer).run(from);
}

}  // namespace riven
