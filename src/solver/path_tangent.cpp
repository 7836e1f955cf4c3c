#include "solver/path_tangent.hpp"

#include <algorithm>
#include <cmath>

#include "solver/norms.hpp"

namespace riven {

namespace {

// Of the row bounds: keeps still what nothing holds, as that of Newton's method does. Where all is held it is
// left out: it would stiffen a long beam by some thousandths, and move the points where branches leave.
constexpr double kShift = 1e-10, kNotHeld = 1e-12;
constexpr int kInverseIterations = 30;

}  // namespace

PathTangent::PathTangent(Model& model, Constraints& constraints, const ExternalForces& external,
                         double difference)
    : model_(model), constraints_(constraints), external_(external), difference_(difference) {}

bool PathTangent::factor(std::span<const double> u, std::span<const double> row_bounds) {
  if (!matrix_) {
    matrix_.emplace(model_, constraints_, u);
    factors_.analyse(matrix_->matrix());
  }
  matrix_->assemble(u, external_, constraints_.parameter());
  if (shift_ < 0) {
    shift_ = 0;
    const double least = kNotHeld * *std::max_element(row_bounds.begin(), row_bounds.end());
    if (factor_shifted(row_bounds) && std::abs(softest().stiffness) >= least) return true;
    shift_ = kShift;
  }
  return factor_shifted(row_bounds);
}

bool PathTangent::factor_shifted(std::span<const double> row_bounds) {
  const auto entries = matrix_->entries();
  for (std::size_t row = 0; row < entries.size(); ++row)
    matrix_->diagonal(row) += shift_ * row_bounds[entries[row]];
  return factors_.factor(matrix_->matrix());
}

void PathTangent::solve(std::span<const double> force, std::span<double> increment) {
  const auto entries = matrix_->entries();
  std::vector<double> x(entries.size());
  for (std::size_t row = 0; row < x.size(); ++row) x[row] = force[entries[row]];
  factors_.solve(x);
  std::fill(increment.begin(), increment.end(), 0.0);
  for (std::size_t row = 0; row < x.size(); ++row) increment[entries[row]] = x[row];
}

std::optional<std::string> PathTangent::forces_at(double parameter, State& state, FreeForces& forces,
                                                  std::vector<double>& values) {
  State beside{.u = state.u};
  constraints_.set_parameter(parameter);
  constraints_.apply(beside.u);
  ++state.evaluations;
  if (auto failure = forces.evaluate(beside)) return failure;
  values.assign(forces.values().begin(), forces.values().end());
  return std::nullopt;
}

/// Central differences are exact for forces linear in the parameter; what prescribed displacements do is so
/// to 1e-10, which costs an iteration of Newton's method nothing.
std::optional<std::string> PathTangent::follow(State& state, FreeForces& forces,
                                               std::span<double> displacement) {
  const Constraints::Prescribed here = constraints_.prescribed();
  std::vector<double> more, less;
  auto failure = forces_at(here.parameter + difference_, state, forces, more);
  if (!failure) failure = forces_at(here.parameter - difference_, state, forces, less);
  constraints_.set(here);
  if (failure) return failure;
  for (std::size_t i = 0; i < more.size(); ++i) more[i] = (more[i] - less[i]) / (2 * difference_);
  solve(more, displacement);
  return std::nullopt;
}

PathTangent::Mode PathTangent::softest() {
  Mode mode;
  mode.shape.assign(model_.dofs(), 0.0);
  // Neither symmetric nor smooth: it has a part of every mode.
  for (const std::size_t entry : matrix_->entries())
    mode.shape[entry] = std::sin(1.0 + static_cast<double>(entry) * static_cast<double>(entry));
  std::vector<double> next(mode.shape.size());
  for (int n = 0; n < kInverseIterations; ++n) {
    const double size = norm(mode.shape);
    for (double& value : mode.shape) value /= size;
    solve(mode.shape, next);
    mode.stiffness = dot(next, mode.shape) / dot(next, next);
    std::swap(mode.shape, next);
  }
  const double size = norm(mode.shape);
  for (double& value : mode.shape) value /= size;
  return mode;
}

}  // namespace riven
