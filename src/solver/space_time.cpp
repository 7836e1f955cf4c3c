#include "solver/space_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "linalg/gmres.hpp"
#include "solver/norms.hpp"
#include "solver/slab.hpp"
#include "solver/tangent_matrix.hpp"
#include "spacetime/slab_operator.hpp"

namespace riven {

namespace {

constexpr int kMostIterations = 50;  // of a slab
constexpr int kHalvings = 8;         // of a step of Newton's method
// An operator whose iterations leave more of the residual than this is made anew, or made exact.
constexpr double kSlow = 0.3;
// The exact one costs a tangent for every stage: an operator of the slab itself may leave so much first.
constexpr double kSlowerThanExact = 0.5;
constexpr double kRounding = 1e-9;  // of a step: differences of times
// Of Newton's equations with the exact Jacobian; it then gains three digits or more per iteration.
constexpr double kInnerTolerance = 1e-3;
constexpr std::size_t kMostInner = 60;
// Increments are compared with the slab's motion, and with this part of all displacements; forces and
// displacements with those of such a strain at least.
constexpr double kLeastMotion = 1e-4, kLeastStrain = 1e-6;

using Pair = std::array<std::vector<double>, 2>;

/// y = A x for the lower triangle of a symmetric matrix, with the values given.
void multiply(const SymmetricMatrix& pattern, const std::vector<double>& values, std::span<const double> x,
              std::span<double> y) {
  std::fill(y.begin(), y.end(), 0.0);
  for (std::size_t i = 0; i < pattern.rows(); ++i)
    for (std::size_t k = pattern.begin[i]; k < pattern.begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(pattern.column[k]);
      y[i] += values[k] * x[j];
      if (j != i) y[j] += values[k] * x[i];
    }
}

class SpaceTime final : public TimeStepMethod {
 public:
  SpaceTime(Model& model, Constraints& constraints, const SpaceTimeSettings& settings)
      : model_(model),
        constraints_(constraints),
        external_(settings.external),
        tolerance_(settings.tolerance),
        slab_(model, constraints,
              settings.scheme == SlabKind::two_field ? two_field_scheme()
                                                     : single_field_scheme(settings.gauss_points),
              settings.external, settings.inertia),
        operator_(slab_.scheme()) {}

  void restart(const State&, std::span<const double> internal, std::span<const double>) override {
    accept(internal, {});
    tangent_.reset();  // bonds have left the pattern
    frozen_at_.clear();
  }
  void accept(std::span<const double> internal, std::span<const double>) override {
    internal_.assign(internal.begin(), internal.end());
  }

  std::optional<std::string> step(const State& from, double end) override {
    evaluations_ = iterations_ = 0;
    if (!tangent_ && !frozen_at_.empty()) thaw();
    slab_.begin(from, internal_, end);
    slab_.guess(true);
    if (evaluate()) {
      slab_.guess(false);
      if (const auto breakdown = evaluate()) return text(*breakdown);
    }
    return solve();
  }

  long lead_model_to(double s) override { return static_cast<long>(slab_.lead_model_to_time(s)); }
  void displacement(double s, std::span<double> u) const override { slab_.displacement(s, u); }
  void velocity(double s, std::span<double> v) const override { slab_.velocity(s, v); }
  [[nodiscard]] double work(double s) const override { return slab_.work(s); }
  [[nodiscard]] double dissipated() const override { return slab_.dissipated(); }
  [[nodiscard]] long evaluations() const override { return evaluations_; }
  [[nodiscard]] long iterations() const override { return iterations_; }
  [[nodiscard]] bool never_adds_energy() const override { return true; }
  [[nodiscard]] std::string name() const override { return "Newton's method in a slab"; }
  void save(Snapshot& to) const override { each_member(*this, to.saving()); }
  void restore(const Snapshot& from) override { each_member(*this, from.restoring()); }

 private:
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    each("slab.internal", self.internal_);
    each("slab.frozen_at", self.frozen_at_);
    each("slab.frozen_step", self.frozen_step_);
    each("slab.frozen_time", self.frozen_time_);
    each("slab.frozen_tangent", self.frozen_tangent_);
  }

  std::optional<Breakdown> evaluate() {
    evaluations_ += static_cast<long>(slab_.scheme().stages.size());
    return slab_.evaluate();
  }

  std::optional<std::string> solve();
  [[nodiscard]] bool search(const Pair& direction);
  [[nodiscard]] bool improve();
  [[nodiscard]] double scale() const {
    return std::max({slab_.residual_scale(), first_residual_, least_force_});
  }

  /// How far from balance the slab is, and where most.
  [[nodiscard]] std::string unrest() const {
    return fmt::format("a residual of {:.2g} is left (solver.tolerance {:.2g}), the largest force at {}",
                       slab_.residual_norm() / scale(), tolerance_,
                       text(model_.place(Watchdog::largest(slab_.residual()[1]))));
  }

  void freeze();
  void thaw();
  bool assemble(std::span<const double> u, double time);
  void factor();
  void find_direction(Pair& direction);
  void find_exact(std::span<double> x);
  void multiply_exact(std::span<double> x);
  void solve_frozen(std::span<double> x);

  Model& model_;
  Constraints& constraints_;
  ExternalForces external_;
  double tolerance_;
  Slab slab_;
  SlabOperator operator_;
  std::vector<double> internal_;  // in the state that the step starts from
  std::optional<TangentMatrix> tangent_;
  std::vector<double> unknown_mass_;          // of the tangent's rows (kg)
  std::vector<double> frozen_at_;             // state of the operator's tangent; empty: there is none
  double frozen_step_ = 0, frozen_time_ = 0;  // s
  // Its values, where what was remembered at that time is gone when a run is resumed.
  std::vector<double> frozen_tangent_;
  double least_force_ = 0;                           // N
  double first_residual_ = 0;                        // of the slab (N)
  bool fresh_ = false, exact_ = false;               // the operator is this slab's; the Jacobian is exact
  std::vector<std::vector<double>> stage_tangents_;  // values of the exact ones
  long evaluations_ = 0, iterations_ = 0;
};

std::optional<std::string> SpaceTime::solve() {
  fresh_ = exact_ = false;
  first_residual_ = slab_.residual_norm();
  if (!tangent_ || std::abs(frozen_step_ - slab_.length()) > kRounding * slab_.length()) freeze();
  Pair direction;
  const double least = kLeastStrain * model_.spacing() * std::sqrt(2.0 * static_cast<double>(model_.dofs()));
  double increment = std::numeric_limits<double>::infinity();
  for (int n = 0; n < kMostIterations; ++n) {
    ++iterations_;
    find_direction(direction);
    increment = std::hypot(norm(direction[0]), norm(direction[1]));
    if (slab_.residual_norm() <= tolerance_ * scale() &&
        increment <= tolerance_ * (slab_.motion() + kLeastMotion * slab_.start_norm() + least))
      return std::nullopt;
    const double before = slab_.residual_norm();
    const bool moved = search(direction);
    const double left = (fresh_ ? kSlowerThanExact : kSlow) * before;
    if (moved && slab_.residual_norm() <= std::max(left, tolerance_ * scale())) continue;
    if (!improve() && !moved) return "no way down: " + unrest();
  }
  return fmt::format("not converged in {} iterations: {}", kMostIterations, unrest());
}

/// Goes along a direction, all of it or a part that lessens the residual. If none does, everything stays.
bool SpaceTime::search(const Pair& direction) {
  const Pair from = slab_.unknowns();
  const double before = slab_.residual_norm();
  double part = 1;
  for (int halvings = 0; halvings <= kHalvings; ++halvings, part *= 0.5) {
    slab_.set(from, direction, part);
    if (!evaluate() && (slab_.residual_norm() < before || slab_.residual_norm() <= tolerance_ * scale()))
      return true;
  }
  slab_.set(from, direction, 0);
  static_cast<void>(evaluate());  // it could be before
  return false;
}

/// A better operator, if there is one.
bool SpaceTime::improve() {
  if (exact_) return false;
  if (fresh_) {
    exact_ = true;
  } else {
    freeze();
  }
  return true;
}

/// Makes the operator from the tangent in the middle of the slab, or at its start where that state is none.
void SpaceTime::freeze() {
  frozen_at_.resize(model_.dofs());
  slab_.displacement(0.5, frozen_at_);
  ++evaluations_;
  frozen_time_ = slab_.time(0.5);
  evaluations_ += static_cast<long>(slab_.lead_model_to_time(0.5));
  if (!assemble(frozen_at_, frozen_time_)) {
    slab_.displacement(0, frozen_at_);
    model_.go_back();
    frozen_time_ = slab_.time(0);
    ++evaluations_;
    static_cast<void>(assemble(frozen_at_, frozen_time_));
  }
  frozen_step_ = slab_.length();
  fresh_ = true;
  if (model_.has_memory() || have_memory(external_)) frozen_tangent_ = tangent_->matrix().value;
  factor();
}

/// As `freeze` left it, after a run has been resumed.
void SpaceTime::thaw() {
  static_cast<void>(assemble(frozen_at_, frozen_time_));
  if (!frozen_tangent_.empty()) tangent_->set_values(frozen_tangent_);
  factor();
}

bool SpaceTime::assemble(std::span<const double> u, double time) {
  std::vector<double> force(u.size());
  if (model_.internal_force(u, force)) return false;
  if (!tangent_) {
    tangent_.emplace(model_, constraints_, u, slab_.mass());
    operator_.analyse(tangent_->matrix());
    unknown_mass_.clear();
    for (const std::size_t entry : tangent_->entries()) unknown_mass_.push_back(slab_.mass()[entry]);
  }
  tangent_->assemble(u, external_, time);
  return true;
}

void SpaceTime::factor() {
  const double rows2 =
      ordered_sum_of(unknown_mass_.size(), [&](std::size_t i) { return std::pow(tangent_->diagonal(i), 2); });
  least_force_ = kLeastStrain * model_.spacing() * std::sqrt(rows2);
  operator_.factor(tangent_->matrix(), unknown_mass_, frozen_step_);
}

void SpaceTime::find_direction(Pair& direction) {
  const std::span<const std::size_t> entries = tangent_->entries();
  const std::size_t n = entries.size();
  std::vector<double> x(2 * n);
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t i = 0; i < n; ++i) x[a * n + i] = -slab_.residual()[a][entries[i]];
  if (exact_) {
    find_exact(x);
  } else {
    solve_frozen(x);
  }
  for (std::size_t a = 0; a < 2; ++a) {
    direction[a].assign(model_.dofs(), 0.0);
    for (std::size_t i = 0; i < n; ++i) direction[a][entries[i]] = x[a * n + i];
  }
}

void SpaceTime::solve_frozen(std::span<double> x) {
  operator_.solve(x.first(x.size() / 2), x.last(x.size() / 2));
}

/// Newton's direction by the tangents of all stages, theory (12).
void SpaceTime::find_exact(std::span<double> x) {
  std::vector<double> state(model_.dofs());
  stage_tangents_.clear();
  for (std::size_t q = 0; q < slab_.scheme().stages.size(); ++q) {
    slab_.stage(q, state);
    slab_.lead_model_to(q);
    ++evaluations_;
    static_cast<void>(assemble(state, slab_.time(slab_.scheme().stages[q].s)));
    stage_tangents_.push_back(tangent_->matrix().value);
  }
  gmres([this](std::span<double> y) { multiply_exact(y); }, [this](std::span<double> y) { solve_frozen(y); },
        kInnerTolerance, kMostInner, x);
}

void SpaceTime::multiply_exact(std::span<double> x) {
  const std::size_t n = x.size() / 2;
  const SlabScheme& scheme = slab_.scheme();
  const double h = slab_.length();
  std::vector<double> product(2 * n), combined(n), pulled(n);
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) {
      const double p = scheme.inertia(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) / (h * h);
      for (std::size_t i = 0; i < n; ++i) product[a * n + i] += p * unknown_mass_[i] * x[b * n + i];
    }
  for (std::size_t q = 0; q < scheme.stages.size(); ++q) {
    const SlabStage& stage = scheme.stages[q];
    for (std::size_t i = 0; i < n; ++i)
      combined[i] = stage.displacement[1] * x[i] + stage.displacement[2] * x[n + i];
    multiply(tangent_->matrix(), stage_tangents_[q], combined, pulled);
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t i = 0; i < n; ++i) product[a * n + i] += stage.test[a] * pulled[i];
  }
  std::copy(product.begin(), product.end(), x.begin());
}

}  // namespace

State march_slabs(Model& model, Constraints& constraints, const SpaceTimeSettings& settings,
                  Observer& observer, const Snapshot* from) {
  return TimeSteps(model, constraints, settings, std::make_unique<SpaceTime>(model, constraints, settings),
                   observer)
      .run(from);
}

}  // namespace riven
