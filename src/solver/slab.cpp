#include "solver/slab.hpp"

#include <cmath>

#include "base/parallel.hpp"
#include "solver/norms.hpp"

namespace riven {

namespace {

/// Integral over [0, s] of the polynomial that is 1 at one of the stages and 0 at the others.
double integral_to(double s, std::size_t stage, const std::vector<SlabStage>& stages) {
  if (s == 1) return stages[stage].weight;
  static const TemporalRule rule = gauss_rule(4);  // exact for up to eight stages
  double sum = 0;
  for (std::size_t q = 0; q < rule.point.size(); ++q) {
    double value = rule.weight[q] * s;
    for (std::size_t k = 0; k < stages.size(); ++k)
      if (k != stage) value *= (s * rule.point[q] - stages[k].s) / (stages[stage].s - stages[k].s);
    sum += value;
  }
  return sum;
}

}  // namespace

Slab::Slab(Model& model, Constraints& constraints, SlabScheme scheme, const ExternalForces& external,
           bool inertia)
    : model_(model),
      constraints_(constraints),
      scheme_(std::move(scheme)),
      external_(external),
      mass_(inertia ? free_mass(model, constraints) : std::vector<double>(model.dofs(), 0.0)),
      power_(scheme_.stages.size(), 0.0) {
  const std::vector<double> zero(model.dofs(), 0.0);
  for (auto* vector : {&u_, &v_, &internal_, &z_[0], &z_[1], &residual_[0], &residual_[1], &start_internal_,
                       &state_, &stage_internal_, &applied_, &force_, &stage_v_})
    *vector = zero;
}

void Slab::begin(const State& from, std::span<const double> internal, double end) {
  u_ = from.u;
  v_ = from.v;
  internal_.assign(internal.begin(), internal.end());
  start_ = from.parameter;
  h_ = end - start_;
  prescribed_[0] = constraints_.prescribed();
  for (const std::size_t node : {1U, 2U}) {
    constraints_.set_parameter(node == 2 ? end : start_ + scheme_.path.node(node) * h_);
    prescribed_[node] = constraints_.prescribed();
  }
}

void Slab::guess(bool moving) {
  for (std::size_t k = 0; k < 2; ++k) {
    const double ahead = moving ? scheme_.path.node(k + 1) * h_ : 0;
    parallel_pieces(u_.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) z_[k][i] = ahead * v_[i];
    });
  }
  constrain();
}

void Slab::set(const std::array<std::vector<double>, 2>& from,
               const std::array<std::vector<double>, 2>& direction, double part) {
  for (std::size_t k = 0; k < 2; ++k)
    parallel_pieces(u_.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) z_[k][i] = from[k][i] + part * direction[k][i];
    });
  constrain();
}

void Slab::constrain() {
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t i = 0; i < u_.size(); ++i) state_[i] = u_[i] + z_[k][i];
    constraints_.set(prescribed_[k + 1]);
    constraints_.apply(state_);
    for (std::size_t i = 0; i < u_.size(); ++i)
      if (!constraints_.is_free(i)) z_[k][i] = state_[i] - u_[i];
  }
}

void Slab::add_up(double start, const SlabWeights& weights, std::span<double> out) const {
  parallel_pieces(u_.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      out[i] = start * u_[i] + weights[1] * z_[0][i] + weights[2] * z_[1][i];
  });
}

std::optional<Breakdown> Slab::evaluate() {
  for (auto& row : residual_) std::fill(row.begin(), row.end(), 0.0);
  std::fill(start_internal_.begin(), start_internal_.end(), 0.0);
  row_scale_ = {};
  for (std::size_t q = 0; q < scheme_.stages.size(); ++q) {
    lead_model_to(q);
    stage(q, state_);
    std::fill(stage_internal_.begin(), stage_internal_.end(), 0.0);  // models leave out points without bonds
    if (auto breakdown = model_.internal_force(state_, stage_internal_)) return breakdown;
    add_stage(q, stage_internal_);
  }
  add_inertia();
  residual_norm_ = std::hypot(norm(residual_[0]), norm(residual_[1]));
  residual_scale_ = std::hypot(row_scale_[0], row_scale_[1]);
  return std::nullopt;
}

void Slab::lead_model_to(std::size_t stage) {
  if (stage == 0) {
    model_.go_back();
    model_.go_on(scheme_.stages[0].s * h_);
  } else {
    model_.go_on((scheme_.stages[stage].s - scheme_.stages[stage - 1].s) * h_);
  }
}

std::size_t Slab::lead_model_to_time(double s) {
  model_.go_back();
  if (!model_.has_memory()) return 0;
  std::size_t passed = 0;
  for (; passed < scheme_.stages.size() && scheme_.stages[passed].s < s * (1 - 1e-12); ++passed) {
    lead_model_to(passed);
    stage(passed, state_);
    static_cast<void>(model_.internal_force(state_, stage_internal_));  // as before: it was evaluated
  }
  model_.go_on((passed == 0 ? s : s - scheme_.stages[passed - 1].s) * h_);
  return passed;
}

void Slab::add_stage(std::size_t number, std::span<const double> internal) {
  const SlabStage& stage = scheme_.stages[number];
  force_.assign(internal.begin(), internal.end());
  power_[number] = 0;
  double applied_norm = 0;
  if (!external_.empty()) {
    add_up(0, stage.velocity, stage_v_);
    for (double& entry : stage_v_) entry /= h_;
    std::fill(applied_.begin(), applied_.end(), 0.0);
    for (const auto& external : external_) external->add(state_, stage_v_, start_ + stage.s * h_, applied_);
    for (std::size_t i = 0; i < force_.size(); ++i) force_[i] += applied_[i];
    power_[number] = dot(applied_, stage_v_);
    applied_norm = norm(applied_);
  }
  constraints_.reduce(force_);
  power_[number] += power_of_constraints(stage.velocity);
  for (std::size_t a = 0; a < 2; ++a) {
    row_scale_[a] += std::abs(stage.test[a]) * (constraints_.reaction_norm() + applied_norm);
    parallel_pieces(force_.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) residual_[a][i] -= stage.test[a] * force_[i];
    });
  }
  if (scheme_.stage_at_start.empty()) return;
  for (std::size_t i = 0; i < internal.size(); ++i)
    start_internal_[i] += scheme_.stage_at_start[number] * internal[i];
}

double Slab::power_of_constraints(const SlabWeights& velocity) const {
  const std::span<const double> force = constraints_.forces();
  double power = 0;
  for (std::size_t n = 0; n < force.size(); ++n) {
    double rate = 0;
    for (std::size_t k = 0; k < 3; ++k) rate += velocity[k] / h_ * prescribed_[k].offset[n];
    power += force[n] * rate;
  }
  return power;
}

void Slab::add_inertia() {
  for (Eigen::Index a = 0; a < 2; ++a) {
    const double p1 = scheme_.inertia(a, 0) / (h_ * h_), p2 = scheme_.inertia(a, 1) / (h_ * h_),
                 p = scheme_.start(a) / h_;
    std::vector<double>& row = residual_[static_cast<std::size_t>(a)];
    parallel_pieces(row.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        row[i] += mass_[i] * (p1 * z_[0][i] + p2 * z_[1][i] - p * v_[i]);
    });
    // Of a body that only flies, both parts are large and their difference is nothing.
    row_scale_[static_cast<std::size_t>(a)] +=
        std::abs(p) * std::sqrt(ordered_sum_of(
                          v_.size(), [&](std::size_t i) { return std::pow(mass_[i] * v_[i], 2); })) +
        std::sqrt(ordered_sum_of(v_.size(), [&](std::size_t i) {
          return std::pow(mass_[i] * (p1 * z_[0][i] + p2 * z_[1][i]), 2);
        }));
  }
}

double Slab::motion() const {
  return std::hypot(norm(z_[0]), norm(z_[1]));
}

double Slab::start_norm() const {
  return std::sqrt(2.0) * norm(u_);
}

void Slab::displacement(double s, std::span<double> u) const {
  add_up(1, {scheme_.path.value(0, s), scheme_.path.value(1, s), scheme_.path.value(2, s)}, u);
}

void Slab::velocity(double s, std::span<double> v) const {
  const QuadraticLagrange& path = scheme_.path;
  const double rest = path.value(0, s);
  SlabWeights weights{};
  for (std::size_t k = 0; k < 3; ++k) weights[k] = (path.first(k, s) - rest * path.first(k, 0)) / h_;
  add_up(0, weights, v);
  for (std::size_t i = 0; i < v.size(); ++i) v[i] += rest * v_[i];
}

double Slab::work(double s) const {
  double work = 0;
  for (std::size_t q = 0; q < power_.size(); ++q) work += integral_to(s, q, scheme_.stages) * power_[q];
  work *= h_;
  // So far what forces do on the body: what they came to hold meanwhile, as contacts do, is from outside too.
  std::vector<double> u(external_.empty() ? 0 : u_.size());
  if (!external_.empty()) displacement(s, u);
  for (const auto& external : external_)
    work += external->held(u, start_ + s * h_) - external->held(u_, start_);
  return work;
}

double Slab::dissipated() const {
  const SlabWeights &at = scheme_.displacement_at_start, &rate = scheme_.velocity_at_start;
  const double by_velocity = ordered_sum_of(u_.size(), [&](std::size_t i) {
    const double jump = (rate[1] * z_[0][i] + rate[2] * z_[1][i]) / h_ - v_[i];
    return 0.5 * mass_[i] * jump * jump;
  });
  if (scheme_.stage_at_start.empty()) return by_velocity;
  return by_velocity + ordered_sum_of(u_.size(), [&](std::size_t i) {
           const double jump = at[1] * z_[0][i] + at[2] * z_[1][i];
           return -0.5 * (start_internal_[i] - internal_[i]) * jump;
         });
}

}  // namespace riven
