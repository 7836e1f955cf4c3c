#include "geometry/cubes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.hpp"

namespace riven::testing {
namespace {

TEST(Cubes, FindWhatALoopOverAllPointsFinds) {
  Random random(2);
  for (int trial = 0; trial < 30; ++trial) {
    const int dimension = 1 + trial % 3;
    // Far apart at times, so that cubes are many more than points.
    const double size = random.between(0.1, 1), extent = trial % 2 == 0 ? 3 : 1e4;
    std::vector<Point> points(static_cast<std::size_t>(random.integer(0, 400)));
    for (Point& x : points)
      for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
        x[d] = extent * random.between(-1, 1);
        if (random.chance(0.5)) x[d] = std::fmod(x[d], 2);
      }
    const Cubes cubes(points, dimension, size);
    for (const Point& x : points) {
      const double distance = size * random.between(0.2, 1);
      std::vector<std::size_t> expected;
      for (std::size_t n = 0; n < points.size(); ++n)
        if (std::hypot(points[n][0] - x[0], points[n][1] - x[1], points[n][2] - x[2]) <= distance)
          expected.push_back(n);
      EXPECT_EQ(cubes.within(x, distance), expected);
    }
  }
}

}  // namespace
}  // namespace riven::testing
