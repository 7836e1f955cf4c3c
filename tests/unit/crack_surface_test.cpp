// Cracks in space, and paths in the plane: what crosses them, how far they are, which bonds of bodies they
// cut.

#include "geometry/crack_surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "base/error.hpp"
#include "geometry/defects.hpp"
#include "support/bodies.hpp"
#include "support/pmb_bodies.hpp"
#include "support/surfaces.hpp"

namespace riven::testing {
namespace {

using Eigen::Vector3d;

constexpr double kTouch = 1e-9;

Vector3d vector(const Point& p) {
  return {p[0], p[1], p[2]};
}

Point point(const Vector3d& v) {
  return {v[0], v[1], v[2]};
}

Point random_place(Random& random, double size = 1) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

/// Whether a segment goes through a triangle, by Cramer's rule (Moeller and Trumbore).
bool hits(const std::array<Vector3d, 3>& triangle, const Vector3d& a, const Vector3d& b) {
  Eigen::Matrix3d system;
  system << triangle[1] - triangle[0], triangle[2] - triangle[0], a - b;
  const Vector3d solution = system.partialPivLu().solve(a - triangle[0]);
  return solution[0] > 0 && solution[1] > 0 && solution[0] + solution[1] < 1 && solution[2] > 0 &&
         solution[2] < 1;
}

/// A polygon with re-entrant corners in a random plane, and the triangles from its middle that fill it.
struct Star {
  explicit Star(Random& random) {
    const Eigen::Matrix3d turn = Eigen::Quaterniond(random.between(-1, 1), random.between(-1, 1),
                                                    random.between(-1, 1), random.between(-1, 1))
                                     .normalized()
                                     .toRotationMatrix();
    middle = vector(random_place(random, 0.3));
    const int count = random.integer(3, 9);
    for (int n = 0; n < count; ++n) {
      const double angle = 2 * std::numbers::pi * (n + random.between(0, 0.4)) / count;
      const double radius = random.between(0.2, 0.9);
      corner.push_back(middle + turn * Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0));
    }
  }
  [[nodiscard]] PolygonCrack polygon() const {
    PolygonCrack crack;
    for (const Vector3d& c : corner) crack.corner.push_back(point(c));
    return crack;
  }
  [[nodiscard]] std::array<Vector3d, 3> triangle(std::size_t n) const {
    return {middle, corner[n], corner[(n + 1) % corner.size()]};
  }

  Vector3d middle;
  std::vector<Vector3d> corner;
};

TEST(PolygonCrack, IsCrossedWhereItsTrianglesAre) {
  Random random(1);
  int crossed = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Star star(random);
    const CrackSurface crack(star.polygon());
    const Point a = random_place(random), b = random_place(random);
    bool expected = false;
    for (std::size_t n = 0; n < star.corner.size(); ++n)
      expected = expected || hits(star.triangle(n), vector(a), vector(b));
    EXPECT_EQ(crack.crosses(a, b, 1e-12), expected) << "trial " << trial;
    EXPECT_EQ(crack.crosses(b, a, 1e-12), expected) << "trial " << trial;
    crossed += expected ? 1 : 0;
  }
  EXPECT_GT(crossed, 200);
}

// No place of the polygon is nearer than the distance, and some places of a fine net of them are not much
// farther away.
TEST(PolygonCrack, IsAsFarAsItsNearestPlace) {
  Random random(2);
  constexpr int kParts = 60;
  for (int trial = 0; trial < 100; ++trial) {
    const Star star(random);
    const CrackSurface crack(star.polygon());
    const Point p = random_place(random);
    double nearest = 1e9, area = 0;
    for (std::size_t n = 0; n < star.corner.size(); ++n) {
      const auto [a, b, c] = star.triangle(n);
      area += 0.5 * (b - a).cross(c - a).norm();
      for (int i = 0; i <= kParts; ++i)
        for (int j = 0; i + j <= kParts; ++j)
          nearest = std::min(nearest, (a + (b - a) * i / kParts + (c - a) * j / kParts - vector(p)).norm());
    }
    EXPECT_LE(crack.distance(p), nearest + 1e-12);
    EXPECT_GE(crack.distance(p), nearest - 1.8 / kParts);  // edges of triangles are below 1.8
    EXPECT_NEAR(crack.area(), area, 1e-12);
  }
}

TEST(PennyCrack, IsCrossedWithinItsRadius) {
  Random random(3);
  for (int trial = 0; trial < 3000; ++trial) {
    const PennyCrack penny{random_place(random, 0.3), random_place(random), random.between(0.1, 0.8)};
    const CrackSurface crack(penny);
    const Vector3d center = vector(penny.center), normal = vector(penny.normal).normalized();
    const Point a = random_place(random), b = random_place(random);
    const double above_a = (vector(a) - center).dot(normal), above_b = (vector(b) - center).dot(normal);
    const Vector3d meeting = (above_b * vector(a) - above_a * vector(b)) / (above_b - above_a);
    const bool expected = above_a * above_b < 0 && (meeting - center).norm() < penny.radius;
    EXPECT_EQ(crack.crosses(a, b, 1e-12), expected) << "trial " << trial;
    const double beyond = std::max(0.0, (vector(a) - center - above_a * normal).norm() - penny.radius);
    EXPECT_NEAR(crack.distance(a), std::hypot(above_a, beyond), 1e-12);
  }
  EXPECT_NEAR(CrackSurface(PennyCrack{{}, {0, 0, 3}, 2}).area(), 4 * std::numbers::pi, 1e-12);
}

TEST(TriangleCrack, IsCrossedWhereOneOfManyTrianglesIs) {
  Random random(4);
  Triangles ball = ball_surface(0.6, 4);
  ball.triangle.resize(ball.triangle.size() / 2);  // an open surface
  const CrackSurface crack(ball);
  ASSERT_EQ(crack.size(), 1024U);
  for (int trial = 0; trial < 500; ++trial) {
    const Point a = random_place(random), b = random_place(random);
    bool expected = false;
    double nearest = 1e9;
    for (const auto& [i, j, k] : ball.triangle) {
      expected = expected || hits({vector(ball.corner[i]), vector(ball.corner[j]), vector(ball.corner[k])},
                                  vector(a), vector(b));
      nearest = std::min(
          nearest, CrackSurface(PolygonCrack{{ball.corner[i], ball.corner[j], ball.corner[k]}}).distance(a));
    }
    EXPECT_EQ(crack.crosses(a, b, 1e-12), expected) << "trial " << trial;
    EXPECT_NEAR(crack.distance(a), nearest, 1e-12);
  }
}

TEST(CracksInSpace, AreNotCrossedByWhatTouches) {
  const CrackSurface square(PolygonCrack{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}});
  EXPECT_TRUE(square.crosses({0.5, 0.5, -1}, {0.5, 0.5, 1}, kTouch));
  EXPECT_FALSE(square.crosses({0.5, 0.5, 0}, {0.5, 0.5, 1}, kTouch));  // ends on it
  EXPECT_FALSE(square.crosses({0.5, 0.5, 0.5 * kTouch}, {0.5, 0.5, -1}, kTouch));
  EXPECT_FALSE(square.crosses({-1, 0.5, 0}, {2, 0.5, 0}, kTouch));     // runs along it
  EXPECT_TRUE(square.crosses({1, 0.5, -1}, {1, 0.5, 1}, kTouch));      // through an edge
  EXPECT_TRUE(square.crosses({0.5, 0.5, -1}, {1.5, 1.5, 1}, kTouch));  // through a corner
  EXPECT_FALSE(square.crosses({1 + 1e-6, 0.5, -1}, {1 + 1e-6, 0.5, 1}, kTouch));
  const CrackSurface penny(PennyCrack{{0, 0, 0}, {0, 0, 1}, 1});
  EXPECT_TRUE(penny.crosses({1, 0, -1}, {1, 0, 1}, kTouch));
  EXPECT_FALSE(penny.crosses({1 + 1e-6, 0, -1}, {1 + 1e-6, 0, 1}, kTouch));
  EXPECT_FALSE(penny.crosses({0, 0, 0}, {0, 0, 1}, kTouch));
}

TEST(PolygonCrack, IsRefusedWhereItIsNoFlatPolygon) {
  const auto message = [](std::vector<Point> corner) {
    try {
      const CrackSurface crack{PolygonCrack{std::move(corner)}};
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(message({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.01}, {0, 1, 0}}).find("is 0.005 m away from"),
            std::string::npos)
      << message({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.01}, {0, 1, 0}});
  EXPECT_EQ(message({{0, 0, 0}, {1, 0, 0}, {1, 1, 1e-8}, {0, 1, 0}}), "accepted");
  EXPECT_NE(message({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}).find("no area"), std::string::npos);
  EXPECT_NE(message({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 2, 0}}).find("crosses"), std::string::npos);
  EXPECT_NE(message({{0, 0, 0}, {1, 1, 0}}).find("three or more"), std::string::npos);
}

std::size_t bonds_between(const Body& body, const std::function<bool(const Point&)>& inside) {
  std::size_t count = 0;
  for (const std::size_t i : body.points)
    body.for_each_neighbour(i, [&](std::size_t j) {
      if (body.kind[j] == PointKind::body && inside(body.position(i)) != inside(body.position(j))) ++count;
    });
  return count;
}

std::size_t all_bonds(const Body& body) {
  std::size_t count = 0;
  for (const std::size_t i : body.points) count += body.family_size(i);
  return count;
}

// A loop around a part of a sheet, whose corners lie where bonds pass: it parts inside and outside, and no
// more.
TEST(PathCrack, PartsWhatItGoesAroundFromTheRest) {
  const std::vector<Point> corner{{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}};
  LatticeBodyInput in = sheet(20, 20, 0.1);
  const Body whole = make_lattice_body(in);
  for (std::size_t n = 0; n < 4; ++n) in.defects.cracks.push_back({corner[n], corner[(n + 1) % 4]});
  const auto inside = [](const Point& p) { return std::abs(p[0]) < 0.5 && std::abs(p[1]) < 0.5; };
  for (const Body& body : {make_lattice_body(in), listed(make_lattice_body(in))}) {
    EXPECT_EQ(bonds_between(body, inside), 0U);
    // Bonds between two outside points that pass through the square, or through its corner, are cut as well.
    std::size_t past = 0;
    for (const std::size_t i : whole.points)
      whole.for_each_neighbour(i, [&](std::size_t j) {
        const Point a = whole.position(i), b = whole.position(j);
        if (inside(a) || inside(b)) return;
        const auto part = chord(Shape(rectangle(0, 0, 0.5, 0.5)), a, b, -1e-9);
        past += part ? 1 : 0;
      });
    EXPECT_GT(past, 0U);
    EXPECT_EQ(all_bonds(whole) - all_bonds(body), bonds_between(whole, inside) + past);
  }
}

// A closed surface in a block does the same, on a lattice and in a list.
TEST(TriangleCrack, PartsABallFromTheBlockAroundIt) {
  LatticeBodyInput in = cells_of({12, 12, 12}, 2.3);
  in.defects.crack_surfaces.push_back(std::make_shared<const CrackSurface>(ball_surface(0.41, 4)));
  const Surface ball(ball_surface(0.41, 4));
  const auto inside = [&](const Point& p) {
    return vector(p).norm() < 0.409;
  };  // no point is near the surface
  const Body whole = make_lattice_body(cells_of({12, 12, 12}, 2.3));
  const Body body = make_lattice_body(in);
  EXPECT_GT(bonds_between(whole, inside), 1000U);
  EXPECT_EQ(bonds_between(body, inside), 0U);
  const Body list = listed(body);
  for (std::size_t n = 0; n < body.points.size(); ++n)
    EXPECT_EQ(body.family_size(body.points[n]), list.family_size(list.points[n]));
}

// A crack that ends at a mirrored face goes on behind it as its image: the lattice of the whole block has the
// same families.
TEST(CracksInSpace, AreReflectedAtMirroredFaces) {
  const auto families = [](int cells, double shift, bool both) {
    LatticeBodyInput in = cells_of({cells, 6, 6});
    if (!both) in.mirrored.set(0);
    for (const double side : {1.0, -1.0}) {
      if (side < 0 && !both) continue;
      // Slanted: it is at z = 0.02 where x, counted from the face, is 0 and at 0.22 where it is 0.4.
      PolygonCrack crack{{{0, -1, 0.02}, {0.4 * side, -1, 0.22}, {0.4 * side, 1, 0.22}, {0, 1, 0.02}}};
      for (Point& corner : crack.corner) corner[0] += shift;
      in.defects.crack_surfaces.push_back(std::make_shared<const CrackSurface>(crack));
    }
    return make_lattice_body(in);
  };
  const Body half = families(8, -0.4, false), whole = families(16, 0, true);
  ASSERT_EQ(2 * half.points.size(), whole.points.size());
  std::size_t cut = 0;
  for (const std::size_t i : half.points) {
    const Point x = half.position(i);
    const auto twin = std::find_if(whole.points.begin(), whole.points.end(), [&](std::size_t j) {
      const Point y = whole.position(j);
      return std::abs(y[0] - x[0] - 0.4) + std::abs(y[1] - x[1]) + std::abs(y[2] - x[2]) < 1e-6;
    });
    ASSERT_NE(twin, whole.points.end());
    EXPECT_EQ(half.family_size(i), whole.family_size(*twin));
    EXPECT_EQ(half.whole_family[i], whole.whole_family[*twin]);
    cut += half.whole_family[i] - half.family_size(i);
  }
  EXPECT_GT(cut, 100U);
}

TEST(BoxTree, FindsWhatLookingAtAllFinds) {
  Random random(5);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Bounds> boxes(static_cast<std::size_t>(random.integer(0, 60)));
    for (Bounds& box : boxes) {
      box.low = random_place(random);
      for (std::size_t k = 0; k < 3; ++k) box.high[k] = box.low[k] + random.between(0, 0.3);
    }
    const BoxTree tree(boxes);
    Bounds region{random_place(random), {}};
    for (std::size_t k = 0; k < 3; ++k) region.high[k] = region.low[k] + 0.3;
    std::vector<bool> asked(boxes.size(), false);
    EXPECT_FALSE(tree.any_in(region, [&](std::uint32_t n) {
      asked[n] = true;
      return false;
    }));
    const Point p = random_place(random, 2);
    double nearest = std::numeric_limits<double>::infinity();
    const auto middle = [&](std::uint32_t n) -> Vector3d {
      return (vector(boxes[n].low) + vector(boxes[n].high)) / 2;
    };
    for (std::uint32_t n = 0; n < boxes.size(); ++n) {
      bool meet = true;
      for (std::size_t k = 0; k < 3; ++k)
        meet = meet && boxes[n].low[k] <= region.high[k] && boxes[n].high[k] >= region.low[k];
      EXPECT_EQ(asked[n], meet);
      nearest = std::min(nearest, (middle(n) - vector(p)).norm());
    }
    EXPECT_EQ(tree.nearest(p, [&](std::uint32_t n) { return (middle(n) - vector(p)).norm(); }), nearest);
  }
}

}  // namespace
}  // namespace riven::testing
