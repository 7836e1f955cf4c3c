#include "verification/interpolate.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace riven {
namespace {

constexpr double kFirstRadius = 1.75;  // spacings: nine points inside a plane lattice
constexpr double kGrowth = 1.2;
constexpr double kNearest = 2;  // spacings: a place with no point this near is outside
// Smallest over largest pivot: about the square of the spread of the points over their distance.
constexpr double kWellConditioned = 2.5e-3;

double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

Interpolation::Interpolation(std::span<const Point> positions, std::span<const Point> displacements,
                             const Defects& defects, double spacing, double horizon)
    : positions_(positions),
      displacements_(displacements),
      defects_(defects),
      spacing_(spacing),
      reach_(std::max(horizon, 3 * spacing)),
      tolerance_(1e-6 * spacing),
      by_x_(positions.size()) {
  if (positions.size() != displacements.size()) throw std::invalid_argument("one displacement per position");
  std::iota(by_x_.begin(), by_x_.end(), std::size_t{0});
  std::sort(by_x_.begin(), by_x_.end(),
            [&](std::size_t a, std::size_t b) { return positions[a][0] < positions[b][0]; });
  for (std::size_t k = 0; k < 3; ++k) {
    const auto apart = [&](const Point& p) { return std::abs(p[k] - positions.front()[k]) > tolerance_; };
    if (std::any_of(positions.begin(), positions.end(), apart)) axes_.push_back(k);
  }
}

bool Interpolation::sees(const Point& place, const Point& point) const {
  if (defects_.cuts(place, point, tolerance_)) return false;
  return std::none_of(defects_.inclusions.begin(), defects_.inclusions.end(), [&](const Shape& inclusion) {
    if (signed_distance(inclusion, place) < -tolerance_)
      return signed_distance(inclusion, point) > tolerance_;
    return chord(inclusion, place, point, tolerance_).has_value();
  });
}

std::vector<Interpolation::Neighbour> Interpolation::in_sight(const Point& place) const {
  const auto left_of = [&](std::size_t i, double x) { return positions_[i][0] < x; };
  auto next = std::lower_bound(by_x_.begin(), by_x_.end(), place[0] - reach_, left_of);
  std::vector<Neighbour> found;
  for (; next != by_x_.end() && positions_[*next][0] <= place[0] + reach_; ++next) {
    const double away = distance(place, positions_[*next]);
    if (away < reach_ && sees(place, positions_[*next])) found.push_back({*next, away});
  }
  std::sort(found.begin(), found.end(), [](const Neighbour& a, const Neighbour& b) {
    return std::pair(a.distance, a.point) < std::pair(b.distance, b.point);
  });
  return found;
}

std::optional<Point> Interpolation::at(const Point& place) const {
  const auto inside = [&](const Shape& hole) { return signed_distance(hole, place) < -tolerance_; };
  const auto on = [&](const Segment& crack) { return riven::distance(crack, place) <= tolerance_; };
  if (std::any_of(defects_.holes.begin(), defects_.holes.end(), inside) ||
      std::any_of(defects_.cracks.begin(), defects_.cracks.end(), on)) {
    return std::nullopt;
  }
  const auto neighbours = in_sight(place);
  if (neighbours.empty() || neighbours.front().distance > kNearest * spacing_) return std::nullopt;
  for (double radius = std::min(kFirstRadius * spacing_, reach_);;
       radius = std::min(kGrowth * radius, reach_)) {
    const auto end = std::partition_point(neighbours.begin(), neighbours.end(),
                                          [&](const Neighbour& n) { return n.distance < radius; });
    if (const auto value = fit(place, {neighbours.begin(), end}, radius)) return value;
    if (radius == reach_) return std::nullopt;
  }
}

std::optional<Point> Interpolation::fit(const Point& place, std::span<const Neighbour> neighbours,
                                        double radius) const {
  // u(X) = u(place) + G (X - place) / radius; unknowns of absent axes get a diagonal of their own and stay 0.
  Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 3> right = Eigen::Matrix<double, 4, 3>::Zero();
  for (const auto& [point, away] : neighbours) {
    const double bell = 1 - (away / radius) * (away / radius);  // falls smoothly to 0 at the radius
    Eigen::Vector4d basis(1, 0, 0, 0);
    for (const std::size_t k : axes_)
      basis(static_cast<int>(k) + 1) = (positions_[point][k] - place[k]) / radius;
    moments += bell * bell * basis * basis.transpose();
    right += bell * bell * basis * Eigen::RowVector3d::Map(displacements_[point].data());
  }
  for (int k = 1; k < 4; ++k) {
    if (std::find(axes_.begin(), axes_.end(), static_cast<std::size_t>(k - 1)) == axes_.end())
      moments(k, k) = moments(0, 0);
  }
  const Eigen::LDLT<Eigen::Matrix4d> factors(moments);
  const Eigen::Vector4d pivots = factors.vectorD();
  if (!(pivots.minCoeff() > kWellConditioned * pivots.maxCoeff())) return std::nullopt;
  const Eigen::RowVector3d value = factors.solve(right).row(0);
  return Point{value(0), value(1), value(2)};
}

}  // namespace riven
