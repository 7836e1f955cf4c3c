#include "body/crack_paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <queue>

#include "base/disjoint_sets.hpp"
#include "geometry/cubes.hpp"

namespace riven {

namespace {

// Steps of a path, in spacings: up to a knight's move, so that the way between two lattice points far apart
// is at most 2.8 % longer than the straight one. Cracks nearer to each other than that are one.
constexpr double kStep = 2.3;
constexpr double kFar = std::numeric_limits<double>::infinity();

double between(const Point& a, const Point& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

}  // namespace

CrackPoints crack_points(const Body& body, std::span<const std::size_t> among, std::span<const double> before,
                         std::span<const double> now, double threshold) {
  CrackPoints points;
  for (const std::size_t n : among) {
    if (now[n] < threshold) continue;
    points.position.push_back(body.position(body.points[n]));
    points.old.push_back(before[n] >= threshold);
    points.at_edge.push_back(before[n] == 0 && !body.complete[body.points[n]]);
  }
  return points;
}

CrackPaths::CrackPaths(CrackPoints points, double spacing)
    : points_(std::move(points)),
      spacing_(spacing),
      neighbours_(points_.position.size()),
      distance_(points_.position.size(), kFar),
      before_(points_.position.size()) {
  std::iota(before_.begin(), before_.end(), 0U);
  find_neighbours();
  std::vector<std::uint32_t> old;
  for (std::uint32_t n = 0; n < points_.old.size(); ++n)
    if (points_.old[n]) old.push_back(n);
  static_cast<void>(spread(old));
  for (std::uint32_t n = 0; n < distance_.size(); ++n) {
    if (distance_[n] == kFar && old.empty()) start_new_crack(n);
    if (distance_[n] == kFar) distance_[n] = 0;
  }
  for (std::uint32_t n = 0; n < distance_.size(); ++n)
    if (distance_[n] > length_) {
      length_ = distance_[n];
      top_ = n;
    }
}

void CrackPaths::find_neighbours() {
  const Cubes cubes(points_.position, 2, kStep * spacing_);
  for (std::size_t n = 0; n < neighbours_.size(); ++n)
    for (const std::size_t other : cubes.within(points_.position[n], kStep * spacing_))
      if (other != n) neighbours_[n].push_back(static_cast<std::uint32_t>(other));
}

/// Dijkstra's shortest paths from some points, which it returns with all that it reaches, the farthest last.
std::vector<std::uint32_t> CrackPaths::spread(const std::vector<std::uint32_t>& from) {
  using Reached = std::pair<double, std::uint32_t>;  // equal distances: the point stored first comes first
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
  for (const std::uint32_t n : from) {
    distance_[n] = 0;
    before_[n] = n;
    front.emplace(0.0, n);
  }
  std::vector<std::uint32_t> reached;
  while (!front.empty()) {
    const auto [distance, n] = front.top();
    front.pop();
    if (distance > distance_[n]) continue;  // it has been reached on a shorter way since
    reached.push_back(n);
    for (const std::uint32_t next : neighbours_[n]) {
      const double way = distance + between(points_.position[n], points_.position[next]);
      if (way >= distance_[next]) continue;
      distance_[next] = way;
      before_[next] = n;
      front.emplace(way, next);
    }
  }
  return reached;
}

/// Finds the ends of the longest path of a crack by going to the farthest point twice, which is exact for
/// cracks without loops, and measures from one of them.
void CrackPaths::start_new_crack(std::uint32_t anywhere) {
  std::uint32_t end = anywhere, other = anywhere;
  for (int sweep = 0; sweep < 2; ++sweep) {
    const std::vector<std::uint32_t> crack = spread({end});
    other = end;
    end = crack.back();
    for (const std::uint32_t n : crack) distance_[n] = kFar;
  }
  const auto rank = [&](std::uint32_t n) { return std::pair(!points_.at_edge[n], n); };
  static_cast<void>(spread({std::min(end, other, [&](auto a, auto b) { return rank(a) < rank(b); })}));
}

std::optional<Point> CrackPaths::tip() const {
  if (!top_) return std::nullopt;
  // A crack runs between two rows of points: what is as far as its end, on both sides, is averaged.
  Point sum{};
  double count = 0;
  const auto add = [&](std::uint32_t n) {
    if (distance_[n] < length_ - 0.5 * spacing_) return;
    for (std::size_t a = 0; a < 2; ++a) sum[a] += points_.position[n][a];
    ++count;
  };
  add(*top_);
  for (const std::uint32_t n : neighbours_[*top_]) add(n);
  return Point{sum[0] / count, sum[1] / count, 0};
}

int CrackPaths::ends(double least) const {
  // From the farthest points down: what is left of an end when its part meets that of a longer path.
  std::vector<std::uint32_t> order(distance_.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return distance_[a] > distance_[b]; });
  DisjointSets parts(order.size());
  std::vector<double> peak = distance_;  // of a part, at its root
  std::vector<bool> there(order.size(), false);
  int count = 0;
  const auto end_at = [&](double top, double foot) { count += top - foot >= least && top > foot ? 1 : 0; };
  for (const std::uint32_t n : order) {
    there[n] = true;
    for (const std::uint32_t next : neighbours_[n]) {
      if (!there[next] || parts.root(next) == parts.root(n)) continue;
      const double one = peak[parts.root(n)], other = peak[parts.root(next)];
      end_at(std::min(one, other), distance_[n]);
      parts.join(n, next);
      peak[parts.root(n)] = std::max(one, other);
    }
  }
  for (std::uint32_t n = 0; n < order.size(); ++n)
    if (parts.root(n) == n) end_at(peak[n], 0);
  return count;
}

std::optional<double> CrackPaths::angle(double from, double to) const {
  if (!top_) return std::nullopt;
  // Points on both sides of the path, so that the line lies in the crack.
  std::vector<bool> beside(distance_.size(), false);
  const auto within = [&](std::uint32_t n) { return distance_[n] >= from && distance_[n] <= to; };
  std::uint32_t first = *top_;
  for (; before_[first] != first; first = before_[first]) {
    if (!within(first)) continue;
    beside[first] = true;
    for (const std::uint32_t n : neighbours_[first]) beside[n] = within(n);
  }
  std::vector<Point> fitted;
  for (std::uint32_t n = 0; n < beside.size(); ++n)
    if (beside[n]) fitted.push_back(points_.position[n]);
  if (fitted.size() < 6) return std::nullopt;
  Point mean{};
  for (const Point& p : fitted)
    for (std::size_t a = 0; a < 2; ++a) mean[a] += p[a] / static_cast<double>(fitted.size());
  double xx = 0, xy = 0, yy = 0;
  for (const Point& p : fitted) {
    const double x = p[0] - mean[0], y = p[1] - mean[1];
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  // Principal direction of the points; it points away from the beginning.
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  const Point& start = points_.position[first];
  const bool away = std::cos(angle) * (mean[0] - start[0]) + std::sin(angle) * (mean[1] - start[1]) > 0;
  return away ? angle : std::remainder(angle + std::numbers::pi, 2 * std::numbers::pi);
}

}  // namespace riven
