#include "report/thinning.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace riven {

namespace {

// What is left out in turn: states until so many remain, then points until so many remain.
constexpr Extent kEnough[] = {{40, 100000}, {5, 1}};

std::size_t whole(double number) {
  return number > 0 ? static_cast<std::size_t>(number) : 0;
}

struct Bounds {
  std::array<double, 3> lower, extent;  // with half a spacing around the points
  int dimension = 0;                    // axes along which the points differ
};

Bounds bounds_of(Positions positions, double spacing) {
  Bounds bounds;
  for (std::size_t a = 0; a < 3; ++a) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const auto& position : positions) {
      least = std::min(least, position[a]);
      most = std::max(most, position[a]);
    }
    bounds.lower[a] = least - spacing / 2;
    bounds.extent[a] = most - least + spacing;
    bounds.dimension += most > least ? 1 : 0;
  }
  return bounds;
}

/// Three digits: what a note says is what was done.
double rounded_up(double length) {
  const double digit = std::pow(10, std::floor(std::log10(length)) - 2);
  return std::ceil(length / digit - 1e-9) * digit;
}

}  // namespace

double ViewSize::bytes(const Extent& of) const {
  return fixed + static_cast<double>(of.points) * (per_point + static_cast<double>(of.states) * per_value);
}

Extent fitting(const ViewSize& size, double budget) {
  const Extent& all = size.all;
  if (size.bytes(all) <= budget) return all;
  const double room = budget - size.fixed;
  const auto states_with = [&](std::size_t points) {
    return std::min(all.states,
                    whole((room / static_cast<double>(points) - size.per_point) / size.per_value));
  };
  const auto points_with = [&](std::size_t states) {
    return std::min(all.points,
                    whole(room / (size.per_point + static_cast<double>(states) * size.per_value)));
  };
  Extent fit{states_with(all.points), all.points};
  if (size.mesh) return fit;
  for (const Extent& enough : kEnough) {
    if (fit.states >= std::min(all.states, enough.states)) return fit;
    fit.states = std::min(all.states, enough.states);
    fit.points = points_with(fit.states);
    if (fit.points >= std::min(all.points, enough.points)) return fit;
    fit.points = std::min(all.points, enough.points);
    fit.states = states_with(fit.points);
  }
  return fit;
}

std::vector<double> shares(const std::vector<double>& needs, double budget) {
  std::vector<std::size_t> order(needs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return needs[a] < needs[b]; });
  std::vector<double> parts(needs.size());
  double left = std::max(0.0, budget);
  for (std::size_t n = 0; n < order.size(); ++n) {
    parts[order[n]] = std::min(needs[order[n]], left / static_cast<double>(order.size() - n));
    left -= parts[order[n]];
  }
  for (double& part : parts) part += left / static_cast<double>(parts.size());
  return parts;
}

std::vector<std::size_t> evenly_spaced(std::size_t count, std::size_t of) {
  std::vector<std::size_t> numbers;
  if (count == 1 && of > 0) numbers.push_back(of - 1);
  for (std::size_t n = 0; count > 1 && n < count; ++n)
    numbers.push_back((n * (of - 1) + (count - 1) / 2) / (count - 1));
  return numbers;
}

Selection one_per_cell(Positions positions, double spacing, double cell) {
  const Bounds bounds = bounds_of(positions, spacing);
  struct Best {
    std::size_t point;
    double square;  // of its distance from the centre
  };
  std::array<std::uint64_t, 3> cells;
  for (std::size_t a = 0; a < 3; ++a) cells[a] = 1 + static_cast<std::uint64_t>(bounds.extent[a] / cell);
  std::unordered_map<std::uint64_t, Best> found;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    std::uint64_t key = 0;
    double square = 0;
    for (std::size_t a = 3; a-- > 0;) {
      const double place = (positions[i][a] - bounds.lower[a]) / cell;
      const double number = std::floor(place);
      key = key * cells[a] + static_cast<std::uint64_t>(number);
      square += std::pow(place - number - 0.5, 2);
    }
    const auto [at, is_new] = found.try_emplace(key, Best{i, square});
    if (!is_new && square < at->second.square) at->second = {i, square};
  }
  Selection selection{{}, cell};
  for (const auto& [key, best] : found) selection.points.push_back(best.point);
  std::sort(selection.points.begin(), selection.points.end());
  return selection;
}

Selection thinned(Positions positions, double spacing, std::size_t most) {
  constexpr int kAttempts = 12;
  constexpr double kNearlyAll = 0.95;
  constexpr double kSmallest = 1e-6;  // cell of the largest extent: points at one place never part
  const Bounds bounds = bounds_of(positions, spacing);
  const auto aim = static_cast<double>(most);
  const double power = 1.0 / std::max(1, bounds.dimension);
  double volume = 1;
  for (const double extent : bounds.extent) volume *= extent > spacing ? extent : 1;
  // Of cells that hold at most one point of a full box; a body with holes has room for smaller ones.
  double cell = rounded_up(std::pow(volume / aim, power));
  const double largest = *std::max_element(bounds.extent.begin(), bounds.extent.end());
  Selection best = one_per_cell(positions, spacing, largest);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Selection here = one_per_cell(positions, spacing, cell);
    const double count = static_cast<double>(here.points.size());
    if (here.points.size() <= most && here.points.size() > best.points.size()) best = std::move(here);
    if (count <= aim && count >= kNearlyAll * aim) break;
    cell = rounded_up(
        std::max(cell * std::pow(count / (aim * (1 + kNearlyAll) / 2), power), kSmallest * largest));
  }
  return best;
}

}  // namespace riven
