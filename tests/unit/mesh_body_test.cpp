#include "fem/mesh_body.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "support/finite_element_bodies.hpp"

namespace riven::testing {
namespace {

double sum_of(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0);
}

/// Shape functions are 1 at their node and 0 at the others, and sum up to 1; slopes are their derivatives.
template <class E>
void expect_shape_functions(const std::vector<Eigen::Matrix<double, E::D, 1>>& nodes, Random& random) {
  for (int a = 0; a < E::N; ++a) {
    const auto f = E::at(nodes[static_cast<std::size_t>(a)]);
    for (int b = 0; b < E::N; ++b) EXPECT_NEAR(f.value(b), a == b ? 1 : 0, 1e-15);
  }
  Eigen::Matrix<double, E::D, 1> x;
  for (int d = 0; d < E::D; ++d) x(d) = random.between(0, 0.3);
  EXPECT_NEAR(E::at(x).value.sum(), 1, 1e-15);
  for (int d = 0; d < E::D; ++d) {
    auto ahead = x, behind = x;
    ahead(d) += 1e-5;
    behind(d) -= 1e-5;
    EXPECT_LT(((E::at(ahead).value - E::at(behind).value) / 2e-5 - E::at(x).slope.col(d)).norm(), 1e-10);
  }
}

TEST(Elements, HaveShapeFunctions) {
  Random random(1);
  using V2 = Eigen::Vector2d;
  using V3 = Eigen::Vector3d;
  expect_shape_functions<T3>({V2(0, 0), V2(1, 0), V2(0, 1)}, random);
  expect_shape_functions<Q4>({V2(-1, -1), V2(1, -1), V2(1, 1), V2(-1, 1)}, random);
  expect_shape_functions<Q8>(
      {V2(-1, -1), V2(1, -1), V2(1, 1), V2(-1, 1), V2(0, -1), V2(1, 0), V2(0, 1), V2(-1, 0)}, random);
  expect_shape_functions<T4>({V3(0, 0, 0), V3(1, 0, 0), V3(0, 1, 0), V3(0, 0, 1)}, random);
  expect_shape_functions<H8>({V3(-1, -1, -1), V3(1, -1, -1), V3(1, 1, -1), V3(-1, 1, -1), V3(-1, -1, 1),
                              V3(1, -1, 1), V3(1, 1, 1), V3(-1, 1, 1)},
                             random);
}

TEST(MeshBody, FillsItsBoxAndEndsOnItsFaces) {
  for (const ElementShape shape : element_shapes()) {
    const bool in_space = dimension_of(shape) == 3;
    const Box box{{1, 2, 3}, {2, 0.5, 1}};
    const MeshBody mesh = make_mesh(shape, in_space ? std::vector{3, 2, 4} : std::vector{3, 2}, 0.1,
                                    box_map(box, in_space ? 3 : 2));
    check_elements(mesh);
    EXPECT_NEAR(sum_of(mesh.lumped_volumes()), in_space ? 8 : 0.4, 1e-12);  // sums of hundreds
    const std::array<double, 6> areas{2, 2, 8, 8, 4, 4};
    for (std::size_t face = 0; face < (in_space ? 6U : 4U); ++face) {
      const double at = box.center[face / 2] + (face % 2 == 0 ? -1 : 1) * box.half_size[face / 2];
      const double area = in_space ? areas[face] : 0.1 * (face < 2 ? 1 : 4);
      EXPECT_NEAR(mesh.face_area(face), area, 1e-14) << name_of(shape) << face;
      Eigen::Vector3d moment = Eigen::Vector3d::Zero();
      for (const NodeShare& share : mesh.face_shares(face)) {
        const Eigen::Vector3d x(mesh.node[share.node].data());
        EXPECT_NEAR(x(static_cast<Eigen::Index>(face / 2)), at, 1e-15);
        moment += share.extent * x;
      }
      Eigen::Vector3d centre(box.center.data());
      centre(static_cast<Eigen::Index>(face / 2)) = at;
      if (!in_space) centre(2) = 0;
      EXPECT_LT((moment - area * centre).norm(), 1e-13);
    }
    if (!in_space) {
      EXPECT_EQ(mesh.face_area(4), 0);
    }
  }
}

// Simpson's rule on the edge of an eight-node element.
TEST(MeshBody, SharesTractionsConsistently) {
  const MeshBody mesh = make_mesh(ElementShape::q8, {1, 1}, 2, [](const Point& x) { return x; });
  std::vector<double> extents;
  for (const NodeShare& share : mesh.face_shares(1)) extents.push_back(share.extent);
  std::sort(extents.begin(), extents.end());
  ASSERT_EQ(extents.size(), 3U);
  EXPECT_NEAR(extents[0], 2.0 / 6, 1e-15);
  EXPECT_NEAR(extents[1], 2.0 / 6, 1e-15);
  EXPECT_NEAR(extents[2], 2 * 4.0 / 6, 1e-15);
}

TEST(MeshBody, SharesVolumesConsistently) {
  Random random(3);
  for (const ElementShape shape : element_shapes()) {
    const MeshBody mesh = distorted(shape, random, false);
    std::vector<std::size_t> all(mesh.elements());
    std::iota(all.begin(), all.end(), std::size_t{0});
    double volume = 0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (const NodeShare& share : mesh.volume_shares(all)) {
      volume += share.extent;
      moment += share.extent * Eigen::Vector3d(mesh.node[share.node].data());
    }
    const double whole = dimension_of(shape) == 3 ? 1 : 0.7;
    EXPECT_NEAR(volume, whole, 1e-13);
    // Exact for what the rule integrates: a linear function on simplices and, on these, products with J.
    EXPECT_LT((moment / whole - Eigen::Vector3d(0.5, 0.5, dimension_of(shape) == 3 ? 0.5 : 0)).norm(), 1e-2);
  }
}

TEST(MeshBody, IsAnArch) {
  const Arch arch{100, 10, 2};
  const double radius = (50 * 50 + 10 * 10) / 20.0, half = std::asin(50 / radius);
  const auto map = arch_map(arch);
  EXPECT_NEAR(map({0, 0.5, 0})[0], -50, 1e-12);
  EXPECT_NEAR(map({0, 0.5, 0})[1], 0, 1e-12);
  EXPECT_NEAR(map({0.5, 0.5, 0})[1], 10, 1e-12);
  EXPECT_NEAR(map({0.5, 1, 0})[1], 11, 1e-12);
  double error = 1;
  for (const int n : {8, 16}) {
    const MeshBody mesh = make_mesh(ElementShape::q8, {n, 2}, 0.5, map);
    check_elements(mesh);
    const double next = std::abs(sum_of(mesh.lumped_volumes()) / (0.5 * 2 * 2 * half * radius) - 1);
    EXPECT_LT(next, error / 14);  // parabolas through points of a circle: fourth order
    error = next;
    EXPECT_NEAR(mesh.face_area(0), 0.5 * 2, 1e-12);
    EXPECT_NEAR(mesh.face_area(3), 0.5 * 2 * half * (radius + 1), 1e-5);
  }
}

TEST(MeshBody, IsAQuadrilateral) {
  const MeshBody mesh = make_mesh(ElementShape::q4, {4, 3}, 1,
                                  quadrilateral_map({Point{0, 0, 0}, {48, 44, 0}, {48, 60, 0}, {0, 44, 0}}));
  check_elements(mesh);
  EXPECT_NEAR(sum_of(mesh.lumped_volumes()), 48 * (44 + 16) / 2.0, 1e-11);
  EXPECT_NEAR(mesh.face_area(1), 16, 1e-12);
  EXPECT_NEAR(mesh.face_area(0), 44, 1e-12);
}

TEST(MeshBody, FindsTheElementThatHoldsAPlace) {
  Random random(4);
  for (const ElementShape shape : element_shapes()) {
    const MeshBody mesh = distorted(shape, random, false);
    const bool in_space = dimension_of(shape) == 3;
    for (int n = 0; n < 50; ++n) {
      const Point place{random.between(0, 1), random.between(0, 1), in_space ? random.between(0, 1) : 0};
      const auto found = locate(mesh, place);
      ASSERT_TRUE(found) << name_of(shape) << place[0] << " " << place[1];
      Eigen::Vector3d there = Eigen::Vector3d::Zero();
      for (std::size_t a = 0; a < found->value.size(); ++a)
        there += found->value[a] * Eigen::Vector3d(mesh.node[mesh.nodes(found->element)[a]].data());
      EXPECT_LT((there - Eigen::Vector3d(place.data())).norm(), 1e-9);
      EXPECT_GT(*std::min_element(found->value.begin(), found->value.end()),
                -0.26);  // inside; quadratic ones dip
    }
    EXPECT_TRUE(locate(mesh, {1, 1, in_space ? 1.0 : 0.0}));
    EXPECT_FALSE(locate(mesh, {1.01, 0.5, 0.5}));
    EXPECT_FALSE(locate(mesh, {-5, 0.5, 0.5}));
  }
}

}  // namespace
}  // namespace riven::testing
