#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "geometry/defects.hpp"
#include "geometry/shape.hpp"

namespace riven {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double pi = std::numbers::pi;
constexpr double tolerance = 1e-9;  // lengths below are about 1

Box rectangle(double x, double y, double half_x, double half_y) {
  return {{x, y, 0}, {half_x, half_y, infinity}};
}

class Random {
 public:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Point in_plane(double reach) { return {between(-reach, reach), between(-reach, reach), 0}; }
  Point in_space(double reach) {
    return {between(-reach, reach), between(-reach, reach), between(-reach, reach)};
  }
  // A shape of each kind in turn, about 1 in size.
  Shape shape() {
    const Point center = in_space(0.3);
    switch (count_++ % 3) {
      case 0:
        return Box{center, {between(0.2, 1), between(0.2, 1), between(0.2, 1)}};
      case 1:
        return Disc{center, between(0.2, 1)};
      default:
        return Ball{center, between(0.2, 1)};
    }
  }

 private:
  std::mt19937 engine_{20240611};
  int count_ = 0;
};

Point on_line(const Point& a, const Point& b, double t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

TEST(SignedDistance, FollowsTheClosedForms) {
  const Box box{{1, 0, 0}, {2, 1, 3}};
  EXPECT_DOUBLE_EQ(signed_distance(box, {1, 0, 0}), -1);
  EXPECT_DOUBLE_EQ(signed_distance(box, {2.5, 0, 0}), -0.5);
  EXPECT_DOUBLE_EQ(signed_distance(box, {6, 5, 0}), 5);
  EXPECT_DOUBLE_EQ(signed_distance(box, {4, 3, 5}), 3);
  EXPECT_DOUBLE_EQ(signed_distance(rectangle(0, 0, 2, 1), {0, 0.75, 0}), -0.25);
  EXPECT_DOUBLE_EQ(signed_distance(Disc{{1, 1, 0}, 2}, {4, 5, 100}), 3);
  EXPECT_DOUBLE_EQ(signed_distance(Ball{{0, 0, 0}, 4}, {1, 2, 2}), -1);
}

TEST(Chord, FollowsTheClosedForms) {
  const auto through_box = chord(rectangle(0, 0, 1, 1), {-2, 0, 0}, {2, 0, 0}, 0);
  ASSERT_TRUE(through_box);
  EXPECT_DOUBLE_EQ(through_box->from, 0.25);
  EXPECT_DOUBLE_EQ(through_box->to, 0.75);
  const auto through_disc = chord(Disc{{0, 0, 0}, 5}, {0, 3, 0}, {8, 3, 0}, 0);
  ASSERT_TRUE(through_disc);
  EXPECT_DOUBLE_EQ(through_disc->from, 0);
  EXPECT_DOUBLE_EQ(through_disc->to, 0.5);
  EXPECT_FALSE(chord(Ball{{0, 0, 0}, 1}, {-2, 0.8, 0.8}, {2, 0.8, 0.8}, 0));
}

TEST(Chord, IsEmptyForASegmentThatTouchesOrRunsAlongTheSurface) {
  const Shape box = rectangle(0, 0, 1, 1);
  EXPECT_FALSE(chord(box, {-2, 1, 0}, {2, 1, 0}, tolerance));  // along an edge
  EXPECT_FALSE(chord(box, {0, 2, 0}, {2, 0, 0}, tolerance));   // through a corner
  EXPECT_FALSE(chord(box, {1, 0, 0}, {2, 0, 0}, tolerance));   // leaves from the surface
  EXPECT_FALSE(chord(Disc{{0, 0, 0}, 1}, {-2, 1, 0}, {2, 1, 0}, tolerance));
  EXPECT_FALSE(chord(Ball{{0, 0, 0}, 1}, {-2, 0, 1}, {2, 0, 1}, tolerance));
  EXPECT_FALSE(chord(Disc{{0, 0, 0}, tolerance}, {-1, 0, 0}, {1, 0, 0}, tolerance));
}

TEST(Chord, OfASinglePointIsAllOrNothing) {
  const std::vector<Shape> shapes{rectangle(0, 0, 1, 1), Disc{{0, 0, 0}, 1}, Ball{{0, 0, 0}, 1}};
  for (const Shape& shape : shapes) {
    const auto inside = chord(shape, {0.5, 0, 0}, {0.5, 0, 0}, tolerance);
    ASSERT_TRUE(inside);
    EXPECT_EQ(inside->from, 0);
    EXPECT_EQ(inside->to, 1);
    EXPECT_FALSE(chord(shape, {1, 0, 0}, {1, 0, 0}, tolerance));
  }
}

TEST(Chord, AgreesWithDenseSampling) {
  Random random;
  constexpr int samples = 200;
  for (int trial = 0; trial < 3000; ++trial) {
    const Shape shape = random.shape();
    const Point a = random.in_space(1.5);
    const Point b = random.in_space(1.5);
    const double shrink = trial % 2 == 0 ? 0 : 0.1;
    const auto part = chord(shape, a, b, shrink);
    for (int i = 0; i <= samples; ++i) {
      const double t = static_cast<double>(i) / samples;
      const double d = signed_distance(shape, on_line(a, b, t)) + shrink;
      if (std::abs(d) < 1e-12) continue;
      EXPECT_EQ(d < 0, part && part->from <= t && t <= part->to) << "trial " << trial << ", t = " << t;
    }
  }
}

TEST(CoveredFraction, OfABoxIsTheProductOfOverlaps) {
  const Box box{{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(covered_fraction(box, {0.3, 0.4, 0.5}, 0.1, 3), 1);
  EXPECT_EQ(covered_fraction(box, {1.05, 0, 0}, 0.1, 3), 0);
  EXPECT_NEAR(covered_fraction(box, {1, 0, 0}, 0.1, 1), 0.5, 1e-15);
  EXPECT_NEAR(covered_fraction(box, {1, 1, 0}, 0.1, 2), 0.25, 1e-15);
  EXPECT_NEAR(covered_fraction(box, {1, 1, 0.975}, 0.1, 3), 0.1875, 1e-14);
  EXPECT_NEAR(covered_fraction(box, {0, 0, 0}, 4, 3), 0.125, 1e-15);
  EXPECT_EQ(covered_fraction(rectangle(0, 0, infinity, infinity), {3, 4, 0}, 0.1, 2), 1);
}

TEST(CoveredFraction, OfADiscFollowsClosedForms) {
  EXPECT_NEAR(covered_fraction(Disc{{0, 0, 0}, 1}, {0, 0, 0}, 4, 2), pi / 16, 1e-15);
  EXPECT_NEAR(covered_fraction(Disc{{0, 0, 0}, 1}, {1, 1, 0}, 2, 2), pi / 16, 1e-15);
  EXPECT_NEAR(covered_fraction(Disc{{0, 0, 0}, 1}, {2, 0, 0}, 4, 2), pi / 32, 1e-15);
  // All four corners of the square stick out: four segments are missing from the disc.
  const double angle = 2 * std::acos(1 / 1.2);
  const double expected = pi * 1.44 - 4 * 0.72 * (angle - std::sin(angle));
  EXPECT_NEAR(covered_fraction(Disc{{0, 0, 0}, 1.2}, {0, 0, 0}, 2, 2), expected / 4, 1e-14);
  // In 3D the cylinder, in 1D the interval that the line cuts out.
  EXPECT_EQ(covered_fraction(Disc{{0, 0, 0}, 1}, {0.9, 0.2, 7}, 0.3, 3),
            covered_fraction(Disc{{0, 0, 0}, 1}, {0.9, 0.2, 0}, 0.3, 2));
  EXPECT_NEAR(covered_fraction(Disc{{0, 0.6, 0}, 1}, {0.8, 0, 0}, 0.1, 1), 0.5, 1e-14);
}

TEST(CoveredFraction, IsExactlyZeroOrOneForTouchingCells) {
  for (const double spacing : {0.1, 0.3, 0.7, 1e-3}) {
    const Disc disc{{0.1, -0.2, 0}, 7 * spacing};
    const Ball ball{disc.center, disc.radius};
    const Box box = rectangle(0.1, -0.2, 7 * spacing, 7 * spacing);
    const Point outside{0.1 + 7.5 * spacing, -0.2, 0};
    const Point inside{0.1 + 6.5 * spacing, -0.2, 0};
    EXPECT_EQ(covered_fraction(disc, outside, spacing, 2), 0);
    EXPECT_EQ(covered_fraction(ball, outside, spacing, 3), 0);
    EXPECT_EQ(covered_fraction(box, outside, spacing, 2), 0);
    EXPECT_EQ(covered_fraction(box, inside, spacing, 2), 1);
    EXPECT_EQ(covered_fraction(disc, {0.1, -0.2, 0}, spacing, 2), 1);
    EXPECT_EQ(covered_fraction(ball, {0.1, -0.2, 0}, spacing, 3), 1);
  }
}

double sum_over_grid(const Shape& shape, double reach, int cells, int dimension) {
  const double spacing = 2 * reach / cells;
  const auto at = [&](int i) { return -reach + (i + 0.5) * spacing; };
  double sum = 0;
  for (int k = 0; k < (dimension == 3 ? cells : 1); ++k)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i)
        sum += covered_fraction(shape, {at(i), at(j), dimension == 3 ? at(k) : 0}, spacing, dimension);
  return sum * std::pow(spacing, dimension);
}

TEST(CoveredFraction, SumsToTheAreaOfTheShape) {
  Random random;
  for (int trial = 0; trial < 200; ++trial) {
    const Point center = random.in_plane(0.5);
    const double radius = random.between(0.01, 0.5);
    const double half_y = random.between(0.01, 0.5);
    const int cells = static_cast<int>(random.between(1, 40));
    const Box box = rectangle(center[0], center[1], radius, half_y);
    EXPECT_NEAR(sum_over_grid(Disc{center, radius}, 1, cells, 2), pi * radius * radius, 1e-13);
    EXPECT_NEAR(sum_over_grid(box, 1, cells, 2), 4 * radius * half_y, 1e-13);
  }
}

TEST(CoveredFraction, StaysExactForADiscMuchLargerThanACell) {
  // A disc of 1e5 cells: nearly the half plane y < 0, less the sagitta x^2 / 2r. Measured: 2e-12 off;
  // the rounding of positions alone, 1e-16 * 1e5, moves the surface by 1e-11 cells.
  const double radius = 1e5;
  const Disc disc{{0, -radius, 0}, radius};
  EXPECT_NEAR(covered_fraction(disc, {0, 0, 0}, 1, 2), 0.5 - 1 / (24 * radius), 1e-10);
}

TEST(CoveredFraction, OfABallIsAccurate) {
  // Against the same cell in 6^3 parts; measured in 3000 trials: 3e-5 at worst.
  Random random;
  for (int trial = 0; trial < 300; ++trial) {
    const Ball ball{random.in_space(0.9), random.between(0.02, 1.5)};
    const double in_parts = sum_over_grid(ball, 0.5, 6, 3);
    EXPECT_NEAR(covered_fraction(ball, {0, 0, 0}, 1, 3), in_parts, 1e-4);
  }
  const Ball within{{0.2, -0.3, 0.1}, 0.65};
  EXPECT_NEAR(sum_over_grid(within, 1, 9, 3), 4 * pi / 3 * std::pow(within.radius, 3), 1e-5);
  EXPECT_NEAR(covered_fraction(Ball{{0, 0, 0}, 1}, {1, 1, 1}, 2, 3), pi / 48, 1e-6);
  EXPECT_NEAR(covered_fraction(Ball{{0, 0, 0}, 1}, {2, 0, 0}, 4, 3), pi / 96, 1e-6);
}

TEST(CoveredFraction, IsTheSameAfterQuarterTurnsAndReflections) {
  Random random;
  for (int trial = 0; trial < 3000; ++trial) {
    const Point center = random.in_plane(0.5);
    const Point cell = random.in_plane(1);
    const double radius = random.between(0.1, 1);
    const double spacing = random.between(0.05, 0.5);
    const auto turned = [](const Point& p) { return Point{-p[1], p[0], 0}; };
    const auto mirrored = [](const Point& p) { return Point{-p[0], p[1], 0}; };
    const double disc = covered_fraction(Disc{center, radius}, cell, spacing, 2);
    EXPECT_NEAR(disc, covered_fraction(Disc{turned(center), radius}, turned(cell), spacing, 2), 1e-13);
    EXPECT_EQ(disc, covered_fraction(Disc{mirrored(center), radius}, mirrored(cell), spacing, 2));
    const double box = covered_fraction(Box{center, {radius, 0.3, infinity}}, cell, spacing, 2);
    EXPECT_NEAR(box, covered_fraction(Box{turned(center), {0.3, radius, infinity}}, turned(cell), spacing, 2),
                1e-15);
    EXPECT_EQ(box,
              covered_fraction(Box{mirrored(center), {radius, 0.3, infinity}}, mirrored(cell), spacing, 2));
  }
}

TEST(Overlap, NeedsSharedInterior) {
  const Box box{{0, 0, 0}, {1, 1, 1}};
  EXPECT_TRUE(overlap(box, Box{{1.5, 0, 0}, {1, 1, 1}}, tolerance));
  EXPECT_FALSE(overlap(box, Box{{2, 0, 0}, {1, 1, 1}}, tolerance));
  EXPECT_FALSE(overlap(box, Disc{{2, 0, 0}, 1}, tolerance));
  EXPECT_TRUE(overlap(Disc{{1.9, 0, 9}, 1}, box, tolerance));
  EXPECT_TRUE(overlap(box, Disc{{0, 0, 0}, 0.1}, tolerance));
  EXPECT_FALSE(overlap(box, Disc{{2, 2, 0}, 1.4}, tolerance));  // near the corner
  EXPECT_FALSE(overlap(Ball{{0, 0, 9}, 1}, box, tolerance));
  EXPECT_TRUE(overlap(Ball{{0, 0, 9}, 1}, Disc{{1.5, 0, 0}, 1}, tolerance));
  EXPECT_FALSE(overlap(Ball{{0, 0, 0}, 1}, Ball{{2, 0, 0}, 1}, tolerance));
  EXPECT_TRUE(overlap(rectangle(0, 0, 1, 1), rectangle(0, 1.9, 1, 1), tolerance));
}

TEST(SegmentDistance, FollowsTheClosedForms) {
  const Segment crack{{0, 0, 0}, {2, 0, 0}};
  EXPECT_DOUBLE_EQ(distance(crack, {1, 0.5, 0}), 0.5);
  EXPECT_DOUBLE_EQ(distance(crack, {5, 4, 0}), 5);
  EXPECT_DOUBLE_EQ(distance(crack, {-3, 4, 0}), 5);
  EXPECT_DOUBLE_EQ(distance(Segment{{1, 1, 0}, {1, 1, 0}}, {1, 3, 0}), 2);
}

TEST(Crosses, AnsweredForTouchingAndEnds) {
  const Segment crack{{0, 0, 0}, {1, 0, 0}};
  EXPECT_TRUE(crosses(crack, {0.5, -1, 0}, {0.5, 1, 0}, tolerance));
  EXPECT_TRUE(crosses(crack, {-0.5, -1, 0}, {1, 1, 0}, tolerance));
  EXPECT_FALSE(crosses(crack, {0.5, 0.1, 0}, {0.5, 1, 0}, tolerance));
  EXPECT_FALSE(crosses(crack, {0.5, 0, 0}, {0.5, 1, 0}, tolerance));  // touches from one side
  EXPECT_FALSE(crosses(crack, {-1, 0, 0}, {2, 0, 0}, tolerance));     // runs along the crack
  EXPECT_TRUE(crosses(crack, {1, -1, 0}, {1, 1, 0}, tolerance));      // through an end
  EXPECT_TRUE(crosses(crack, {-1, -1, 0}, {1, 1, 0}, tolerance));
  EXPECT_FALSE(crosses(crack, {1 + 1e-6, -1, 0}, {1 + 1e-6, 1, 0}, tolerance));
  EXPECT_FALSE(crosses(Segment{{0, 0, 0}, {0, 0, 0}}, {-1, 0, 0}, {1, 0, 0}, tolerance));
}

TEST(Crosses, AgreesWithSolvingForTheMeetingPoint) {
  Random random;
  for (int trial = 0; trial < 5000; ++trial) {
    const Segment crack{random.in_plane(1), random.in_plane(1)};
    const Point a = random.in_plane(1);
    const Point b = random.in_plane(1);
    const double ux = crack.b[0] - crack.a[0], uy = crack.b[1] - crack.a[1];
    const double vx = b[0] - a[0], vy = b[1] - a[1];
    const double wx = a[0] - crack.a[0], wy = a[1] - crack.a[1];
    const double det = uy * vx - ux * vy;
    const double along_crack = (wy * vx - wx * vy) / det;
    const double along_bond = (ux * wy - uy * wx) / det;
    const bool meet = along_crack > 0 && along_crack < 1 && along_bond > 0 && along_bond < 1;
    EXPECT_EQ(crosses(crack, a, b, 1e-12), meet) << "trial " << trial;
  }
}

TEST(Defects, SlotCutsBondsAcrossAndKeepsThoseAlongAnEdge) {
  const Defects slot{{rectangle(0, 0, 1, 0.1)}, {}, {}};
  EXPECT_TRUE(slot.cuts({0, -0.1, 0}, {0, 0.1, 0}, tolerance));  // between opposite edges
  EXPECT_TRUE(slot.cuts({-0.3, -0.1, 0}, {0.3, 0.1, 0}, tolerance));
  EXPECT_TRUE(slot.cuts({0, -0.5, 0}, {0, 0.5, 0}, tolerance));
  EXPECT_FALSE(slot.cuts({-0.3, 0.1, 0}, {0.3, 0.1, 0}, tolerance));  // along an edge
  EXPECT_FALSE(slot.cuts({1, -0.3, 0}, {1, 0.3, 0}, tolerance));      // along the slot's end
  EXPECT_FALSE(slot.cuts({0.9, 0.2, 0}, {1.1, 0, 0}, tolerance));     // through a corner
  EXPECT_TRUE(slot.cuts({0.9, 0.1, 0}, {1, 0, 0}, tolerance));        // across a corner
  EXPECT_FALSE(slot.cuts({0, 0.1, 0}, {0, 0.4, 0}, tolerance));
}

TEST(Defects, PartsThatStartAtAnEndPointInsideDoNotCount) {
  const Defects hole{{Disc{{0, 0, 0}, 1}}, {}, {}};
  EXPECT_FALSE(hole.cuts({0.95, 0, 0}, {1.5, 0, 0}, tolerance));
  EXPECT_FALSE(hole.cuts({0.95, 0, 0}, {-1.5, 0, 0}, tolerance));
  EXPECT_FALSE(hole.cuts({0.95, 0, 0}, {0, 0.95, 0}, tolerance));
  EXPECT_TRUE(hole.cuts({1, 0, 0}, {0, 1, 0}, tolerance));
  EXPECT_TRUE(hole.cuts({1.05, 0, 0}, {0, 1.05, 0}, tolerance));
}

TEST(Defects, InclusionsNeverCut) {
  const Defects inclusion{{}, {}, {Disc{{0, 0, 0}, 1}}};
  EXPECT_FALSE(inclusion.cuts({-2, 0, 0}, {2, 0, 0}, tolerance));
  EXPECT_DOUBLE_EQ(inclusion.distance_to_edge({0.25, 0, 0}), 0.75);
}

TEST(Defects, DistanceToTheNearestEdge) {
  EXPECT_EQ(Defects{}.distance_to_edge({1, 2, 3}), infinity);
  const Defects several{{rectangle(0, 0, 1, 1)}, {{{5, 0, 0}, {6, 0, 0}}}, {Disc{{0, 5, 0}, 1}}};
  EXPECT_DOUBLE_EQ(several.distance_to_edge({1.5, 0, 0}), 0.5);
  EXPECT_DOUBLE_EQ(several.distance_to_edge({5.5, 0.25, 0}), 0.25);
  EXPECT_DOUBLE_EQ(several.distance_to_edge({0, 3.75, 0}), 0.25);
}

TEST(Defects, CutsTheSameBondFromBothEnds) {
  // A lattice, so that many bonds touch edges and corners.
  Random random;
  const Defects defects{
      {rectangle(0.1, 0, 0.2, 0.1), Disc{{-0.5, 0.5, 0}, 0.3}}, {{{0.3, -0.8, 0}, {0.9, -0.2, 0}}}, {}};
  const auto lattice_point = [&] {
    return Point{0.1 * std::round(random.between(-10, 10)), 0.1 * std::round(random.between(-10, 10)), 0};
  };
  int cut = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Point a = lattice_point();
    const Point b = lattice_point();
    const bool forwards = defects.cuts(a, b, tolerance);
    EXPECT_EQ(forwards, defects.cuts(b, a, tolerance));
    cut += forwards ? 1 : 0;
  }
  EXPECT_GT(cut, 1000);
}

}  // namespace
}  // namespace riven
