#include "report/thinning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace riven {
namespace {

using Cloud = std::vector<std::array<double, 3>>;

double uniform(std::mt19937_64& random, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(random);
}

/// Scattered in a box of one to three dimensions, which lies anywhere.
Cloud scattered(std::size_t points, int dimension, std::mt19937_64& random) {
  std::array<double, 3> lower{}, size{};
  for (std::size_t a = 0; a < 3; ++a) {
    lower[a] = uniform(random, -5, 5);
    size[a] = a < static_cast<std::size_t>(dimension) ? uniform(random, 0.1, 2) : 0;
  }
  Cloud cloud(points);
  for (auto& position : cloud)
    for (std::size_t a = 0; a < 3; ++a) position[a] = lower[a] + size[a] * uniform(random, 0, 1);
  return cloud;
}

Cloud lattice(int nx, int ny, int nz, double spacing) {
  Cloud cloud;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) cloud.push_back({spacing * (i - 7.3), spacing * (j + 2.1), spacing * k});
  return cloud;
}

/// The cell of each point, found on its own.
std::vector<std::array<long, 3>> cells_of(const Cloud& cloud, double spacing, double cell) {
  std::array<double, 3> lower{INFINITY, INFINITY, INFINITY};
  for (const auto& position : cloud)
    for (std::size_t a = 0; a < 3; ++a) lower[a] = std::min(lower[a], position[a] - spacing / 2);
  std::vector<std::array<long, 3>> cells;
  for (const auto& position : cloud) {
    cells.emplace_back();
    for (std::size_t a = 0; a < 3; ++a)
      cells.back()[a] = static_cast<long>(std::floor((position[a] - lower[a]) / cell));
  }
  return cells;
}

TEST(Thinning, TakesTheMiddlePointOfEachOccupiedCell) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 60; ++trial) {
    const Cloud cloud = scattered(1 + random() % 3000, 1 + trial % 3, random);
    const double spacing = uniform(random, 0.001, 0.1), cell = uniform(random, 0.01, 0.8);
    const Selection chosen = one_per_cell(cloud, spacing, cell);
    EXPECT_EQ(one_per_cell(cloud, spacing, cell).points, chosen.points);
    EXPECT_TRUE(std::is_sorted(chosen.points.begin(), chosen.points.end()));
    const auto cells = cells_of(cloud, spacing, cell);
    const std::set<std::array<long, 3>> occupied(cells.begin(), cells.end());
    std::map<std::array<long, 3>, std::size_t> shown;
    for (const std::size_t point : chosen.points) {
      ASSERT_LT(point, cloud.size());
      EXPECT_TRUE(shown.emplace(cells[point], point).second) << "two points of a cell";
    }
    EXPECT_EQ(shown.size(), occupied.size());
    // The middle of a cell is nearer to its point than to any other one of the cell.
    std::array<double, 3> lower{INFINITY, INFINITY, INFINITY};
    for (const auto& position : cloud)
      for (std::size_t a = 0; a < 3; ++a) lower[a] = std::min(lower[a], position[a] - spacing / 2);
    const auto distance = [&](std::size_t point) {
      double square = 0;
      for (std::size_t a = 0; a < 3; ++a)
        square +=
            std::pow(cloud[point][a] - lower[a] - (static_cast<double>(cells[point][a]) + 0.5) * cell, 2);
      return std::sqrt(square);
    };
    for (std::size_t point = 0; point < cloud.size(); ++point)
      EXPECT_LE(distance(shown.at(cells[point])), distance(point) + 1e-12);  // rounding of lengths near 1
  }
}

TEST(Thinning, LeavesAtMostTheNumberAskedForAndNotManyFewer) {
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 60; ++trial) {
    const int dimension = 1 + trial % 3;
    const Cloud cloud = scattered(2000 + random() % 3000, dimension, random);
    const std::size_t most = 1 + random() % 1500;
    const Selection chosen = thinned(cloud, 0.01, most);
    EXPECT_LE(chosen.points.size(), most);
    // Scattered points fill cells by chance; measured: 0.79 at the least of 100 and more.
    EXPECT_TRUE(most < 100 || static_cast<double>(chosen.points.size()) >= 0.7 * static_cast<double>(most))
        << chosen.points.size() << " of " << most;
    EXPECT_EQ(chosen.points, one_per_cell(cloud, 0.01, chosen.cell).points) << "the cell that is told";
    EXPECT_EQ(thinned(cloud, 0.01, most).points, chosen.points);
  }
}

TEST(Thinning, ALatticeBecomesALattice) {
  const Selection solid = thinned(lattice(20, 20, 20, 0.002), 0.002, 1000);
  EXPECT_EQ(solid.points.size(), 1000u);
  EXPECT_DOUBLE_EQ(solid.cell, 0.004);
  EXPECT_EQ(thinned(lattice(60, 60, 1, 0.1), 0.1, 400).points.size(), 400u);
  EXPECT_EQ(thinned(lattice(500, 1, 1, 0.1), 0.1, 100).points.size(), 100u);
}

TEST(Thinning, ABodyOfHolesKeepsItsShareOfPoints) {
  Cloud shell;  // a tenth of its box is filled
  for (const auto& position : lattice(40, 40, 40, 1))
    if (position[2] < 2 || position[0] > 30) shell.push_back(position);
  const std::size_t most = shell.size() / 4;
  const Selection chosen = thinned(shell, 1, most);
  EXPECT_LE(chosen.points.size(), most);
  EXPECT_GE(chosen.points.size(), most * 9 / 10);  // measured: 0.99; cells for a full box would leave a third
}

TEST(Thinning, PointsAtOnePlaceEndToo) {
  const Cloud cloud(1000, {1, 2, 3});
  EXPECT_EQ(thinned(cloud, 0.1, 10).points, std::vector<std::size_t>{0});
}

TEST(EvenlySpaced, HasTheEndsAndEqualSteps) {
  EXPECT_EQ(evenly_spaced(1, 9), std::vector<std::size_t>{8});
  EXPECT_EQ(evenly_spaced(2, 9), (std::vector<std::size_t>{0, 8}));
  EXPECT_EQ(evenly_spaced(5, 9), (std::vector<std::size_t>{0, 2, 4, 6, 8}));
  for (std::size_t of = 2; of < 60; ++of)
    for (std::size_t count = 2; count <= of; ++count) {
      const auto numbers = evenly_spaced(count, of);
      ASSERT_EQ(numbers.size(), count);
      EXPECT_EQ(numbers.front(), 0u);
      EXPECT_EQ(numbers.back(), of - 1);
      const double step = static_cast<double>(of - 1) / static_cast<double>(count - 1);
      for (std::size_t n = 1; n < count; ++n)
        EXPECT_LT(std::abs(static_cast<double>(numbers[n] - numbers[n - 1]) - step), 1);
    }
}

ViewSize random_size(std::mt19937_64& random) {
  const auto number = [&](double most) {
    return static_cast<std::size_t>(std::exp(uniform(random, 0, std::log(most))));
  };
  return {.all = {number(5000), number(3e6)},
          .fixed = uniform(random, 0, 1e5),
          .per_point = uniform(random, 1, 16),
          .per_value = uniform(random, 1, 100)};
}

TEST(Fitting, RespectsTheBudgetAndTheOrderOfWhatIsLeftOut) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 5000; ++trial) {
    const ViewSize size = random_size(random);
    const double budget = std::exp(uniform(random, std::log(3e5), std::log(3e7)));
    const Extent fit = fitting(size, budget);
    ASSERT_GT(fit.states, 0u);
    ASSERT_GT(fit.points, 0u);
    EXPECT_LE(size.bytes(fit), budget);
    EXPECT_LE(fit.states, size.all.states);
    EXPECT_LE(fit.points, size.all.points);
    // Which rule was followed: 40 states at least, 100 000 points at least, 10 states at least, or points
    // alone.
    const auto [states, points] = size.all;
    const std::size_t forty = std::min<std::size_t>(40, states), five = std::min<std::size_t>(5, states);
    const std::size_t many = std::min<std::size_t>(100000, points);
    const bool rules[] = {fit.states >= forty && fit.points == points,
                          fit.states == forty && fit.points >= many,
                          fit.states >= five && fit.states <= forty && fit.points == many,
                          fit.states == five && fit.points <= many};
    EXPECT_TRUE(std::any_of(std::begin(rules), std::end(rules), [](bool rule) { return rule; }))
        << fit.states << " of " << states << ", " << fit.points << " of " << points;
    // Nothing is left out that would have had room.
    const Extent more =
        rules[0] || rules[2] ? Extent{fit.states + 1, fit.points} : Extent{fit.states, fit.points + 1};
    EXPECT_EQ(fit == size.all, size.bytes(size.all) <= budget);
    EXPECT_TRUE(fit == size.all || size.bytes(more) > budget);
  }
}

TEST(Fitting, AMeshKeepsItsPoints) {
  std::mt19937_64 random(6);
  int refused = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    ViewSize size = random_size(random);
    size.mesh = true;
    const Extent fit = fitting(size, 3e6);
    EXPECT_EQ(fit.points, size.all.points);
    refused += fit.states == 0 ? 1 : 0;
    EXPECT_EQ(fit.states == 0, size.bytes({1, fit.points}) > 3e6);
    EXPECT_TRUE(fit.states == 0 || size.bytes(fit) <= 3e6);
  }
  EXPECT_GT(refused, 100);
}

TEST(Shares, GiveWhatIsNeededOrEqualParts) {
  EXPECT_EQ(shares({1, 100, 100}, 21), (std::vector<double>{1, 10, 10}));
  EXPECT_EQ(shares({5, 5}, 20), (std::vector<double>{10, 10}));
  EXPECT_EQ(shares({7}, -1), std::vector<double>{0});
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<double> needs(1 + random() % 9);
    for (double& need : needs) need = uniform(random, 0, 10);
    const double budget = uniform(random, 0, 60), equal = budget / static_cast<double>(needs.size());
    const auto parts = shares(needs, budget);
    EXPECT_NEAR(std::accumulate(parts.begin(), parts.end(), 0.0), budget, 1e-12 * 60);
    for (std::size_t n = 0; n < needs.size(); ++n) EXPECT_GE(parts[n] + 1e-12, std::min(needs[n], equal));
  }
}

}  // namespace
}  // namespace riven
