#include "simulation/free_motions.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace riven {

namespace {

/// Motions of a place with the body: translations along the axes, then rotations by one unit of angle about
/// the axes through `origin`, with lengths over `size`. Row i: direction i.
Eigen::MatrixXd rigid_modes(int dimension, const Eigen::Vector3d& place, const Eigen::Vector3d& origin,
                            double size) {
  const Eigen::Vector3d x = (place - origin) / size;
  Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(dimension, dimension == 2 ? 3 : 6);
  modes.leftCols(dimension).setIdentity();
  if (dimension == 2) {
    modes.col(2) << -x.y(), x.x();
    return modes;
  }
  for (int axis = 0; axis < 3; ++axis) modes.col(3 + axis) = Eigen::Vector3d::Unit(axis).cross(x);
  return modes;
}

/// A translation along an axis where there is one, or a rotation about a place.
std::string words_of(const Eigen::VectorXd& mode, int dimension, const Eigen::Vector3d& origin, double size) {
  const Eigen::VectorXd along = mode.head(dimension), turn = mode.tail(mode.size() - dimension);
  if (turn.norm() < 1e-6 * mode.norm()) {
    Eigen::Index axis = 0;
    if (along.cwiseAbs().maxCoeff(&axis) > 0.999 * along.norm())
      return fmt::format("a translation along {}", "xyz"[axis]);
    const Eigen::VectorXd unit = along.normalized();
    return fmt::format("a translation along ({:.3g}, {:.3g}{})", unit(0), unit(1),
                       dimension == 3 ? fmt::format(", {:.3g}", unit(2)) : "");
  }
  if (dimension == 2)  // the place that stays: along + turn x (place - origin) / size = 0
    return fmt::format("a rotation about ({:.4g}, {:.4g}) m", origin.x() - size * along(1) / turn(0),
                       origin.y() + size * along(0) / turn(0));
  const Eigen::Vector3d t = turn, u = along;
  const Eigen::Vector3d through = origin + size * t.cross(u) / t.squaredNorm(), axis = t.normalized();
  return fmt::format("a rotation about the axis ({:.3g}, {:.3g}, {:.3g}) through ({:.4g}, {:.4g}, {:.4g}) m",
                     axis.x(), axis.y(), axis.z(), through.x(), through.y(), through.z());
}

}  // namespace

std::optional<std::string> free_motion(const Simulation& simulation) {
  const Body& body = *simulation.body;
  const int dimension = body.dimension;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double size = 0;
  for (int axis = 0; axis < dimension; ++axis) {
    const auto face = static_cast<std::size_t>(2 * axis);
    origin(axis) = 0.5 * (body.faces[face] + body.faces[face + 1]);
    size = std::max(size, 0.5 * (body.faces[face + 1] - body.faces[face]));
  }
  const int count = dimension == 2 ? 3 : 6;
  Eigen::MatrixXd held =
      Eigen::MatrixXd::Zero(count, count);  // squares of what prescribed entries see of the modes
  for (std::size_t number = 0; number < body.points.size(); ++number) {
    const Point x = body.position(body.points[number]);
    const Eigen::MatrixXd modes = rigid_modes(dimension, Eigen::Vector3d(x.data()), origin, size);
    for (int axis = 0; axis < dimension; ++axis)
      if (!simulation.constraints->is_free(simulation.entry(static_cast<std::size_t>(axis), number)))
        held += modes.row(axis).transpose() * modes.row(axis);
  }
  // Squares: a support on a thousandth of the body's size still holds it.
  constexpr double kHeld = 1e-8;  // far above rounding
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(held, Eigen::ComputeFullV);
  const Eigen::Index free = (svd.singularValues().array() <= kHeld).count();
  if (free == 0) return std::nullopt;
  // Of several the null space's basis is arbitrary: name the plain motions that are in it.
  const Eigen::MatrixXd null = svd.matrixV().rightCols(free);
  std::string words;
  for (int mode = 0; mode < count; ++mode) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(count, mode);
    if ((null * (null.transpose() * unit) - unit).norm() > 1e-4) continue;
    words += (words.empty() ? "" : " and ") + words_of(unit, dimension, origin, size);
  }
  return words.empty() ? words_of(null.col(0), dimension, origin, size) : words;
}

}  // namespace riven
