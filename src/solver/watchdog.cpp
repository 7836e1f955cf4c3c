#include "solver/watchdog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"

namespace riven {

namespace {

// A point this many body sizes from its place, beyond what the loads ask for, belongs to a run that blows up:
// bodies that a load throws stay far below, and a blow-up passes it within a few dozen steps.
constexpr double kFar = 100;
constexpr double kProgress = 0.9;  // a residual that does not fall by a tenth has not fallen

double extent(const std::vector<Point>& positions, std::size_t axis) {
  const auto [least, most] =
      std::minmax_element(positions.begin(), positions.end(),
                          [axis](const Point& p, const Point& q) { return p[axis] < q[axis]; });
  return positions.empty() ? 0 : (*most)[axis] - (*least)[axis];
}

}  // namespace

Watchdog::Watchdog(const Model& model) : model_(model) {
  const std::vector<Point> positions = model.positions();
  size_ = std::hypot(extent(positions, 0), extent(positions, 1), extent(positions, 2)) + model.spacing();
}

std::optional<Breakdown> Watchdog::inspect(const Constraints& constraints, std::span<const double> u,
                                           std::span<const double> force, std::span<const double> v) const {
  double load = 0;  // largest displacement that a load asks for (m)
  for (const double offset : constraints.offsets()) load = std::max(load, std::abs(offset));
  const double far = kFar * size_ + load;
  const auto is_number = [&](std::size_t i) { return std::isfinite(u[i]) && std::isfinite(force[i]); };
  const double wrong = ordered_sum_of(
      u.size(), [&](std::size_t i) { return is_number(i) && std::abs(u[i]) <= far ? 0.0 : 1.0; });
  if (wrong == 0) return std::nullopt;

  // What a load prescribes shows only where all free entries are numbers.
  for (const bool free : {true, false})
    for (std::size_t i = 0; i < u.size(); ++i)
      if (!is_number(i) && constraints.is_free(i) == free)
        return Breakdown{model_.place(i), fmt::format("the {} is not a finite number",
                                                      !free ? "displacement that a load prescribes"
                                                      : std::isfinite(u[i]) ? "force"
                                                                            : "displacement")};
  const std::size_t i = largest(u);
  const std::string speed = v.empty() ? "" : fmt::format(" and moves at {:.3g} m/s", std::abs(v[i]));
  return Breakdown{model_.place(i), fmt::format("a point has left the body, which measures {:.3g} m: it is "
                                                "{:.3g} m from its place{}; it was",
                                                size_, std::abs(u[i]), speed)};
}

std::size_t Watchdog::largest(std::span<const double> entries) {
  const auto found = std::max_element(entries.begin(), entries.end(),
                                      [](double a, double b) { return std::abs(a) < std::abs(b); });
  return static_cast<std::size_t>(found - entries.begin());
}

bool StallWatch::stalled(long iteration, double residual) {
  if (iteration > 0 && !(residual < kProgress * best_)) return iteration - best_at_ >= patience_;
  best_ = residual;
  best_at_ = iteration;
  return false;
}

std::string text(const Point& place) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) m", place[0], place[1], place[2]);
}

std::string text(const Breakdown& breakdown) {
  return fmt::format("{} at {}", breakdown.what, text(breakdown.position));
}

}  // namespace riven
