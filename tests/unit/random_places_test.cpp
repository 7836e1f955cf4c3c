#include "geometry/random_places.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "support/random.hpp"

namespace riven {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
// Of the lengths here (m), for the rounding of sums of coordinates.
constexpr double kRounding = 1e-15;

Box sheet(double width, double height) {
  return {{0.01, -0.02, 0}, {width / 2, height / 2, kEndless}};
}

double distance_of(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

void expect_apart_and_inside(const std::vector<Point>& centers, const RandomPlaces& asked,
                             const Shape& body) {
  ASSERT_EQ(centers.size(), static_cast<std::size_t>(asked.number));
  for (std::size_t n = 0; n < centers.size(); ++n) {
    EXPECT_LE(signed_distance(body, centers[n]), -(asked.radius + asked.margin) + kRounding);
    for (std::size_t m = 0; m < n; ++m)
      EXPECT_GE(distance_of(centers[n], centers[m]), 2 * asked.radius + asked.gap - kRounding);
  }
}

TEST(RandomPlaces, AreApartAndInside) {
  testing::Random random(4);
  for (int n = 0; n < 60; ++n) {
    const int dimension = n % 3 == 2 ? 3 : 2;
    RandomPlaces asked{.number = random.integer(1, 40),
                       .radius = random.between(0.002, 0.005),
                       .gap = random.between(0, 0.002),
                       .margin = random.between(0, 0.003),
                       .seed = static_cast<std::uint64_t>(n)};
    Shape body = sheet(random.between(0.08, 0.12), random.between(0.08, 0.12));
    if (n % 3 == 1) body = Disc{{0.01, 0.02, 0}, random.between(0.05, 0.07)};
    if (dimension == 3) body = Box{{0, 0.01, 0}, {0.03, 0.025, 0.02}};
    SCOPED_TRACE(n);
    const auto centers = random_places(asked, body, dimension);
    ASSERT_TRUE(centers);
    expect_apart_and_inside(*centers, asked, body);
  }
}

TEST(RandomPlaces, TheFourModelsOfTheCompositeFit) {
  for (const auto& [number, radius] :
       std::vector<std::pair<int, double>>{{12, 6e-3}, {24, 4.2e-3}, {36, 3.5e-3}, {48, 3e-3}})
    for (const std::uint64_t seed : {1, 2, 3}) {
      const RandomPlaces asked{number, radius, 1e-3, 1e-3, seed};
      const auto centers = random_places(asked, sheet(0.1, 0.1), 2);
      ASSERT_TRUE(centers);
      expect_apart_and_inside(*centers, asked, sheet(0.1, 0.1));
    }
}

// The language fixes the generator; the map to lengths is written out once more. So the bits are those of
// every machine.
TEST(RandomPlaces, FollowFromTheSeed) {
  const RandomPlaces asked{.number = 1, .radius = 0.01, .gap = 0, .margin = 0.005, .seed = 7};
  std::mt19937_64 engine(7);
  const double x = static_cast<double>(engine() >> 11) / 9007199254740992.0;
  const double y = static_cast<double>(engine() >> 11) / 9007199254740992.0;
  const auto found = random_places(asked, Box{{0, 0, 0}, {0.05, 0.04, kEndless}}, 2);
  EXPECT_DOUBLE_EQ(found->front()[0], -0.035 + 0.07 * x);
  EXPECT_DOUBLE_EQ(found->front()[1], -0.025 + 0.05 * y);
  EXPECT_EQ(*found, *random_places(asked, Box{{0, 0, 0}, {0.05, 0.04, kEndless}}, 2));
  RandomPlaces other = asked;
  other.seed = 8;
  EXPECT_NE(*found, *random_places(other, Box{{0, 0, 0}, {0.05, 0.04, kEndless}}, 2));
}

// The mean of n equally likely places of a square of edge 1 has a standard deviation of 1 / sqrt(12 n), of
// squares from its centre 0.18^2 / n at most; five of them are passed once in a million.
TEST(RandomPlaces, EveryPlaceIsAsLikely) {
  constexpr int kSeeds = 4000;
  double x = 0, square = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Point at =
        random_places({1, 0.5, 0, 0, static_cast<std::uint64_t>(seed)}, Box{{}, {1, 1, kEndless}}, 2)
            ->front();
    x += at[0] / kSeeds;
    square += (at[0] * at[0] + at[1] * at[1]) / kSeeds;
  }
  EXPECT_NEAR(x, 0, 5 / std::sqrt(12.0 * kSeeds));
  EXPECT_NEAR(square, 2.0 / 12, 5 * 0.11 / std::sqrt(kSeeds));
}

// Random sequential addition jams at 0.547 in the plane; what lies beyond is pushed apart.
TEST(RandomPlaces, GetDenserThanByAddition) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    RandomPlaces asked{.number = 100, .radius = 0.0045, .gap = 0.0005, .margin = 0.0005, .seed = seed};
    const double filled = filled_fraction(asked, sheet(0.1, 0.1), 2);
    EXPECT_NEAR(filled, 100 * std::numbers::pi * 0.00475 * 0.00475 / (0.0995 * 0.0995), 1e-12);
    EXPECT_GT(filled, 0.7);
    const auto centers = random_places(asked, sheet(0.1, 0.1), 2);
    ASSERT_TRUE(centers) << filled;
    expect_apart_and_inside(*centers, asked, sheet(0.1, 0.1));
  }
}

TEST(RandomPlaces, EndWhereThereIsNoRoom) {
  // Above the densest packing, and a body that is too small for one.
  EXPECT_FALSE(random_places({.number = 100, .radius = 0.0055}, sheet(0.1, 0.1), 2));
  EXPECT_FALSE(random_places({.number = 1, .radius = 0.06}, sheet(0.1, 0.1), 2));
  EXPECT_TRUE(std::isinf(filled_fraction({.number = 1, .radius = 0.06}, sheet(0.1, 0.1), 2)));
  // Below it, but no arrangement of five discs in a square has a radius above 0.2071 of its edge.
  EXPECT_FALSE(random_places({.number = 5, .radius = 0.0209}, sheet(0.1, 0.1), 2));
  EXPECT_TRUE(random_places({.number = 5, .radius = 0.0195}, sheet(0.1, 0.1), 2));
  // One disc may fill a disc.
  EXPECT_TRUE(random_places({.number = 1, .radius = 0.0499}, Disc{{}, 0.05}, 2));
}

}  // namespace
}  // namespace riven
