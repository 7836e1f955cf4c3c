#include "geometry/surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/error.hpp"

namespace riven {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Calls visit(from, to) for the edges of all triangles, as they run round.
template <class Visit>
void for_each_edge(const Triangles& mesh, const Visit& visit) {
  for (const auto& corner : mesh.triangle)
    for (std::size_t n = 0; n < 3; ++n) visit(corner[n], corner[(n + 1) % 3]);
}

/// On which side of the edge from a to b a line along x at (y, z) passes: twice the area of the triangle that
/// they make in the y-z plane. Both triangles at an edge get the same number, with opposite signs.
double side_of(const Point& a, const Point& b, double y, double z) {
  const auto key = [](const Point& p) { return std::array{p[1], p[2], p[0]}; };
  if (key(b) < key(a)) return -side_of(b, a, y, z);
  return (b[1] - a[1]) * (z - a[2]) - (b[2] - a[2]) * (y - a[1]);
}

/// The sign of that. A line that meets the edge passes as one moved a little along y, and much less along z,
/// does, so that it goes through exactly one of the triangles around an edge or a corner.
int passes(const Point& a, const Point& b, double side) {
  if (side != 0) return side > 0 ? 1 : -1;
  if (b[2] != a[2]) return b[2] < a[2] ? 1 : -1;
  return b[1] > a[1] ? 1 : -1;
}

}  // namespace

Surface::Surface(Triangles triangles) : mesh_(std::move(triangles)) {
  check_closed();
  measure();
  fill_bins();
}

void Surface::check_closed() const {
  std::vector<Edge> edges;
  for_each_edge(mesh_, [&](std::uint32_t a, std::uint32_t b) { edges.emplace_back(a, b); });
  std::sort(edges.begin(), edges.end());
  const auto runs = [&](const Edge& edge) {
    const auto [first, last] = std::equal_range(edges.begin(), edges.end(), edge);
    return last - first;
  };
  std::size_t open = 0, all = 0;
  std::optional<Edge> first;
  for_each_edge(mesh_, [&](std::uint32_t a, std::uint32_t b) {
    const auto there = runs({a, b}), back = runs({b, a});
    all += a < b || back == 0 ? 1 : 0;
    if (there <= back) return;
    ++open;
    if (!first) first = {a, b};
  });
  if (open == 0) return;
  const auto place = [&](std::uint32_t n) {
    const Point& p = mesh_.corner[n];
    return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", p[0], p[1], p[2]);
  };
  const bool turned = runs(*first) > 1;
  throw InputError(
      fmt::format("the surface is not closed: {} of {} edges are open or have triangles that face different "
                  "ways, the first from {} "
                  "to {}{}; expected each edge to be shared by two triangles that face the same way",
                  open, all, place(first->first), place(first->second),
                  turned ? ", where a triangle is turned over" : ""));
}

void Surface::measure() {
  constexpr double endless = std::numeric_limits<double>::infinity();
  Point lower{endless, endless, endless}, upper{-endless, -endless, -endless};
  for (const auto& corner : mesh_.triangle)
    for (const std::uint32_t n : corner)
      for (std::size_t a = 0; a < 3; ++a) {
        lower[a] = std::min(lower[a], mesh_.corner[n][a]);
        upper[a] = std::max(upper[a], mesh_.corner[n][a]);
      }
  double room = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    box_.center[a] = 0.5 * (lower[a] + upper[a]);
    box_.half_size[a] = 0.5 * (upper[a] - lower[a]);
    room *= upper[a] - lower[a];
  }
  for (const auto& corner : mesh_.triangle) {
    const Point a = minus(mesh_.corner[corner[0]], box_.center),
                b = minus(mesh_.corner[corner[1]], box_.center),
                c = minus(mesh_.corner[corner[2]], box_.center), normal = cross(b, c);
    volume_ += (a[0] * normal[0] + a[1] * normal[1] + a[2] * normal[2]) / 6;
  }
  if (mesh_.triangle.empty() || !(std::abs(volume_) > 1e-12 * room))
    throw InputError("the surface encloses no volume; expected one around a body");
  outwards_ = volume_ > 0 ? 1 : -1;
  volume_ = std::abs(volume_);
}

void Surface::fill_bins() {
  bins_ = static_cast<std::size_t>(std::clamp(std::sqrt(static_cast<double>(size())), 1.0, 1000.0));
  bin_.resize(bins_ * bins_);
  for (std::uint32_t t = 0; t < size(); ++t) {
    std::array<std::size_t, 2> low{bins_, bins_}, high{};
    for (const std::uint32_t n : mesh_.triangle[t])
      for (std::size_t a = 0; a < 2; ++a) {
        low[a] = std::min(low[a], bin_of(a + 1, mesh_.corner[n][a + 1]));
        high[a] = std::max(high[a], bin_of(a + 1, mesh_.corner[n][a + 1]));
      }
    for (std::size_t j = low[0]; j <= high[0]; ++j)
      for (std::size_t k = low[1]; k <= high[1]; ++k) bin_[k * bins_ + j].push_back(t);
  }
}

std::size_t Surface::bin_of(std::size_t axis, double x) const {
  const auto count = static_cast<double>(bins_);
  const double place = 0.5 * ((x - box_.center[axis]) / box_.half_size[axis] + 1) * count;
  return static_cast<std::size_t>(std::clamp(place, 0.0, count - 1));
}

const std::vector<std::uint32_t>& Surface::near(double y, double z) const {
  return bin_[bin_of(2, z) * bins_ + bin_of(1, y)];
}

std::array<bool, 6> Surface::filled_faces() const {
  constexpr double kRounding = 1e-6;  // of the box, as single precision has
  std::array<double, 6> covered{};
  for (const auto& corner : mesh_.triangle) {
    const Point &a = mesh_.corner[corner[0]], &b = mesh_.corner[corner[1]], &c = mesh_.corner[corner[2]];
    const Point normal = cross(minus(b, a), minus(c, a));
    for (std::size_t face = 0; face < 6; ++face) {
      const std::size_t axis = face / 2;
      const double end = box_.center[axis] + (face % 2 == 0 ? -1 : 1) * box_.half_size[axis];
      const auto on_face = [&](const Point& p) {
        return std::abs(p[axis] - end) <= kRounding * box_.half_size[axis];
      };
      if (on_face(a) && on_face(b) && on_face(c)) covered[face] += 0.5 * std::abs(normal[axis]);
    }
  }
  std::array<bool, 6> filled{};
  for (std::size_t face = 0; face < 6; ++face) {
    const double whole = 4 * box_.half_size[(face / 2 + 1) % 3] * box_.half_size[(face / 2 + 2) % 3];
    filled[face] = std::abs(covered[face] - whole) <= 10 * kRounding * whole;
  }
  return filled;
}

/// Where the line along x at (y, z) goes through triangles, by x. False where rounding spoils the count.
bool Surface::crossings(double y, double z, std::vector<Crossing>& found) const {
  found.clear();
  int sum = 0;
  for (const std::uint32_t t : near(y, z)) {
    const auto& [i, j, k] = mesh_.triangle[t];
    const Point &a = mesh_.corner[i], &b = mesh_.corner[j], &c = mesh_.corner[k];
    const double over_c = side_of(a, b, y, z), over_a = side_of(b, c, y, z), over_b = side_of(c, a, y, z);
    const int sign = passes(a, b, over_c);
    if (passes(b, c, over_a) != sign || passes(c, a, over_b) != sign) continue;
    const double area = over_a + over_b + over_c;
    if (area == 0) return false;
    // A triangle that goes round against the clock, seen from the upper end of x, is where the line leaves.
    found.push_back({(over_a * a[0] + over_b * b[0] + over_c * c[0]) / area, -sign * outwards_});
    sum += sign;
  }
  std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
  return sum == 0;
}

/// The parts of that line inside of the body (m).
std::vector<Interval> Surface::inside(double y, double z, double step) const {
  constexpr int kTries = 8;
  constexpr double kMove = 1e-9;  // of the step: away from what spoils the count
  std::vector<Crossing> found;
  for (int n = 0; !crossings(y + n * kMove * step, z + 0.7 * n * kMove * step, found); ++n)
    if (n == kTries)
      throw InputError(fmt::format(
          "the line along x at y = {:g} m, z = {:g} m does not leave the surface as often as it enters", y,
          z));
  std::vector<Interval> parts;
  int depth = 0;
  for (std::size_t n = 0; n + 1 < found.size(); ++n) {
    depth += found[n].into;
    const double length = found[n + 1].x - found[n].x;
    if (depth < 0 && length > 1e-6 * box_.half_size[0])
      throw InputError(fmt::format(
          "triangles face inwards around a body of their own near ({:.6g}, {:.6g}, {:.6g}) m; expected "
          "all bodies to face outwards, and cavities inwards",
          found[n].x, y, z));
    if (depth > 0 && length > 0) parts.push_back({found[n].x, found[n + 1].x});
  }
  return parts;
}

std::vector<double> Surface::covered_fractions(const Point& first, double spacing, int count) const {
  constexpr int kLines = 4;  // through a cube along y and along z
  constexpr double kRounding = 1e-9;
  std::vector<double> fraction(static_cast<std::size_t>(count), 0.0);
  const double begin = first[0] - 0.5 * spacing;
  for (int j = 0; j < kLines; ++j)
    for (int k = 0; k < kLines; ++k) {
      const double y = first[1] + ((j + 0.5) / kLines - 0.5) * spacing,
                   z = first[2] + ((k + 0.5) / kLines - 0.5) * spacing;
      for (const Interval& part : inside(y, z, spacing)) {
        const double from = std::clamp((part.from - begin) / spacing, 0.0, 1.0 * count);
        const double to = std::clamp((part.to - begin) / spacing, 0.0, 1.0 * count);
        for (int n = static_cast<int>(from); n < count && n < to; ++n)
          fraction[static_cast<std::size_t>(n)] +=
              (std::min(to, n + 1.0) - std::max(from, 1.0 * n)) / (kLines * kLines);
      }
    }
  for (double& part : fraction) {
    if (part < kRounding) part = 0;
    if (part > 1 - kRounding) part = 1;
  }
  return fraction;
}

}  // namespace riven
