#include "solver/generalised_alpha.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "solver/norms.hpp"
#include "solver/tangent_system.hpp"
#include "solver/work.hpp"

namespace riven {

namespace {

constexpr int kMostIterations = 50;
constexpr int kHalvings = 8;
// Factors whose iterations leave more of the residual than this are made anew.
constexpr double kSlow = 0.1;
// Lengths of steps that differ by rounding are one to their factors.
constexpr double kRounding = 1e-9;
constexpr double kLeastMotion = 1e-4, kLeastStrain = 1e-6;  // as in slabs

class GeneralisedAlpha final : public TimeStepMethod {
 public:
  GeneralisedAlpha(Model& model, Constraints& constraints, const GeneralisedAlphaSettings& settings)
      : model_(model),
        constraints_(constraints),
        tolerance_(settings.tolerance),
        external_(settings.external),
        mass_(free_mass(model, constraints)) {
    const double radius = settings.spectral_radius;
    alpha_m_ = (2 * radius - 1) / (radius + 1);
    alpha_f_ = radius / (radius + 1);
    gamma_ = 0.5 - alpha_m_ + alpha_f_;
    beta_ = 0.25 * (1 - alpha_m_ + alpha_f_) * (1 - alpha_m_ + alpha_f_);
    const std::vector<double> zero(model.dofs(), 0.0);
    for (auto* vector : {&u_, &v_, &z_, &end_acceleration_, &residual_, &force_, &applied_, &state_})
      *vector = zero;
  }

  void restart(const State& state, std::span<const double>, std::span<const double> force) override {
    start_force_.assign(force.begin(), force.end());
    acceleration_.assign(force.size(), 0.0);
    for (std::size_t i = 0; i < force.size(); ++i)
      if (mass_[i] > 0) acceleration_[i] = force[i] / mass_[i];
    work_.begin(constraints_, state.parameter);
    system_.reset();  // bonds have left the pattern
    frozen_at_.clear();
  }
  void accept(std::span<const double>, std::span<const double> force) override {
    start_force_.assign(force.begin(), force.end());
    acceleration_ = end_acceleration_;
    work_ = next_work_;
  }

  std::optional<std::string> step(const State& from, double end) override;
  long lead_model_to(double s) override {
    model_.go_back();
    model_.go_on(s * h_);
    return 0;
  }
  void displacement(double s, std::span<double> u) const override;
  void velocity(double s, std::span<double> v) const override;
  [[nodiscard]] double work(double s) const override { return s * step_work_; }
  [[nodiscard]] double dissipated() const override { return 0; }
  [[nodiscard]] long evaluations() const override { return evaluations_; }
  [[nodiscard]] long iterations() const override { return iterations_; }
  [[nodiscard]] bool never_adds_energy() const override { return false; }  // it overshoots
  [[nodiscard]] std::string name() const override { return "Newton's method in a step"; }
  void save(Snapshot& to) const override {
    each_member(*this, to.saving());
    work_.save(to);
  }
  void restore(const Snapshot& from) override {
    each_member(*this, from.restoring());
    work_.restore(from);
  }

 private:
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    each("alpha.start_force", self.start_force_);
    each("alpha.acceleration", self.acceleration_);
    each("alpha.frozen_at", self.frozen_at_);
    each("alpha.frozen_step", self.frozen_step_);
    each("alpha.frozen_time", self.frozen_time_);
  }
  std::optional<Breakdown> evaluate();
  std::optional<std::string> solve();
  void constrain();
  /// What is remembered of the way is not saved with the factors: then they are of their own step.
  [[nodiscard]] bool is_frozen() const {
    return system_ && !model_.has_memory() && !have_memory(external_) &&
           std::abs(frozen_step_ - h_) <= kRounding * h_;
  }
  [[nodiscard]] bool freeze();
  [[nodiscard]] bool factor();
  [[nodiscard]] bool search(const std::vector<double>& direction);
  [[nodiscard]] double scale() const { return std::max(scale_, first_residual_); }
  /// How far from balance the step is, and where most.
  [[nodiscard]] std::string unrest() const {
    return fmt::format("a residual of {:.2g} is left (solver.tolerance {:.2g}), the largest force at {}",
                       residual_norm_ / scale(), tolerance_,
                       text(model_.place(Watchdog::largest(residual_))));
  }
  [[nodiscard]] double end_velocity(std::size_t i) const;

  Model& model_;
  Constraints& constraints_;
  double tolerance_;
  ExternalForces external_;
  std::vector<double> mass_;
  double alpha_m_ = 0, alpha_f_ = 0, gamma_ = 0, beta_ = 0;
  std::optional<TangentSystem> system_;
  std::vector<double> frozen_at_;                   // state of the factors' tangent; empty: there is none
  double frozen_step_ = 0, frozen_time_ = 0;        // s
  std::vector<double> start_force_, acceleration_;  // in the state that the step starts from
  std::vector<double> u_, v_;                       // the same
  double begin_ = 0, end_ = 0, h_ = 0;              // s
  std::vector<double> z_;                           // displacement in the step (m)
  std::vector<double> end_acceleration_, residual_, force_, applied_, state_;
  double residual_norm_ = 0, scale_ = 0, first_residual_ = 0;
  WorkIntegral work_{WorkIntegral::Rule::trapezoidal}, next_work_ = work_;
  double step_work_ = 0;
  long evaluations_ = 0, iterations_ = 0;
};

std::optional<std::string> GeneralisedAlpha::step(const State& from, double end) {
  evaluations_ = iterations_ = 0;
  if (!system_ && !frozen_at_.empty()) static_cast<void>(factor());  // as before, after a run was resumed
  u_ = from.u;
  v_ = from.v;
  begin_ = from.parameter;
  end_ = end;
  h_ = end - begin_;
  constraints_.set_parameter(end);
  for (std::size_t i = 0; i < u_.size(); ++i) z_[i] = h_ * v_[i];
  constrain();
  if (evaluate()) {
    std::fill(z_.begin(), z_.end(), 0.0);
    constrain();
    if (const auto breakdown = evaluate()) return text(*breakdown);
  }
  if (auto failure = solve()) return failure;
  next_work_ = work_;
  step_work_ = next_work_.since_last_call(constraints_, end);
  for (std::size_t i = 0; i < u_.size(); ++i) state_[i] = u_[i] + z_[i];
  for (const auto& external : external_) step_work_ += external->work(u_, begin_, state_, end);
  return std::nullopt;
}

/// Slaves follow the constraints at the step's end.
void GeneralisedAlpha::constrain() {
  for (std::size_t i = 0; i < u_.size(); ++i) state_[i] = u_[i] + z_[i];
  constraints_.apply(state_);
  for (std::size_t i = 0; i < u_.size(); ++i)
    if (!constraints_.is_free(i)) z_[i] = state_[i] - u_[i];
}

/// Of Newmark's formulas; what is prescribed moves evenly.
double GeneralisedAlpha::end_velocity(std::size_t i) const {
  if (mass_[i] == 0) return z_[i] / h_;
  return v_[i] + h_ * ((1 - gamma_) * acceleration_[i] + gamma_ * end_acceleration_[i]);
}

std::optional<Breakdown> GeneralisedAlpha::evaluate() {
  ++evaluations_;
  for (std::size_t i = 0; i < u_.size(); ++i) {
    state_[i] = u_[i] + z_[i];
    end_acceleration_[i] = (z_[i] - h_ * v_[i]) / (beta_ * h_ * h_) - (0.5 / beta_ - 1) * acceleration_[i];
    if (mass_[i] == 0) end_acceleration_[i] = 0;
  }
  std::fill(force_.begin(), force_.end(), 0.0);  // models leave out points without bonds
  static_cast<void>(lead_model_to(1));
  if (auto breakdown = model_.internal_force(state_, force_)) return breakdown;
  std::fill(applied_.begin(), applied_.end(), 0.0);
  if (!external_.empty()) {
    std::vector<double> v(u_.size());
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = end_velocity(i);
    for (const auto& external : external_) external->add(state_, v, end_, applied_);
    for (std::size_t i = 0; i < force_.size(); ++i) force_[i] += applied_[i];
  }
  constraints_.reduce(force_);
  double inertia2 = 0, momentum2 = 0;
  for (std::size_t i = 0; i < u_.size(); ++i) {
    const double inertia = mass_[i] * ((1 - alpha_m_) * end_acceleration_[i] + alpha_m_ * acceleration_[i]);
    residual_[i] = (1 - alpha_f_) * force_[i] + alpha_f_ * start_force_[i] - inertia;
    inertia2 += inertia * inertia;
    momentum2 += std::pow(mass_[i] * v_[i], 2);
  }
  residual_norm_ = norm(residual_);
  // Accelerations are differences of velocities: their scale is that of these, over the step.
  scale_ = std::sqrt(inertia2) + std::sqrt(momentum2) / h_ + constraints_.reaction_norm() + norm(applied_);
  return std::nullopt;
}

std::optional<std::string> GeneralisedAlpha::solve() {
  first_residual_ = residual_norm_;
  const double least = kLeastStrain * model_.spacing() * std::sqrt(static_cast<double>(model_.dofs()));
  std::vector<double> direction(u_.size());
  bool stale = !is_frozen();
  for (int n = 0; n < kMostIterations; ++n) {
    ++iterations_;
    const bool fresh = stale;
    if (stale && !freeze()) return "the tangent of the step is not positive definite";
    system_->solve(residual_, direction);
    for (double& entry : direction) entry /= 1 - alpha_f_;
    if (residual_norm_ <= tolerance_ * scale() &&
        norm(direction) <= tolerance_ * (norm(z_) + kLeastMotion * norm(u_) + least))
      return std::nullopt;
    const double before = residual_norm_;
    const bool moved = search(direction);
    if (!moved && fresh) return "no way down: " + unrest();
    stale = !moved || (residual_norm_ > kSlow * before && residual_norm_ > tolerance_ * scale());
  }
  return fmt::format("not converged in {} iterations: {}", kMostIterations, unrest());
}

/// New factors, for the state that the iterations have come to. They serve until they are slow.
bool GeneralisedAlpha::freeze() {
  frozen_at_.resize(u_.size());
  for (std::size_t i = 0; i < u_.size(); ++i) frozen_at_[i] = u_[i] + z_[i];
  frozen_time_ = end_;
  frozen_step_ = h_;
  ++evaluations_;
  static_cast<void>(lead_model_to(1));
  if (factor()) return true;
  system_.reset();
  frozen_at_.clear();
  return false;
}

bool GeneralisedAlpha::factor() {
  std::vector<double> force(frozen_at_.size());
  static_cast<void>(model_.internal_force(frozen_at_, force));  // as before: it was evaluated
  if (!system_) system_.emplace(model_, constraints_, frozen_at_, mass_);
  system_->assemble(frozen_at_, external_, frozen_time_);
  const double h = frozen_step_;
  return system_->factor((1 - alpha_m_) / ((1 - alpha_f_) * beta_ * h * h), mass_);
}

/// Goes along a direction, all of it or a part that lessens the residual. If none does, everything stays.
bool GeneralisedAlpha::search(const std::vector<double>& direction) {
  const std::vector<double> from = z_;
  const double before = residual_norm_;
  double part = 1;
  for (int halvings = 0; halvings <= kHalvings + 1; ++halvings, part *= 0.5) {
    if (halvings > kHalvings) part = 0;
    for (std::size_t i = 0; i < z_.size(); ++i) z_[i] = from[i] + part * direction[i];
    constrain();
    if (!evaluate() && part > 0 && (residual_norm_ < before || residual_norm_ <= tolerance_ * scale()))
      return true;
  }
  return false;
}

/// Hermite's cubic through displacements and velocities of both ends.
void GeneralisedAlpha::displacement(double s, std::span<double> u) const {
  for (std::size_t i = 0; i < u.size(); ++i)
    u[i] = u_[i] + s * s * (3 - 2 * s) * z_[i] + s * (1 - s) * h_ * ((1 - s) * v_[i] - s * end_velocity(i));
}

void GeneralisedAlpha::velocity(double s, std::span<double> v) const {
  for (std::size_t i = 0; i < v.size(); ++i)
    v[i] = 6 * s * (1 - s) * z_[i] / h_ + (1 - s) * (1 - 3 * s) * v_[i] + s * (3 * s - 2) * end_velocity(i);
}

}  // namespace

State generalised_alpha(Model& model, Constraints& constraints, const GeneralisedAlphaSettings& settings,
                        Observer& observer, const Snapshot* from) {
  if (!settings.step) throw InputError("the generalised-alpha method needs a step");
  return TimeSteps(model, constraints, settings,
                   std::make_unique<GeneralisedAlpha>(model, constraints, settings), observer)
      .run(from);
}

}  // namespace riven
