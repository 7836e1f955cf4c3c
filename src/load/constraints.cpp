#include "load/constraints.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace riven {

namespace {

/// Sum of the terms that are displacements, or of those that are rates.
double sum_of(const Constraint& constraint, bool rates, double parameter) {
  double sum = 0;
  for (const PrescribedTerm& term : constraint.terms)
    if (term.rate == rates) sum += term.factor * term.displacement(term.position, parameter);
  return sum;
}

double travel(const Constraint& constraint, double from, double to) {
  const auto rate = [&](double t) { return sum_of(constraint, true, t); };
  return (to - from) / 6 * (rate(from) + 4 * rate(0.5 * (from + to)) + rate(to));
}

}  // namespace

void Constraints::add(Constraint constraint) {
  free_[constraint.slave] = false;
  if (constraint.master == Constraint::kNone) prescribed_at_[constraint.slave] = prescribed_.size();
  (constraint.master == Constraint::kNone ? prescribed_ : mirrored_).push_back(std::move(constraint));
  offset_.push_back(0.0);
  external_.push_back(0.0);
  travelled_.push_back(0.0);
}

void Constraints::set_parameter(double parameter) {
  std::size_t n = 0;
  for (const auto* list : {&prescribed_, &mirrored_})
    for (const Constraint& constraint : *list) {
      travelled_[n] = parameter == 0 ? 0 : travelled_[n] + travel(constraint, parameter_, parameter);
      offset_[n] = travelled_[n] + sum_of(constraint, false, parameter);
      ++n;
    }
  parameter_ = parameter;
}

void Constraints::set(const Prescribed& to) {
  parameter_ = to.parameter;
  travelled_ = to.travelled;
  offset_ = to.offset;
}

void Constraints::apply(std::span<double> u) const {
  std::size_t n = 0;
  for (const Constraint& constraint : prescribed_) u[constraint.slave] = offset_[n++];
  for (const Constraint& constraint : mirrored_)
    u[constraint.slave] = constraint.sign * u[constraint.master] + offset_[n++];
}

void Constraints::reduce(std::span<double> force) {
  for (Point& reaction : reaction_) reaction = {};
  double square = 0;
  const auto take = [&](const Constraint& constraint, std::size_t n) {
    const double external = -force[constraint.slave];
    external_[n] = external;
    square += external * external;
    for (const PrescribedTerm& term : constraint.terms)
      reaction_[term.load][static_cast<std::size_t>(term.axis)] += term.factor * external;
    force[constraint.slave] = 0;
  };
  for (std::size_t m = 0; m < mirrored_.size(); ++m) {
    if (mirrored_[m].chain_rule) force[mirrored_[m].master] += mirrored_[m].sign * force[mirrored_[m].slave];
    take(mirrored_[m], prescribed_.size() + m);
  }
  for (std::size_t p = 0; p < prescribed_.size(); ++p) take(prescribed_[p], p);
  reaction_norm_ = std::sqrt(square);
}

double Constraints::external_force(std::size_t dof) const {
  const auto found = prescribed_at_.find(dof);
  return found == prescribed_at_.end() ? 0 : external_[found->second];
}

void Constraints::fold(std::span<double> bound) const {
  for (const Constraint& constraint : mirrored_) {
    if (constraint.chain_rule) bound[constraint.master] += bound[constraint.slave];
    bound[constraint.slave] = 0;
  }
  for (const Constraint& constraint : prescribed_) bound[constraint.slave] = 0;
}

std::vector<Constraints::Image> Constraints::images() const {
  std::vector<Image> images(free_.size());
  for (std::size_t i = 0; i < images.size(); ++i)
    if (free_[i]) images[i].entry = i;
  for (const Constraint& constraint : mirrored_)
    images[constraint.slave] = {images[constraint.master].entry, constraint.sign};
  return images;
}

AffineIncrement Constraints::affine_increment(double from, double to) const {
  AffineIncrement result;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::array<double, 5>> rows;  // 1, x, y, z, du
    for (const auto* list : {&prescribed_, &mirrored_})
      for (const Constraint& constraint : *list)
        for (const PrescribedTerm& term : constraint.terms)
          if (term.axis == axis)
            rows.push_back({1, term.position[0], term.position[1], term.position[2],
                            term.displacement(term.position, to) - term.displacement(term.position, from)});
    if (rows.empty()) continue;
    Eigen::MatrixXd a(static_cast<Eigen::Index>(rows.size()), 4);
    Eigen::VectorXd b(a.rows());
    for (Eigen::Index r = 0; r < a.rows(); ++r) {
      for (Eigen::Index c = 0; c < 4; ++c)
        a(r, c) = rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
      b(r) = rows[static_cast<std::size_t>(r)][4];
    }
    const Eigen::VectorXd fit = a.completeOrthogonalDecomposition().solve(b);
    const auto row = static_cast<std::size_t>(axis);
    result.shift[row] = fit(0);
    result.gradient[row] = {fit(1), fit(2), fit(3)};
  }
  return result;
}

}  // namespace riven
