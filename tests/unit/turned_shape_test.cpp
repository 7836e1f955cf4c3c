#include "geometry/turned_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "support/random.hpp"

namespace riven {
namespace {

// The distance is that of the shape seen from a turned frame; 1e-14 is the rounding of lengths of about 1.
TEST(TurnedShape, IsTheShapeInATurnedFrame) {
  testing::Random random(9);
  for (int n = 0; n < 200; ++n) {
    const Point center{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const Box box{center, {random.between(0.1, 1), random.between(0.1, 1), random.between(0.1, 1)}};
    const double angle = random.between(-6, 6);
    const Eigen::Vector2d local(random.between(-2, 2), random.between(-2, 2));
    const double z = random.between(-1, 1);
    const Eigen::Vector2d turned = Eigen::Rotation2Dd(angle) * local;
    EXPECT_NEAR(signed_distance(TurnedShape{box, angle},
                                {center[0] + turned[0], center[1] + turned[1], center[2] + z}),
                signed_distance(Shape{box}, {center[0] + local[0], center[1] + local[1], center[2] + z}),
                1e-14);
  }
}

TEST(TurnedShape, TurnsCounterclockwise) {
  const TurnedShape slanted{Box{{1, 0, 0}, {1, 0.01, 1}}, std::numbers::pi / 4};
  EXPECT_LT(signed_distance(slanted, {1.5, 0.5, 0}), 0);
  EXPECT_GT(signed_distance(slanted, {1.5, -0.5, 0}), 0);
}

TEST(TurnedShape, Measures) {
  const double pi = std::numbers::pi;
  EXPECT_DOUBLE_EQ(measure({Box{{}, {1, 2, 3}}, 0.3}, 2), 8);
  EXPECT_DOUBLE_EQ(measure({Box{{}, {1, 2, 3}}}, 3), 48);
  EXPECT_DOUBLE_EQ(measure({Box{{}, {1, 2, 3}}}, 1), 2);
  EXPECT_DOUBLE_EQ(measure({Disc{{}, 2}}, 2), 4 * pi);
  EXPECT_DOUBLE_EQ(measure({Disc{{}, 2}}, 1), 4);
  EXPECT_TRUE(std::isinf(measure({Disc{{}, 2}}, 3)));
  EXPECT_DOUBLE_EQ(measure({Ball{{}, 2}}, 3), 32 * pi / 3);
}

}  // namespace
}  // namespace riven
