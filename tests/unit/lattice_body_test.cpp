#include "body/lattice_body.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "base/error.hpp"
#include "support/bodies.hpp"

namespace riven::testing {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double total_volume(const Body& body) {
  return std::accumulate(body.volume.begin(), body.volume.end(), 0.0);
}

double area(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return 4 * box->half_size[0] * box->half_size[1];
  return std::numbers::pi * std::pow(std::get<Disc>(shape).radius, 2);
}

TEST(LatticeBody, HoldsTheVolumeOfTheSheetLessItsHoles) {
  const unsigned seed = 20240905;
  Random random(seed);
  for (int n = 0; n < 40; ++n) {
    LatticeBodyInput in = random_body(random, {.inclusions = false});
    std::erase_if(in.defects.holes, [](const Shape& hole) {  // a notch in the edge lies half outside
      const auto* disc = std::get_if<Disc>(&hole);
      return disc && disc->center[1] > 0.7;
    });
    double expected = area(in.shape);
    for (const Shape& hole : in.defects.holes) expected -= area(hole);
    expected *= in.thickness;
    // Rounding of some 400 additions; 7e-15 of the volume measured.
    EXPECT_NEAR(total_volume(make_lattice_body(in)), expected, 1e-13 * expected)
        << "seed " << seed << ", body " << n;
  }
}

TEST(LatticeBody, HoldsTheVolumeOfADisc) {
  for (const double spacing : {0.1, 0.07, 0.031}) {
    const Body body = make_lattice_body({.dimension = 2,
                                         .shape = Disc{{0.3, -0.2, 0}, 1},
                                         .thickness = 2,
                                         .spacing = spacing,
                                         .horizon = 3 * spacing,
                                         .defects = {{Disc{{0.3, -0.2, 0}, 0.33}}, {}, {}},
                                         .mirrored = {}});
    EXPECT_NEAR(total_volume(body), 2 * std::numbers::pi * (1 - 0.33 * 0.33), 1e-12);  // 3e-13 measured
    for (const std::size_t i : body.points) {
      const Point x = body.position(i);
      EXPECT_LT(std::hypot(x[0] - 0.3, x[1] + 0.2), 1 + spacing);
    }
  }
}

TEST(LatticeBody, ExistsInOneAndThreeDimensions) {
  const Body bar = make_lattice_body({.dimension = 1,
                                      .shape = Box{{1, 0, 0}, {0.5, infinity, infinity}},
                                      .thickness = 0.3,
                                      .spacing = 0.05,
                                      .horizon = 0.15,
                                      .defects = {},
                                      .mirrored = Faces(0b11)});
  EXPECT_EQ(bar.points.size(), 20U);
  EXPECT_NEAR(total_volume(bar), 0.3, 1e-15);
  EXPECT_EQ(bar.ghosts.size(), 6U);
  for (const std::size_t i : bar.points) EXPECT_EQ(bar.family_size(i), 6U);

  const Body block = make_lattice_body({.dimension = 3,
                                        .shape = Box{{0, 0, 1}, {0.4, 0.5, 0.35}},
                                        .thickness = 1,
                                        .spacing = 0.1,
                                        .horizon = 0.3,
                                        .defects = {},
                                        .mirrored = {}});
  EXPECT_EQ(block.points.size(), 8U * 10U * 7U);
  EXPECT_NEAR(total_volume(block), 0.8 * 1.0 * 0.7, 1e-14);
  EXPECT_EQ(block.family_size(block.on_lattice()->lattice.index({3, 4, 3})), 122U);
  EXPECT_EQ(block.family_size(block.on_lattice()->lattice.index({0, 4, 3})),
            122U - (122U - 28U) / 2U);  // half the ball and a disc
}

/// Whether the open segments a b and p q cross, by orientations; for places in general position only.
bool segments_cross(const Point& a, const Point& b, const Point& p, const Point& q) {
  const auto side = [](const Point& u, const Point& v, const Point& w) {
    return (v[0] - u[0]) * (w[1] - u[1]) - (v[1] - u[1]) * (w[0] - u[0]) > 0;
  };
  return side(a, b, p) != side(a, b, q) && side(p, q, a) != side(p, q, b);
}

TEST(LatticeBody, CutsExactlyTheBondsThatCrossASlit) {
  const unsigned seed = 20240906;
  Random random(seed);
  for (int n = 0; n < 30; ++n) {
    const Segment slit{{random.between(-0.6, 0.6), random.between(-0.6, 0.6), 0},
                       {random.between(-0.6, 0.6), random.between(-0.6, 0.6), 0}};
    const Body whole = make_lattice_body(sheet(14, 12, 0.1));
    const Body body = make_lattice_body(sheet(14, 12, 0.1, {}, {{}, {slit}, {}}));
    EXPECT_EQ(body.points, whole.points);
    for (const std::size_t i : body.points) {
      EXPECT_EQ(body.whole_family[i], whole.family_size(i));
      for (std::size_t k = 0; k < body.on_lattice()->stencil.size(); ++k) {
        const std::size_t j = BondPlanes::neighbour(body.on_lattice()->stencil, k, i);
        const bool crossed = segments_cross(slit.a, slit.b, body.position(i), body.position(j));
        EXPECT_EQ(body.on_lattice()->bonds.exists(k, i), whole.on_lattice()->bonds.exists(k, i) && !crossed)
            << "seed " << seed << ", slit " << n;
      }
    }
  }
}

TEST(LatticeBody, KeepsColumnsOnTheEdgesOfASlotWithHalfCells) {
  // The slot is one cell wide and its edges run through two columns of points.
  const double d = 0.1;
  const Box slot = rectangle(0, 0, 0.5 * d, 2.5 * d);
  const Body body = make_lattice_body(sheet(12, 12, d, {}, {{slot}, {}, {}}));
  const Lattice& lattice = body.on_lattice()->lattice;
  EXPECT_EQ(body.points.size(), 144U);
  for (int j = 0; j < 12; ++j) {
    const double y = lattice.position(Cell{0, j, 0})[1];
    // Rows at 0.05, 0.15 lie beside the slot, the slot ends in the middle of the cells at 0.25.
    const double covered = std::abs(y) < 2 * d ? 0.5 : std::abs(y) < 3 * d ? 0.25 : 0;
    for (const int i : {5, 6})
      EXPECT_NEAR(body.volume[lattice.index({i, j, 0})], (1 - covered) * d * d * 0.7, 1e-15);
  }
  for (const std::size_t i : body.points)
    for (std::size_t k = 0; k < body.on_lattice()->stencil.size(); ++k) {
      const std::size_t n = BondPlanes::neighbour(body.on_lattice()->stencil, k, i);
      if (body.kind[n] != PointKind::body) continue;
      const Point x = lattice.position(i), y = lattice.position(n);
      if (std::abs(x[0] - y[0]) < 1e-9) {
        EXPECT_TRUE(body.on_lattice()->bonds.exists(k, i)) << "a bond along the edge";
      } else if (x[0] * y[0] < 0 && std::max(std::abs(x[1]), std::abs(y[1])) < 2.5 * d - 1e-9) {
        EXPECT_FALSE(body.on_lattice()->bonds.exists(k, i)) << "a bond across the slot";
      }
    }
}

TEST(LatticeBody, HasBondsBothWaysAndNoneIntoNothing) {
  const unsigned seed = 20240907;
  Random random(seed);
  for (int n = 0; n < 20; ++n) {
    const Body body = make_lattice_body(random_body(random));
    for (std::size_t i = 0; i < body.size(); ++i)
      for (std::size_t k = 0; k < body.on_lattice()->stencil.size(); ++k) {
        if (!body.on_lattice()->bonds.exists(k, i)) continue;
        const std::size_t j = BondPlanes::neighbour(body.on_lattice()->stencil, k, i);
        ASSERT_TRUE(body.on_lattice()->bonds.exists(body.on_lattice()->stencil.opposite[k], j))
            << "seed " << seed;
        const bool body_end = body.kind[i] == PointKind::body || body.kind[j] == PointKind::body;
        ASSERT_TRUE(body_end && body.kind[i] != PointKind::outside && body.kind[i] != PointKind::rigid);
      }
    for (const std::size_t i : body.points)
      for (const InterfaceBond& bond : body.interface_of(i)) {
        EXPECT_EQ(bond.point, i);
        EXPECT_NEAR(signed_distance(body.defects.inclusions[bond.inclusion], bond.end), 0, 1e-9);
        body.for_each_neighbour(i, [&](std::size_t j) { EXPECT_NE(bond.neighbour, j); });
      }
  }
}

TEST(LatticeBody, MirrorsItsGhosts) {
  const double d = 0.1;
  const Body body = make_lattice_body(sheet(9, 7, d, all_edges()));
  EXPECT_EQ(body.ghosts.size(), static_cast<std::size_t>(15 * 13 - 9 * 7));
  const std::array<double, 4> face = {-0.45, 0.45, -0.35, 0.35};
  for (const GhostPoint& ghost : body.ghosts) {
    const Point x = body.position(ghost.point), m = body.position(ghost.master);
    EXPECT_EQ(body.kind[ghost.point], PointKind::ghost);
    EXPECT_EQ(body.kind[ghost.master], PointKind::body);
    for (std::size_t a = 0; a < 2; ++a) {
      double image = x[a];
      for (std::size_t side = 0; side < 2; ++side) {
        const double plane = face[2 * a + side];
        const bool beyond = side == 0 ? x[a] < plane : x[a] > plane;
        EXPECT_EQ(ghost.faces.test(2 * a + side), beyond);
        if (beyond) image = 2 * plane - x[a];
      }
      EXPECT_NEAR(m[a], image, 1e-15);
    }
  }
  for (const std::size_t i : body.points) EXPECT_EQ(body.family_size(i), 28U);
}

TEST(LatticeBody, RefusesWhatItCannotBe) {
  EXPECT_THROW(make_lattice_body(sheet(5, 5, 0.1, {}, {{rectangle(0, 0, 1, 1)}, {}, {}})), InputError);
  LatticeBodyInput uneven = sheet(10, 10, 0.1, Faces(0b10));
  uneven.spacing = 0.13;
  EXPECT_THROW(make_lattice_body(uneven), InputError);
}

}  // namespace
}  // namespace riven::testing
