#include "report/point_shape.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/cubes.hpp"

namespace riven {

namespace {

using Matrix = Eigen::Matrix3d;
using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Vector = Eigen::Vector3d;

Vector difference(const Point& to, const Point& from) {
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

/// Edge of a cell if the points filled their box evenly (m).
double mean_spacing(const std::vector<Point>& positions, const std::vector<std::size_t>& axes) {
  double volume = 1;
  for (const std::size_t axis : axes) {
    const auto [low, high] =
        std::minmax_element(positions.begin(), positions.end(),
                            [&](const Point& a, const Point& b) { return a[axis] < b[axis]; });
    volume *= (*high)[axis] - (*low)[axis];
  }
  const auto dimension = static_cast<double>(axes.size());
  const double along = std::pow(static_cast<double>(positions.size()), 1 / dimension);
  return std::pow(volume, 1 / dimension) / std::max(1.0, along - 1);
}

/// What the shape of one point follows from: its neighbours, the nearest first.
struct Family {
  std::size_t point;
  std::vector<std::size_t> near;
  const std::vector<Point>& positions;
  std::span<const Point> deformed;

  [[nodiscard]] Vector before(std::size_t j) const { return difference(positions[j], positions[point]); }
  [[nodiscard]] Vector after(std::size_t j) const { return difference(deformed[j], deformed[point]); }
  [[nodiscard]] double stretch(std::size_t j) const { return after(j).norm() / before(j).norm(); }
};

Family family_of(std::size_t point, const std::vector<Point>& positions, std::span<const Point> deformed,
                 const Cubes& cubes, double reach) {
  Family family{point, cubes.within(positions[point], reach), positions, deformed};
  const auto square = [&](std::size_t j) { return family.before(j).squaredNorm(); };
  std::erase_if(family.near, [&](std::size_t j) { return square(j) == 0; });
  std::sort(family.near.begin(), family.near.end(),
            [&](std::size_t a, std::size_t b) { return square(a) < square(b); });
  return family;
}

/// The stretch beyond which a neighbour has gone: far above what nearly all points have.
double torn_stretch(std::vector<double> stretches) {
  constexpr double kNearlyAll = 0.95, kFar = 4;
  if (stretches.empty()) return kFar;
  const double last = static_cast<double>(stretches.size()) - 1;
  const auto place = stretches.begin() + static_cast<std::ptrdiff_t>(kNearlyAll * last);
  std::nth_element(stretches.begin(), place, stretches.end());
  return kFar * std::max(1.0, *place);
}

/// Differences along the axes of the lattice, to both sides or, if one neighbour is much farther than the
/// other, to the side where no gap is.
void shape_on_lattice(const Family& family, const std::vector<std::size_t>& axes, PointShape& shape) {
  constexpr double kAlmost = 0.99, kApart = 2, kNone = std::numeric_limits<double>::infinity();
  Matrix gradient = Matrix::Identity();
  for (const std::size_t axis : axes) {
    std::array<Vector, 2> towards;
    std::array<double, 2> stretch = {kNone, kNone};
    for (const std::size_t j : family.near) {
      const Vector before = family.before(j);
      const double along = before[static_cast<int>(axis)] / shape.spacing;
      if (std::abs(along) < kAlmost || before.norm() > shape.spacing / kAlmost) continue;
      const std::size_t side = along > 0 ? 1 : 0;
      towards[side] = family.after(j) / along / shape.spacing;
      stretch[side] = towards[side].norm();
    }
    const double nearer = std::min(stretch[0], stretch[1]);
    Vector sum = Vector::Zero();
    for (std::size_t side = 0; side < 2; ++side) {
      const bool joined = stretch[side] < kNone && stretch[side] <= kApart * nearer;
      shape.joined[2 * axis + side] = joined;
      if (joined) sum += towards[side];
    }
    const int count = shape.joined[2 * axis] + shape.joined[2 * axis + 1];
    if (count > 0) gradient.col(static_cast<int>(axis)) = sum / count;
  }
  Eigen::Map<RowMajor>(shape.gradient.data()) = gradient;
}

/// Least squares over the neighbours with weights stretch^-6, so that those on one side of a gap decide. A
/// small weight on "undeformed" fills the directions in which there is no neighbour.
void shape_in_disorder(const Family& family, PointShape& shape) {
  constexpr double kUndeformed = 1e-6;
  Matrix moved = Matrix::Zero(), moment = Matrix::Zero();
  double squares = 0;
  for (const std::size_t j : family.near) {
    const Vector before = family.before(j), after = family.after(j);
    const double weight = std::pow(std::max(after.squaredNorm() / before.squaredNorm(), 1e-3), -3);
    moved += weight * after * before.transpose();
    moment += weight * before * before.transpose();
    squares += before.squaredNorm();
  }
  const Matrix still = (kUndeformed * squares + std::numeric_limits<double>::min()) * Matrix::Identity();
  Eigen::Map<RowMajor>(shape.gradient.data()) = (moved + still) * (moment + still).inverse();
}

bool all_alike(const std::vector<PointShape>& shapes) {
  const auto [low, high] =
      std::minmax_element(shapes.begin(), shapes.end(),
                          [](const PointShape& a, const PointShape& b) { return a.spacing < b.spacing; });
  constexpr double kSame = 1e-3;
  return high->spacing - low->spacing < kSame * high->spacing;
}

}  // namespace

PointShapes point_shapes(const std::vector<Point>& positions, std::span<const Point> deformed,
                         const std::vector<std::size_t>& axes) {
  PointShapes all;
  all.shapes.resize(positions.size());
  if (positions.empty()) return all;
  const double mean = mean_spacing(positions, axes);
  constexpr double kReach = 1.6;  // beyond the diagonal of a square, short of the second neighbour
  const double reach = mean > 0 ? kReach * mean : 1;
  const Cubes cubes(positions, 3, reach);
  const auto family = [&](std::size_t i) { return family_of(i, positions, deformed, cubes, reach); };
  std::vector<double> stretches(positions.size(), 1.0);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Family here = family(i);
    for (const std::size_t j : here.near)
      stretches[i] += (here.stretch(j) - 1) / static_cast<double>(here.near.size());
    // At an edge or corner, too, one neighbour per direction is as near as inside.
    all.shapes[i].spacing =
        here.near.empty() ? mean : here.before(here.near[std::min(axes.size(), here.near.size()) - 1]).norm();
  }
  all.on_lattice = all_alike(all.shapes);
  std::erase_if(stretches, [](double stretch) { return !std::isfinite(stretch); });
  const double torn = torn_stretch(std::move(stretches));
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < positions.size(); ++i) {
    Family here = family(i);
    std::erase_if(here.near, [&](std::size_t j) { return here.stretch(j) > torn; });
    if (all.on_lattice) {
      shape_on_lattice(here, axes, all.shapes[i]);
    } else {
      shape_in_disorder(here, all.shapes[i]);
    }
  }
  return all;
}

}  // namespace riven
