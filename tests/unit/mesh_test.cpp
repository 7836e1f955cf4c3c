// Elements: what they cover, where their centre is, which sides of a box they fill.

#include "geometry/mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <map>

#include "support/meshes.hpp"
#include "support/random.hpp"

namespace riven::testing {
namespace {

Eigen::Vector3d vector(const Point& p) {
  return {p[0], p[1], p[2]};
}

TEST(ElementMeasure, IsThatOfTheUnitElements) {
  const std::map<ElementKind, std::pair<double, Point>> exact = {
      {ElementKind::triangle, {0.5, {1.0 / 3, 1.0 / 3, 0}}},
      {ElementKind::quadrangle, {1, {0.5, 0.5, 0}}},
      {ElementKind::tetrahedron, {1.0 / 6, {0.25, 0.25, 0.25}}},
      {ElementKind::hexahedron, {1, {0.5, 0.5, 0.5}}},
      {ElementKind::prism, {0.5, {1.0 / 3, 1.0 / 3, 0.5}}},
      {ElementKind::pyramid, {1.0 / 3, {0.375, 0.375, 0.25}}},  // apex over the corner (0, 0)
  };
  for (const auto& [kind, expected] : exact) {
    const Mesh mesh = unit_element(kind);
    const ElementMeasure found = measure(mesh, mesh.blocks[0], 0);
    EXPECT_NEAR(found.size, expected.first, 1e-15) << name_of(kind);
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR(found.centroid[a], expected.second[a], 1e-15) << name_of(kind);
    EXPECT_TRUE(found.one_sided);
  }
}

TEST(ElementMeasure, FollowsAffineMaps) {
  Random random(1);
  for (int n = 0; n < 200; ++n)
    for (const ElementKind kind : kBodyKinds) {
      Mesh mesh = unit_element(kind);
      const ElementMeasure unit = measure(mesh, mesh.blocks[0], 0);
      Eigen::Matrix3d map = Eigen::Matrix3d::NullaryExpr([&] { return random.between(-2, 2); });
      if (dimension_of(kind) == 2)
        map = (Eigen::Matrix3d() << map.topLeftCorner<2, 2>(), Eigen::Vector2d::Zero(), 0, 0, 1).finished();
      const Eigen::Vector3d shift(random.between(-100, 100), random.between(-100, 100), 0);
      for (Point& x : mesh.node) {
        const Eigen::Vector3d to = map * vector(x) + shift;
        x = {to[0], to[1], to[2]};
      }
      const ElementMeasure found = measure(mesh, mesh.blocks[0], 0);
      const double scale = std::abs(map.determinant());
      if (scale < 0.05) continue;  // nearly flat: rounding of the shift counts for more
      // Turned over by a map with a negative determinant. Coordinates near 100 carry 1e-14.
      EXPECT_NEAR(found.size, map.determinant() * unit.size, 1e-11);
      EXPECT_EQ(found.size > 0, map.determinant() > 0);
      EXPECT_TRUE(found.one_sided);
      const Eigen::Vector3d centre = map * vector(unit.centroid) + shift;
      EXPECT_LT((vector(found.centroid) - centre).norm(), 1e-10) << name_of(kind);
    }
}

TEST(ElementMeasure, OfSkewQuadranglesIsThatOfTheirTriangles) {
  Random random(2);
  for (int n = 0; n < 200; ++n) {
    Mesh mesh = unit_element(ElementKind::quadrangle);
    for (Point& x : mesh.node)
      for (std::size_t a = 0; a < 2; ++a) x[a] += random.between(-0.2, 0.2);
    const ElementMeasure found = measure(mesh, mesh.blocks[0], 0);
    double area = 0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (const auto& [b, c] : {std::pair(1, 2), std::pair(2, 3)}) {
      const Eigen::Vector3d p = vector(mesh.node[0]), q = vector(mesh.node[static_cast<std::size_t>(b)]),
                            r = vector(mesh.node[static_cast<std::size_t>(c)]);
      const double part = 0.5 * (q - p).cross(r - p)[2];
      area += part;
      moment += part * (p + q + r) / 3;
    }
    EXPECT_NEAR(found.size, area, 1e-14);
    EXPECT_LT((vector(found.centroid) - moment / area).norm(), 1e-14);
  }
}

TEST(ElementMeasure, OfSkewHexahedraIsThatOfTheirTetrahedra) {
  // The top is made smaller or larger and shifted in its plane: all sides stay plane, so that tetrahedra fill
  // the element exactly.
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    Mesh mesh = unit_element(ElementKind::hexahedron);
    const double size = random.between(0.3, 1.7), x = random.between(-0.4, 0.4),
                 y = random.between(-0.4, 0.4);
    for (Point& p : mesh.node)
      if (p[2] == 1) p = {size * p[0] + x, size * p[1] + y, 1};
    double volume = 0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    const auto at = [&](std::size_t corner) { return vector(mesh.node[corner]); };
    // Six tetrahedra around the diagonal from corner 0 to corner 6.
    constexpr std::array<std::size_t, 7> around = {1, 2, 3, 7, 4, 5, 1};
    for (std::size_t t = 0; t < 6; ++t) {
      const Eigen::Vector3d a = at(0), b = at(around[t]), c = at(around[t + 1]), d = at(6);
      const double part = (b - a).dot((c - a).cross(d - a)) / 6;
      volume += part;
      moment += part * (a + b + c + d) / 4;
    }
    const ElementMeasure found = measure(mesh, mesh.blocks[0], 0);
    EXPECT_NEAR(found.size, volume, 1e-14);
    EXPECT_LT((vector(found.centroid) - moment / volume).norm(), 1e-14);
  }
}

TEST(ElementMeasure, TellsWhatIsTurnedOverOrFolded) {
  for (const ElementKind kind : kBodyKinds) {
    Mesh mesh = unit_element(kind);
    for (Point& x : mesh.node) x[0] = -x[0];
    const ElementMeasure turned = measure(mesh, mesh.blocks[0], 0);
    EXPECT_LT(turned.size, 0) << name_of(kind);
    EXPECT_TRUE(turned.one_sided) << name_of(kind);
  }
  Mesh bow = unit_element(ElementKind::quadrangle);
  std::swap(bow.blocks[0].node[2], bow.blocks[0].node[3]);
  EXPECT_FALSE(measure(bow, bow.blocks[0], 0).one_sided);
  Mesh twisted = unit_element(ElementKind::hexahedron);  // positive in all, turned over in one corner
  twisted.node[6] = {0.2, 0.2, 0.2};
  EXPECT_GT(measure(twisted, twisted.blocks[0], 0).size, 0);
  EXPECT_FALSE(measure(twisted, twisted.blocks[0], 0).one_sided);
  Mesh flat = unit_element(ElementKind::tetrahedron);
  flat.node[3][2] = 0;
  EXPECT_EQ(measure(flat, flat.blocks[0], 0).size, 0);
}

TEST(Mesh, FillsItsBox) {
  for (unsigned seed = 1; seed <= 20; ++seed)
    for (const ElementKind kind : kBodyKinds) {
      Random random(seed);
      const std::array<int, 3> cells = {random.integer(1, 5), random.integer(1, 4), random.integer(1, 3)};
      Mesh mesh = box_mesh(kind, cells, 0.15, random);
      const double depth = dimension_of(kind) == 2 ? 1 : cells[2];
      double volume = 0;
      Point moment{};
      for (std::size_t n = 0; n < mesh.blocks[0].size(); ++n) {
        const ElementMeasure found = measure(mesh, mesh.blocks[0], n);
        EXPECT_GT(found.size, 0);
        volume += found.size;
        for (std::size_t a = 0; a < 3; ++a) moment[a] += found.size * found.centroid[a];
      }
      // Rounding of sums of 360 elements of size 1 at most.
      EXPECT_NEAR(volume, cells[0] * cells[1] * depth, 1e-12) << name_of(kind);
      EXPECT_NEAR(moment[0] / volume, 0.5 * cells[0], 1e-12);
      EXPECT_NEAR(moment[1] / volume, 0.5 * cells[1], 1e-12);
      EXPECT_NEAR(moment[2] / volume, dimension_of(kind) == 2 ? 0 : 0.5 * cells[2], 1e-12);

      const Box box = box_around(mesh);
      for (std::size_t a = 0; a < static_cast<std::size_t>(dimension_of(kind)); ++a) {
        EXPECT_EQ(box.half_size[a], 0.5 * cells[a]);
        EXPECT_EQ(box.center[a], 0.5 * cells[a]);
      }
      const std::array<bool, 6> filled = filled_faces(mesh, box);
      for (std::size_t face = 0; face < 6; ++face)
        EXPECT_EQ(filled[face], face < 2 * static_cast<std::size_t>(dimension_of(kind)))
            << name_of(kind) << face;
      // Without its last element the corner at the upper ends is open, and nothing else.
      const std::size_t corners = corners_of(kind), last = mesh.blocks[0].size() - 1;
      if (kind != ElementKind::quadrangle && kind != ElementKind::hexahedron) continue;
      if (cells[0] < 2 || cells[1] < 2 || depth < (dimension_of(kind) == 2 ? 1 : 2)) continue;
      mesh.blocks[0].number.resize(last);
      mesh.blocks[0].node.resize(last * corners);
      const std::array<bool, 6> open = filled_faces(mesh, box);
      for (std::size_t face = 0; face < 2 * static_cast<std::size_t>(dimension_of(kind)); ++face)
        EXPECT_EQ(open[face], face % 2 == 0) << name_of(kind) << face;
    }
}

}  // namespace
}  // namespace riven::testing
