// How far cracks have grown, where they go and how many ends they have, on sheets with cracks that are known.

#include "body/crack_paths.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "body/crack_extent.hpp"
#include "body/fragments.hpp"
#include "support/cracked_bodies.hpp"
#include "support/pmb_bodies.hpp"

namespace riven::testing {
namespace {

constexpr double kSpacing = 0.1;

LatticeBodyInput plate(int nx, int ny, double horizon_in_cells = 3) {
  LatticeBodyInput in = sheet(nx, ny, kSpacing);
  in.horizon = horizon_in_cells * kSpacing;
  return in;
}

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

// The damage far behind the tip of a long straight crack, row by row, against the share of the family beyond
// it; and the default threshold lies between the first two rows at every usual horizon, and along diagonals.
TEST(CrackDamage, DefaultThresholdTakesTheRowsBesideTheCrack) {
  for (const double horizon : {2.0, 3.0, 4.0, 5.0})
    for (const bool diagonal : {false, true}) {
      const Segment crack = diagonal ? Segment{{-3, -3.05, 0}, {3, 2.95, 0}} : Segment{{-3, 0, 0}, {3, 0, 0}};
      const CrackedSheet sheet(plate(40, 40, horizon), {}, {crack});
      const std::vector<double> damage = damages(sheet.after);
      const double threshold = share_beyond(2, 0.75 / horizon);
      for (std::size_t n = 0; n < damage.size(); ++n) {
        const Point x = sheet.after.position(sheet.after.points[n]);
        if (std::abs(x[0]) > 1 || std::abs(x[1]) > 1) continue;
        EXPECT_EQ(damage[n] >= threshold, distance(crack, x) < kSpacing)
            << "horizon " << horizon << ", " << distance(crack, x) / kSpacing << " spacings away, lost "
            << damage[n];
      }
    }
}

TEST(CrackDamage, ShareBeyondIsThatOfADiscOrBall) {
  // Against sums over fine nets of cells.
  for (const double x : {0.0, 0.2, 0.5, 0.9}) {
    double inside = 0, beyond = 0, inside3 = 0, beyond3 = 0;
    for (double z = -0.995; z < 1; z += 0.01)
      for (double y = -0.995; y < 1; y += 0.01) {
        const double chord = 1 - z * z - y * y;
        if (chord <= 0) continue;
        inside += 1;
        inside3 += 2 * std::sqrt(chord);
        if (z > x) beyond += 1;
        if (z > x) beyond3 += 2 * std::sqrt(chord);
      }
    EXPECT_NEAR(share_beyond(2, x), beyond / inside, 0.003);
    EXPECT_NEAR(share_beyond(3, x), beyond3 / inside3, 0.003);
    EXPECT_DOUBLE_EQ(share_beyond(1, x), 0.5 * (1 - x));
  }
}

// A crack that grows along the lattice from a cut in the edge: length and area within one spacing.
TEST(CrackLength, IsThatOfAStraightCrack) {
  Random random(7);
  for (int trial = 0; trial < 40; ++trial) {
    const double horizon = random.between(2, 4.5), tip = random.between(-1.5, -0.5);
    const double grown = random.between(0, 2.2);
    const CrackedSheet sheet(plate(50, 24, horizon), {{{-2.5, 0, 0}, {tip, 0, 0}}},
                             {{{tip, 0, 0}, {tip + grown, 0, 0}}}, random.chance(0.3));
    const CrackPaths paths = sheet.paths();
    EXPECT_NEAR(paths.length(), grown, kSpacing * 1.0001) << "horizon " << horizon << ", from " << tip;
    EXPECT_NEAR(sheet.area() / sheet.after.thickness, grown, kSpacing) << "horizon " << horizon;
    if (paths.length() == 0) continue;
    // The tip is where a point has lost enough, which is behind where the last bond is cut.
    ASSERT_TRUE(paths.tip());
    EXPECT_NEAR((*paths.tip())[1], 0, 1e-9);
    EXPECT_LT((*paths.tip())[0], tip + grown + 1e-9);
    EXPECT_GT((*paths.tip())[0], tip + grown - 2 * kSpacing - 0.5 * horizon * kSpacing);
    if (grown < 1) continue;
    ASSERT_TRUE(paths.angle(0.4, 10));
    EXPECT_NEAR(*paths.angle(0.4, 10), 0, 1e-9);
  }
}

// In any direction: steps of a path are at most 2.8 % too long, and the lattice's steps show at both ends.
TEST(CrackLength, IsThatOfASlantedCrack) {
  Random random(8);
  for (int trial = 0; trial < 60; ++trial) {
    const double angle = random.between(-1.4, 1.4), grown = random.between(0.8, 2.2);
    const Point tip{-1 + random.between(0, kSpacing), random.between(0, kSpacing), 0};
    const CrackedSheet sheet(plate(60, 60, random.between(3, 4)), {{{-3, tip[1], 0}, tip}},
                             {{tip, from(tip, angle, grown)}});
    const CrackPaths paths = sheet.paths();
    EXPECT_NEAR(paths.length(), grown, 0.028 * grown + 1.5 * kSpacing) << degrees(angle);
    EXPECT_NEAR(sheet.area() / sheet.after.thickness, grown, 0.06 * grown + kSpacing) << degrees(angle);
    EXPECT_EQ(paths.ends(6 * kSpacing), 1);
    ASSERT_TRUE(paths.angle(0.3, 2));
    // The direction is as uncertain as one spacing over what is left behind the first horizon and the tip.
    EXPECT_NEAR(*paths.angle(0.3, 2), angle, kSpacing / (grown - 0.4)) << grown;
  }
}

TEST(CrackLength, IsNothingWithoutGrowth) {
  const CrackedSheet sheet(plate(40, 20), {{{-2, 0, 0}, {0, 0, 0}}}, {});
  EXPECT_EQ(sheet.paths().length(), 0);
  EXPECT_EQ(sheet.area(), 0);
  EXPECT_EQ(sheet.paths().ends(0), 0);
  EXPECT_FALSE(sheet.paths().tip());
  EXPECT_FALSE(sheet.paths().angle(0, 1));
}

// More broken bonds never make a crack shorter, as long as it grows along one line.
TEST(CrackLength, GrowsWithTheCrack) {
  double length = 0, area = 0;
  for (int step = 0; step <= 40; ++step) {
    const CrackedSheet sheet(plate(50, 24), {{{-2.5, 0, 0}, {-1, 0, 0}}},
                             {{{-1, 0, 0}, {-1 + 0.05 * step, 0, 0}}});
    EXPECT_GE(sheet.paths().length(), length);
    EXPECT_GE(sheet.area(), area);
    length = sheet.paths().length();
    area = sheet.area();
  }
  EXPECT_GT(length, 1.8);
}

// Beside an old crack, cracks that are not connected to it do not count, until it reaches them.
TEST(CrackLength, LeavesOutWhatTheOldCrackHasNotReached) {
  const Segment old{{-3, 0, 0}, {-1, 0, 0}}, grown{{-1, 0, 0}, {0, 0, 0}}, link{{0, 0, 0}, {0.6, 0, 0}},
      apart{{0.6, 0, 0}, {2.8, 0, 0}};
  const CrackedSheet two(plate(60, 24), {old}, {grown, apart});
  EXPECT_NEAR(two.paths().length(), 1, kSpacing);
  EXPECT_EQ(two.paths().ends(0.6), 1);
  EXPECT_NEAR((*two.paths().tip())[0], 0, 2.5 * kSpacing);
  EXPECT_NEAR(two.area() / two.after.thickness, 3.2, 2 * kSpacing);
  const CrackedSheet one(plate(60, 24), {old}, {grown, link, apart});
  EXPECT_NEAR(one.paths().length(), 3.8, 1.5 * kSpacing);
}

// Without an old crack: what starts at an edge begins there, and ends inside.
TEST(CrackLength, OfACrackFromAnEdgeBeginsThere) {
  for (const bool from_right : {false, true}) {
    const double side = from_right ? 1 : -1;
    const CrackedSheet sheet(plate(50, 24), {}, {{{side * 2.5, 0, 0}, {side * 1, 0, 0}}});
    const CrackPaths paths = sheet.paths();
    EXPECT_NEAR(paths.length(), 1.5, 1.5 * kSpacing);
    EXPECT_LT(std::abs((*paths.tip())[0] - side * 1), 2 * kSpacing);
    // It begins in one of the two rows beside it, so that the other row has other distances.
    EXPECT_NEAR(std::abs(degrees(*paths.angle(0.3, 2))), from_right ? 180 : 0, 2);
    EXPECT_EQ(paths.ends(6 * kSpacing), 1);
  }
}

// A crack inside that is stored from its middle on is as long as both of its arms.
TEST(CrackLength, OfACrackInsideGoesFromEndToEnd) {
  const Point apex{0.02, -1.01, 0};
  const CrackedSheet sheet(plate(60, 60), {}, {{apex, from(apex, 0.8, 1.6)}, {apex, from(apex, 2.3, 1.2)}});
  // Without an old crack both tips lag behind, each by up to half a horizon, and the path cuts the corner.
  EXPECT_GT(sheet.paths().length(), 2.8 - 0.3 - kSpacing);
  EXPECT_LT(sheet.paths().length(), 2.8);
  EXPECT_EQ(sheet.paths().ends(0.6), 1);
}

// Forks of different angles and lengths; ragged edges, which are shorter than the least length, do not count.
TEST(CrackBranches, AreTheEndsOfAFork) {
  Random random(9);
  for (int trial = 0; trial < 60; ++trial) {
    const Point tip{-1.5, random.between(-0.05, 0.05), 0}, fork = from(tip, 0, random.between(0.3, 1));
    const double up = random.between(0.35, 0.9), down = -random.between(0.35, 0.9);
    const double long_one = random.between(1.75, 2), short_one = random.between(1.3, 1.6);
    std::vector<Segment> grown{
        {tip, fork}, {fork, from(fork, up, long_one)}, {fork, from(fork, down, short_one)}};
    const int teeth = random.integer(0, 4);
    for (int n = 0; n < teeth; ++n) {  // short side cracks
      const Point root = from(fork, up, random.between(0.9, 1.2));
      grown.push_back({root, from(root, up + 1.5, 0.25)});
    }
    const CrackedSheet sheet(plate(70, 60), {{{-3.5, tip[1], 0}, tip}}, grown, random.chance(0.2));
    const CrackPaths paths = sheet.paths();
    EXPECT_EQ(paths.ends(6 * kSpacing), 2)
        << "trial " << trial << ": " << degrees(up) << ", " << degrees(down);
    EXPECT_NEAR(paths.length(), fork[0] - tip[0] + long_one, 0.3);
    // Broken bonds count all branches, but those that cross two cracks less than a horizon apart once: half
    // of them up to 0.3 / (2 sin 20 deg) from the fork, and most of the teeth's.
    const double all = fork[0] - tip[0] + long_one + short_one;
    EXPECT_GT(sheet.area() / sheet.after.thickness, all - 0.44);
    EXPECT_LT(sheet.area() / sheet.after.thickness, 1.06 * (all + 0.25 * teeth));
    const double tip_error = std::hypot((*paths.tip())[0] - from(fork, up, long_one)[0],
                                        (*paths.tip())[1] - from(fork, up, long_one)[1]);
    EXPECT_LT(tip_error, 0.3);
  }
}

TEST(CrackBranches, CountBothEndsOfAnOldCrack) {
  const CrackedSheet sheet(plate(60, 24), {{{-0.5, 0, 0}, {0.5, 0, 0}}},
                           {{{0.5, 0, 0}, {1.6, 0, 0}}, {{-0.5, 0, 0}, {-2, 0, 0}}});
  EXPECT_EQ(sheet.paths().ends(0.6), 2);
  EXPECT_EQ(sheet.paths().ends(1.3), 1);
  EXPECT_EQ(sheet.paths().ends(2), 0);
  EXPECT_NEAR(sheet.paths().length(), 1.5, kSpacing);
  EXPECT_NEAR(std::abs(degrees(*sheet.paths().angle(0.3, 1))), 180, 1e-6);
}

// A kink: the angle of the first part is that of the part.
TEST(CrackAngle, IsThatOfThePartNearTheBeginning) {
  const Point tip{-1, 0.02, 0}, kink = from(tip, 1.18, 1.2);
  const CrackedSheet sheet(plate(60, 60), {{{-3, 0.02, 0}, tip}},
                           {{tip, kink}, {kink, from(kink, 0.2, 1.5)}});
  EXPECT_NEAR(degrees(*sheet.paths().angle(0.3, 1.1)), degrees(1.18), 4);
  EXPECT_LT(degrees(*sheet.paths().angle(0.3, 10)), 55);
}

// In three dimensions, areas: of a flat crack along the lattice, and of a penny where its rim is a small
// part.
TEST(CrackArea, IsThatOfASquareInABlock) {
  LatticeBodyInput in = cells_of({16, 16, 10});
  const Body before = make_lattice_body(in);
  in.defects.crack_surfaces.push_back(std::make_shared<const CrackSurface>(
      PolygonCrack{{{-0.8, -0.8, 0}, {0.3, -0.8, 0}, {0.3, 0.8, 0}, {-0.8, 0.8, 0}}}));
  const Body after = make_lattice_body(in);
  std::vector<std::size_t> all(after.points.size());
  std::iota(all.begin(), all.end(), 0U);
  EXPECT_NEAR(crack_area(after, crack_depth(after), all, damages(before), damages(after)), 1.1 * 1.6,
              0.1 * 1.6);
  const std::size_t upper = all.size() / 2;
  const std::vector<std::size_t> half(all.begin() + static_cast<std::ptrdiff_t>(upper), all.end());
  EXPECT_NEAR(crack_area(after, crack_depth(after), half, damages(before), damages(after)), 0.5 * 1.1 * 1.6,
              0.05 * 1.6);
}

// ---- fragments ----

TEST(Fragments, OfAnIntactBodyAreOne) {
  for (const int dimension : {1, 2, 3}) {
    const Body body = make_lattice_body(cells_of(std::vector<int>(static_cast<std::size_t>(dimension), 9)));
    for (const Body& one : {body, listed(body)}) {
      const Fragments fragments = find_fragments(one);
      EXPECT_EQ(fragments.points, std::vector<std::size_t>{one.points.size()});
      EXPECT_EQ(fragments.count(4), 1);
      EXPECT_EQ(fragments.number, std::vector<std::uint32_t>(one.points.size(), 1));
    }
  }
}

TEST(Fragments, OfOneSizeAreNumberedByTheirFirstPoint) {
  LatticeBodyInput in = sheet(12, 10, kSpacing);
  for (int n = -4; n <= 4; ++n) {
    in.defects.cracks.push_back({{n * 2 * kSpacing, -1, 0}, {n * 2 * kSpacing, 1, 0}});
    in.defects.cracks.push_back({{-1, (n * 2 + 1) * kSpacing, 0}, {1, (n * 2 + 1) * kSpacing, 0}});
  }
  const Body body = make_lattice_body(in);
  const Fragments fragments = find_fragments(body);
  EXPECT_EQ(fragments.points, std::vector<std::size_t>(30, 4));
  EXPECT_EQ(fragments.count(4), 30);
  EXPECT_EQ(fragments.count(5), 0);
  std::uint32_t seen = 0;
  for (const std::uint32_t number : fragments.number) {
    EXPECT_LE(number, seen + 1);
    seen = std::max(seen, number);
  }
}

// Random cuts right through: against a plain search from point to point.
TEST(Fragments, AreWhatASearchFinds) {
  Random random(10);
  for (int trial = 0; trial < 40; ++trial) {
    LatticeBodyInput in = random_body(random, {.inclusions = random.chance(0.5)});
    for (int cut = random.integer(0, 4); cut > 0; --cut) {
      const double angle = random.between(0, 3.1);
      const Point middle{random.between(-0.7, 0.7), random.between(-0.7, 0.7), 0};
      in.defects.cracks.push_back({from(middle, angle, -4), from(middle, angle, 4)});
    }
    const Body body = random.chance(0.5) ? make_lattice_body(in) : listed(make_lattice_body(in));
    const Fragments fragments = find_fragments(body);
    ASSERT_EQ(fragments.number.size(), body.points.size() + body.rigid_points.size());

    std::vector<int> found(body.size() + body.rigid_points.size(), 0);
    std::vector<std::size_t> sizes;
    const auto search = [&](std::size_t start) {
      std::vector<std::size_t> open{start};
      found[start] = static_cast<int>(sizes.size()) + 1;
      std::size_t size = 0;
      while (!open.empty()) {
        const std::size_t at = open.back();
        open.pop_back();
        ++size;
        const auto reach = [&](std::size_t next) {
          if (found[next] != 0) return;
          found[next] = static_cast<int>(sizes.size()) + 1;
          open.push_back(next);
        };
        if (at < body.size()) {
          body.for_each_neighbour(at, [&](std::size_t j) {
            if (body.kind[j] == PointKind::body) reach(j);
          });
          for (const InterfaceBond& bond : body.interface_of(at)) reach(body.size() + bond.inclusion);
        } else {
          for (const InterfaceBond& bond : body.interface)
            if (body.size() + bond.inclusion == at) reach(bond.point);
        }
      }
      sizes.push_back(size);
    };
    std::vector<std::size_t> nodes = body.points;
    for (std::size_t n = 0; n < body.rigid_points.size(); ++n) nodes.push_back(body.size() + n);
    for (const std::size_t node : nodes)
      if (found[node] == 0) search(node);
    // The same parts, numbered by their size and then by their first point.
    std::vector<int> order(sizes.size());
    std::iota(order.begin(), order.end(), 1);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return sizes[static_cast<std::size_t>(a - 1)] > sizes[static_cast<std::size_t>(b - 1)];
    });
    for (std::size_t n = 0; n < nodes.size(); ++n) EXPECT_EQ(order[fragments.number[n] - 1], found[nodes[n]]);
    std::sort(sizes.rbegin(), sizes.rend());
    EXPECT_EQ(fragments.points, sizes);
    EXPECT_EQ(fragments.count(4),
              std::count_if(sizes.begin(), sizes.end(), [](std::size_t s) { return s >= 4; }));
  }
}

}  // namespace
}  // namespace riven::testing
