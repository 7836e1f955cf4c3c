#include "peridynamics/point_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/error.hpp"

namespace riven {

namespace {

Eigen::Vector2d plane(const Point& p) {
  return {p[0], p[1]};
}

}  // namespace

PointModel::PointModel(Body body, std::vector<double> density)
    : body_(std::move(body)), density_(std::move(density)) {
  for (const Shape& shape : body_.defects.inclusions) {
    Inclusion inclusion;
    double area = 0;
    if (const auto* disc = std::get_if<Disc>(&shape)) {
      inclusion.center = plane(disc->center);
      inclusion.gyration = disc->radius / std::sqrt(2.0);
      area = std::numbers::pi * disc->radius * disc->radius;
    } else if (const auto* box = std::get_if<Box>(&shape)) {
      inclusion.center = plane(box->center);
      inclusion.gyration = std::hypot(box->half_size[0], box->half_size[1]) / std::sqrt(3.0);
      area = 4 * box->half_size[0] * box->half_size[1];
    }
    if (body_.dimension != 2 || area == 0)
      throw InputError("an inclusion is a disc or a box in two dimensions");
    inclusion.mass = density_.front() * area * body_.thickness;
    inclusions_.push_back(inclusion);
  }
  surface_.assign(body_.interface.size(), Eigen::Vector2d::Zero());
  for (const std::size_t i : body_.points) directed_bonds_ += body_.family_size(i);
}

ModelField PointModel::damage() const {
  ModelField damage{"damage", 1, {}, {}};
  for (const std::size_t i : body_.points) damage.values.push_back(body_.damage(i));
  for (const auto& inclusion : body_.rigid_points)
    damage.values.resize(damage.values.size() + inclusion.size());
  return damage;
}

std::size_t PointModel::dofs() const {
  return inclusion_dof(inclusions_.size());
}

std::size_t PointModel::inclusion_dof(std::size_t inclusion) const {
  return static_cast<std::size_t>(body_.dimension) * body_.size() + 3 * inclusion;
}

Eigen::Vector2d PointModel::arm(const InterfaceBond& bond) const {
  return plane(bond.end) - inclusions_[bond.inclusion].center;
}

void PointModel::place_inclusions(std::span<const double> u) {
  for (std::size_t c = 0; c < inclusions_.size(); ++c)
    inclusions_[c].rotation = Eigen::Rotation2Dd(u[inclusion_dof(c) + 2] / inclusions_[c].gyration);
  for (std::size_t n = 0; n < surface_.size(); ++n) {
    const std::size_t dof = inclusion_dof(body_.interface[n].inclusion);
    const Eigen::Vector2d from = arm(body_.interface[n]);
    surface_[n] = Eigen::Vector2d(u[dof], u[dof + 1]) +
                  inclusions_[body_.interface[n].inclusion].rotation * from - from;
  }
}

void PointModel::push_inclusion(End surface, const Eigen::Vector2d& pull, std::span<double> force) const {
  const InterfaceBond& bond = body_.interface[surface - body_.size()];
  const Inclusion& inclusion = inclusions_[bond.inclusion];
  const std::size_t dof = inclusion_dof(bond.inclusion);
  const Eigen::Vector2d lever = inclusion.rotation * arm(bond);
  force[dof] += pull.x();
  force[dof + 1] += pull.y();
  force[dof + 2] += (lever.x() * pull.y() - lever.y() * pull.x()) / inclusion.gyration;
}

void PointModel::add_family_block(std::size_t point, std::span<const End> ends,
                                  const Eigen::VectorXd& gradient, const Eigen::MatrixXd& hessian,
                                  TangentBlocks& to) const {
  const Eigen::Index d = body_.dimension, bonds = hessian.rows();
  // A bond is its end less its point, which comes first.
  Eigen::MatrixXd block(d + bonds, d + bonds);
  block.bottomRightCorner(bonds, bonds) = hessian;
  block.topRows(d).setZero();
  for (Eigen::Index b = 0; b < bonds; b += d) block.topRightCorner(d, bonds) -= hessian.middleRows(b, d);
  block.bottomLeftCorner(bonds, d) = block.topRightCorner(d, bonds).transpose();
  for (Eigen::Index b = d; b < d + bonds; b += d) block.topLeftCorner(d, d) -= block.block(0, b, d, d);

  std::vector<std::size_t> dofs;
  const auto add_end = [&](std::size_t end) {
    for (int axis = 0; axis < body_.dimension; ++axis)
      dofs.push_back(static_cast<std::size_t>(axis) * body_.size() + end);
  };
  add_end(point);
  for (const End end : ends) add_end(end);
  if (std::any_of(ends.begin(), ends.end(), [this](End end) { return is_surface(end); }))
    move_to_inclusions(ends, gradient, dofs, block);
  to.dofs.insert(to.dofs.end(), dofs.begin(), dofs.end());
  to.begin.push_back(to.dofs.size());
  to.values.insert(to.values.end(), block.data(), block.data() + block.size());
}

/// A surface point moves by q = (translation, angle times radius of gyration g): by 1 and by the turned arm
/// over g, which itself turns, so that the pull on it adds to the second derivative by the angle.
void PointModel::move_to_inclusions(std::span<const End> ends, const Eigen::VectorXd& gradient,
                                    std::vector<std::size_t>& dofs, Eigen::MatrixXd& block) const {
  std::set<std::size_t> touched;  // inclusions
  for (const End end : ends)
    if (is_surface(end)) touched.insert(body_.interface[end - body_.size()].inclusion);
  const Eigen::Index rows = block.rows();
  Eigen::MatrixXd moves = Eigen::MatrixXd::Zero(rows, rows + 3 * static_cast<Eigen::Index>(touched.size()));
  Eigen::VectorXd turning = Eigen::VectorXd::Zero(moves.cols());
  for (Eigen::Index r = 0; r < rows; ++r) moves(r, r) = 1;
  for (std::size_t n = 0; n < ends.size(); ++n) {
    if (!is_surface(ends[n])) continue;
    const InterfaceBond& bond = body_.interface[ends[n] - body_.size()];
    const Inclusion& inclusion = inclusions_[bond.inclusion];
    const Eigen::Vector2d lever = inclusion.rotation * arm(bond) / inclusion.gyration;
    const auto at = static_cast<Eigen::Index>(2 * n), row = at + 2,
               column = rows + 3 * std::distance(touched.begin(), touched.find(bond.inclusion));
    moves.block<2, 2>(row, row).setZero();
    moves.block<2, 2>(row, column).setIdentity();
    moves.block<2, 1>(row, column + 2) = Eigen::Vector2d(-lever.y(), lever.x());
    turning(column + 2) -= gradient.segment<2>(at).dot(lever) / inclusion.gyration;
  }
  const Eigen::MatrixXd moved = moves.transpose() * block * moves;
  block = moved + Eigen::MatrixXd(turning.asDiagonal());
  // What the surface points' own entries have left is nothing; the point's are as good a name as any.
  for (std::size_t n = 0; n < ends.size(); ++n)
    if (is_surface(ends[n]))
      std::copy_n(dofs.begin(), 2, dofs.begin() + static_cast<std::ptrdiff_t>(2 * n + 2));
  for (const std::size_t inclusion : touched)
    for (std::size_t entry = 0; entry < 3; ++entry) dofs.push_back(inclusion_dof(inclusion) + entry);
}

void PointModel::add_row(End end, double row, std::span<double> bound) const {
  if (!is_surface(end)) {
    for (int axis = 0; axis < body_.dimension; ++axis)
      bound[static_cast<std::size_t>(axis) * body_.size() + end] += row;
    return;
  }
  const InterfaceBond& bond = body_.interface[end - body_.size()];
  const std::size_t dof = inclusion_dof(bond.inclusion);
  const double lever = arm(bond).norm() / inclusions_[bond.inclusion].gyration;
  // The bond's end moves by the translation and by the lever times the rotation's entry: each row has both.
  bound[dof] += row * (1 + lever);
  bound[dof + 1] += row * (1 + lever);
  bound[dof + 2] += row * lever * (1 + lever);
}

void PointModel::mass(std::span<double> mass) const {
  std::fill(mass.begin(), mass.end(), 0.0);
  for (int axis = 0; axis < body_.dimension; ++axis)
    for (const std::size_t i : body_.points)
      mass[static_cast<std::size_t>(axis) * body_.size() + i] =
          density_[body_.material_of(i)] * body_.volume[i];
  for (std::size_t c = 0; c < inclusions_.size(); ++c)
    for (std::size_t d = 0; d < 3; ++d) mass[inclusion_dof(c) + d] = inclusions_[c].mass;
}

void PointModel::move(std::span<double> u, const std::array<std::array<double, 3>, 3>& gradient,
                      const Point& shift) const {
  const auto displacement = [&](const Point& x, std::size_t axis) {
    return shift[axis] + gradient[axis][0] * x[0] + gradient[axis][1] * x[1] + gradient[axis][2] * x[2];
  };
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(body_.dimension); ++axis) {
    for (const std::size_t i : body_.points)
      u[axis * body_.size() + i] += displacement(body_.position(i), axis);
    for (std::size_t c = 0; c < inclusions_.size(); ++c)
      u[inclusion_dof(c) + axis] +=
          displacement({inclusions_[c].center.x(), inclusions_[c].center.y(), 0}, axis);
  }
}

std::vector<Point> PointModel::positions() const {
  std::vector<Point> positions;
  for (const std::size_t i : body_.points) positions.push_back(body_.position(i));
  for (const auto& inclusion : body_.rigid_points)
    for (const std::size_t i : inclusion) positions.push_back(body_.position(i));
  return positions;
}

Point PointModel::place(std::size_t entry) const {
  if (entry < inclusion_dof(0)) return body_.position(entry % body_.size());
  const Inclusion& inclusion = inclusions_[(entry - inclusion_dof(0)) / 3];
  return {inclusion.center.x(), inclusion.center.y(), 0};
}

std::vector<Point> PointModel::displacements(std::span<const double> u) const {
  std::vector<Point> displacements;
  for (const std::size_t i : body_.points) {
    Point& d = displacements.emplace_back();
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(body_.dimension); ++axis)
      d[axis] = u[axis * body_.size() + i];
  }
  for (std::size_t c = 0; c < inclusions_.size(); ++c) {
    const std::size_t dof = inclusion_dof(c);
    const Eigen::Rotation2Dd rotation(u[dof + 2] / inclusions_[c].gyration);
    for (const std::size_t i : body_.rigid_points[c]) {
      const Eigen::Vector2d from = plane(body_.position(i)) - inclusions_[c].center;
      const Eigen::Vector2d d = Eigen::Vector2d(u[dof], u[dof + 1]) + rotation * from - from;
      displacements.push_back({d.x(), d.y(), 0});
    }
  }
  return displacements;
}

}  // namespace riven
