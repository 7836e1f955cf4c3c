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
        n_(model.dofs()) {
    state_.u.assign(n_, 0.0);
    state_.parameter = settings.start;
    for (auto* vector : {&force_, &old_force_, &velocity_, &mass_, &before_}) vector->assign(n_, 0.0);
  }

  State run() {
    constraints_.set_parameter(settings_.start);
    work_.begin(constraints_, settings_.start);
    offsets_.assign(constraints_.offsets().begin(), constraints_.offsets().end());
    for (const double target : settings_.targets) reach(target);
    return std::move(state_);
  }

 private:
  void reach(double target) {
    const double direction = target < state_.parameter ? -1 : 1;
    double increment = settings_.increment;
    int cuts = 0;
    while (direction * (target - state_.parameter) > 1e-12 * std::abs(target)) {
      const double left = std::abs(target - state_.parameter);
      // Equal steps to the target, none of them a crumb.
      const double count = std::ceil(left / increment - 1e-9);
      const double step = state_.steps == 0 ? std::min(left, kFirstStep * increment) : left / count;
      const bool last = step > left * (1 - 1e-9);
      const double next =
          state_.steps == 0 ? state_.parameter + direction * step : target - direction * (count - 1) * step;
      const auto failure = load_step(last ? target : next);
      if (!failure) {
        observer_.reached(state_, constraints_, last);
        if (cuts > 0 && ++good_steps_ >= 4) {
          --cuts;
          increment *= 2;
          good_steps_ = 0;
        }
        continue;
      }
      if (++cuts > kMostCuts) give_up(*failure);
      good_steps_ = 0;
      increment = 0.5 * (state_.steps == 0 ? increment : step);
      observer_.remarked(fmt::format("load step to {:.6g} failed ({}); going on with steps of {:.3g}", next,
                                     *failure, increment));
    }
  }

  [[noreturn]] void give_up(const std::string& failure) const {
    throw SolverFailure(
        fmt::format("no equilibrium beyond {:.6g} (load step {}), not even with load steps {} times smaller: "
                    "{}. The body may have lost stability there (wrinkling, folding), or the law may not "
                    "stand the load; try {}, or another load",
                    state_.parameter, state_.steps + 1, 1 << kMostCuts, failure, model_.remedies()));
  }

  /// Takes the state to a new parameter, or leaves it as it was and says why.
  std::optional<std::string> load_step(double target) {
    const std::vector<double> start = state_.u;
    constraints_.set_parameter(target);
    predict(target);
    auto failure = equilibrate(target);
    if (failure) {
      state_.u = start;
      constraints_.set_parameter(state_.parameter);
      return failure;
    }
    before_ = start;
    keep_offsets();
    state_.parameter = target;
    ++state_.steps;
    balance();
    return std::nullopt;
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

  std::optional<std::string> equilibrate(double target) {
    std::fill(velocity_.begin(), velocity_.end(), 0.0);
    constraints_.apply(state_.u);
    set_masses();
    StallWatch stall(std::max(kPatience, settings_.max_iterations / 4));
    double residual = 0;
    for (long iteration = 0; iteration < settings_.max_iterations; ++iteration) {
      std::swap(force_, old_force_);
      if (const auto breakdown = evaluate()) return text(*breakdown);
      const Sums sums = sweep();
      residual = std::sqrt(sums.force2) / std::max(constraints_.reaction_norm(), least_reaction_);
      const bool converged = residual <= settings_.tolerance;
      if (iteration % kProgressEvery == 0 || converged || !std::isfinite(residual)) {
        if (const auto breakdown = watchdog_.inspect(constraints_, state_.u, force_)) return text(*breakdown);
        report(target, iteration, residual);
      }
      if (converged) {
        const auto breakdown = model_.inspect(state_.u);
        return breakdown ? std::make_optional(text(*breakdown)) : std::nullopt;
      }
      if (stall.stalled(iteration, residual))
        return fmt::format("the residual has stalled for {} iterations: {}", stall.patience(),
                           unrest(residual));
      advance(damping(sums), iteration == 0);
    }
    return fmt::format("not converged in the {} iterations of solver.max_iterations: {}",
                       settings_.max_iterations, unrest(residual));
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

  void report(double target, long iteration, double residual) const {
    const double left = std::abs(settings_.targets.back() - state_.parameter) / settings_.increment;
    observer_.progressed({.parameter = target,
                          .reached = state_.parameter,
                          .begin = settings_.start,
                          .end = settings_.targets.back(),
                          .step = state_.steps + 1,
                          .steps = state_.steps + std::max(1L, std::lround(std::ceil(left - 1e-9))),
                          .iteration = iteration,
                          .evaluations = state_.evaluations,
                          .residual = residual,
                          .tolerance = settings_.tolerance});
  }

  Model& model_;
  Constraints& constraints_;
  const DynamicRelaxationSettings& settings_;
  Observer& observer_;
  Watchdog watchdog_;
  std::size_t n_;
  State state_;
  WorkIntegral work_{WorkIntegral::Rule::parabolic};
  std::vector<double> force_, old_force_, velocity_, mass_;
  std::vector<double> before_;                 // state one load step back
  double least_reaction_ = 0;                  // N, scale of the residual where there is next to no reaction
  std::vector<double> offsets_, last_change_;  // of the constraints (m): here, and in the last load step
  int good_steps_ = 0;                         // since the last cut
};

}  // namespace

State relax(Model& model, Constraints& constraints, const DynamicRelaxationSettings& settings,
            Observer& observer) {
  return Relaxation(model, constraints, settings, observer).run();
}

}  // namespace riven
