#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "report/point_shape.hpp"
#include "report/projection.hpp"

namespace riven {
namespace {

using Matrix = std::array<double, 9>;

std::vector<Point> lattice(int nx, int ny, int nz, double spacing) {
  std::vector<Point> points;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) points.push_back({spacing * i, spacing * j, spacing * k});
  return points;
}

std::vector<Point> mapped(const std::vector<Point>& points, const Matrix& f) {
  std::vector<Point> moved;
  for (const auto& [x, y, z] : points)
    moved.push_back(
        {f[0] * x + f[1] * y + f[2] * z + 1, f[3] * x + f[4] * y + f[5] * z, f[6] * x + f[7] * y + f[8] * z});
  return moved;
}

TEST(Projection, FindsTheDirectionsOfABody) {
  EXPECT_EQ(Projection(lattice(5, 1, 1, 0.1)).axes(), (std::vector<std::size_t>{0}));
  EXPECT_EQ(Projection(lattice(5, 4, 1, 0.1)).axes(), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(Projection(lattice(5, 1, 4, 0.1)).axes(), (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(Projection(lattice(2, 2, 2, 0.1)).dimension(), 3);
  EXPECT_EQ(Projection(lattice(1, 1, 1, 0.1)).dimension(), 1);
  EXPECT_EQ(Projection(lattice(5, 1, 4, 0.1))({1, 7, 3}), (Point{1, 3, 0}));
}

TEST(Projection, IsARotationThatTreatsAllAxesAlike) {
  const Projection seen(lattice(2, 2, 2, 1.0));
  const Point x = seen({1, 0, 0}), y = seen({0, 1, 0}), z = seen({0, 0, 1});
  const auto dot = [](const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  for (const auto& [a, b, product] :
       {std::tuple(x, x, 1), {y, y, 1}, {z, z, 1}, {x, y, 0}, {y, z, 0}, {z, x, 0}})
    EXPECT_NEAR(dot(a, b), product, 1e-15);
  for (const Point& axis : {x, y, z}) EXPECT_NEAR(std::hypot(axis[0], axis[1]), std::sqrt(2.0 / 3), 1e-15);
  EXPECT_GT(x[0], 0);
  EXPECT_LT(x[1], 0);
  EXPECT_GT(y[0], 0);
  EXPECT_GT(y[1], 0);
  EXPECT_NEAR(z[0], 0, 1e-15);
  EXPECT_GT(z[1], 0);
  EXPECT_GT(x[2], 0) << "the side of larger x is seen";
  EXPECT_LT(y[2], 0) << "that of larger y is not";
}

TEST(PointShape, HomogeneousDeformationOfALattice) {
  const Matrix f{2.9, 0.3, 0, -0.2, 0.6, 0, 0, 0, 1};
  const std::vector<Point> points = lattice(7, 5, 1, 0.01);
  const PointShapes found = point_shapes(points, mapped(points, f), {0, 1});
  EXPECT_TRUE(found.on_lattice);
  for (const PointShape& shape : found.shapes) {
    EXPECT_NEAR(shape.spacing, 0.01, 1e-15);
    for (std::size_t n = 0; n < 9; ++n) EXPECT_NEAR(shape.gradient[n], f[n], 1e-12);
  }
  EXPECT_EQ(found.shapes.front().joined, (std::array<bool, 6>{false, true, false, true, false, false}));
  EXPECT_EQ(found.shapes[8].joined, (std::array<bool, 6>{true, true, true, true, false, false}));
}

TEST(PointShape, HomogeneousDeformationOfScatteredPoints) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  std::vector<Point> points = lattice(12, 12, 1, 1.0);
  for (Point& x : points) x = {x[0] + jitter(random), x[1] + jitter(random), 0};
  const Matrix f{1.5, 0.2, 0, 0, 0.8, 0, 0, 0, 1};
  const PointShapes found = point_shapes(points, mapped(points, f), {0, 1});
  EXPECT_FALSE(found.on_lattice);
  for (const PointShape& shape : found.shapes)
    for (std::size_t n = 0; n < 9; ++n)
      EXPECT_NEAR(shape.gradient[n], f[n], 1e-3) << "the small weight of the undeformed state";
}

TEST(PointShape, AGapOpensNoCell) {
  const std::vector<Point> points = lattice(8, 8, 1, 1.0);
  for (const double gap : {2.0, 30.0}) {
    std::vector<Point> moved = points;
    for (Point& x : moved)
      if (x[1] > 3.5) x[1] += gap;
    const PointShapes found = point_shapes(points, moved, {0, 1});
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(found.shapes[i].gradient[4], 1, 1e-12) << points[i][1];
      EXPECT_EQ(found.shapes[i].joined[3], points[i][1] < 6.5 && points[i][1] != 3) << points[i][1];
      EXPECT_EQ(found.shapes[i].joined[2], points[i][1] > 0.5 && points[i][1] != 4) << points[i][1];
    }
  }
}

TEST(PointShape, APointThatFlewAwayKeepsItsShape) {
  const std::vector<Point> points = lattice(8, 8, 1, 1.0);
  std::vector<Point> moved = points;
  moved[27] = {40, -25, 0};
  const PointShapes found = point_shapes(points, moved, {0, 1});
  EXPECT_EQ(found.shapes[27].joined, (std::array<bool, 6>{}));
  for (std::size_t n = 0; n < 9; ++n) EXPECT_NEAR(found.shapes[27].gradient[n], n % 4 == 0 ? 1 : 0, 1e-12);
}

TEST(PointShape, FewPoints) {
  EXPECT_TRUE(point_shapes({}, {}, {0}).shapes.empty());
  const std::vector<Point> one = lattice(1, 1, 1, 1.0), two = lattice(2, 1, 1, 0.5);
  EXPECT_EQ(point_shapes(one, one, {0}).shapes.size(), 1U);
  EXPECT_NEAR(point_shapes(two, two, {0}).shapes[1].spacing, 0.5, 1e-15);
}

}  // namespace
}  // namespace riven
