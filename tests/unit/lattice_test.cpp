#include "geometry/lattice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/lanes.hpp"
#include "body/bond_planes.hpp"
#include "body/stencil.hpp"
#include "support/random.hpp"

namespace riven::testing {
namespace {

Lattice lattice_of(int dimension, double spacing = 0.1, int reach = 3) {
  const std::array<std::array<int, 3>, 3> cells{{{17, 1, 1}, {13, 9, 1}, {6, 5, 7}}};
  return {dimension, cells[static_cast<std::size_t>(dimension - 1)],
          spacing,   Point{-0.3, 0.2, 0.5},
          reach,     {reach, dimension > 1 ? reach : 0, dimension > 2 ? reach : 0}};
}

TEST(Lattice, IndicesAndCellsAreOneToOne) {
  for (int dimension = 1; dimension <= 3; ++dimension) {
    const Lattice lattice = lattice_of(dimension);
    EXPECT_EQ(lattice.size() % kLanes, 0U);
    std::set<std::size_t> seen;
    std::size_t inside = 0;
    lattice.for_each_cell([&](const Cell& cell, std::size_t i) {
      ASSERT_LT(i, lattice.size());
      EXPECT_TRUE(seen.insert(i).second);
      EXPECT_TRUE(seen.empty() || *seen.rbegin() == i) << "storage order";
      EXPECT_EQ(lattice.cell(i), cell);
      EXPECT_EQ(lattice.index(cell), i);
      EXPECT_TRUE(lattice.stored(cell));
      inside += lattice.inside(cell) ? 1 : 0;
    });
    const auto [nx, ny, nz] = lattice.cells();
    EXPECT_EQ(inside, static_cast<std::size_t>(nx * ny * nz));
    EXPECT_EQ(seen.size(), static_cast<std::size_t>((nx + 6) * (dimension > 1 ? ny + 6 : 1) *
                                                    (dimension > 2 ? nz + 6 : 1)));
  }
}

TEST(Lattice, PlacesCellsFromTheFirst) {
  const Lattice lattice = lattice_of(3);
  const Point p = lattice.position(Cell{2, -1, 4});
  EXPECT_NEAR(p[0], -0.1, 1e-15);
  EXPECT_NEAR(p[1], 0.1, 1e-15);
  EXPECT_NEAR(p[2], 0.9, 1e-15);
  const Point flat = lattice_of(2).position(Cell{0, 0, 0});
  EXPECT_EQ(flat[2], 0);
  EXPECT_FALSE(lattice.stored(Cell{-4, 0, 0}));
  EXPECT_FALSE(lattice.stored(Cell{0, 8, 0}));
  EXPECT_FALSE(lattice.inside(Cell{0, 0, -1}));
}

TEST(Lattice, ShiftsDoNotDependOnTheCell) {
  for (int dimension = 1; dimension <= 3; ++dimension) {
    const Lattice lattice = lattice_of(dimension);
    const Stencil stencil = make_stencil(lattice, 0.3);
    lattice.for_each_cell([&](const Cell& cell, std::size_t i) {
      if (!lattice.inside(cell)) return;
      for (std::size_t k = 0; k < stencil.size(); ++k) {
        const Cell& o = stencil.offset[k];
        const Cell other{cell[0] + o[0], cell[1] + o[1], cell[2] + o[2]};
        ASSERT_TRUE(lattice.stored(other));
        EXPECT_EQ(BondPlanes::neighbour(stencil, k, i), lattice.index(other));
      }
    });
  }
}

TEST(Lattice, LeavesRoomForWholeVectorsAtEveryNeighbour) {
  for (int dimension = 1; dimension <= 3; ++dimension) {
    const Lattice lattice = lattice_of(dimension);
    const Stencil stencil = make_stencil(lattice, 0.3);
    for (std::size_t row = 0; row < lattice.rows(); ++row) {
      EXPECT_EQ(lattice.row_begin(row) % kLanes, 0U);
      for (const std::ptrdiff_t shift : stencil.shift) {
        const auto first = static_cast<std::ptrdiff_t>(lattice.row_begin(row)) + shift;
        EXPECT_GE(first, 0);
        EXPECT_LE(first + static_cast<std::ptrdiff_t>(lattice.row_length()),
                  static_cast<std::ptrdiff_t>(lattice.size()));
      }
    }
  }
}

std::size_t neighbours(int dimension, double spacing, double horizon) {
  return make_stencil(lattice_of(dimension, spacing, stencil_reach(horizon, spacing)), horizon).size();
}

TEST(Stencil, CountsTheNeighboursWithinTheHorizon) {
  // Lattice points within 3 spacings: 6 on a line, 28 in the plane, 122 in space; 3.015 and 3 with rounding
  // are the same.
  Random random(20240903);
  for (int n = 0; n < 200; ++n) {
    const double spacing = n == 0 ? 0.1 : n == 1 ? 0.1 / 3 : n == 2 ? 0.5 / 30 : random.between(1e-4, 10);
    for (const double horizon :
         {3 * spacing, 3.015 * spacing, spacing + spacing + spacing, 0.3 * (spacing / 0.1),
          3 * spacing * (1 - 4e-16), 3 * spacing * (1 + 4e-16)}) {
      EXPECT_EQ(neighbours(1, spacing, horizon), 6U) << spacing;
      EXPECT_EQ(neighbours(2, spacing, horizon), 28U) << spacing;
      EXPECT_EQ(neighbours(3, spacing, horizon), 122U) << spacing;
    }
  }
  EXPECT_EQ(neighbours(2, 0.1 / 3, 0.1), 28U);
  EXPECT_EQ(neighbours(2, 0.1, 0.1), 4U);
  EXPECT_EQ(neighbours(2, 0.1, 0.15), 8U);
  EXPECT_EQ(neighbours(2, 0.1, 0.2), 12U);
  EXPECT_EQ(neighbours(2, 0.1, 0.299), 24U);
}

TEST(Stencil, IsSymmetric) {
  for (int dimension = 1; dimension <= 3; ++dimension) {
    const Stencil stencil = make_stencil(lattice_of(dimension), 0.3);
    for (std::size_t k = 0; k < stencil.size(); ++k) {
      const std::size_t o = stencil.opposite[k];
      EXPECT_EQ(stencil.opposite[o], k);
      EXPECT_EQ(stencil.shift[o], -stencil.shift[k]);
      double square = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_EQ(stencil.offset[o][a], -stencil.offset[k][a]);
        EXPECT_DOUBLE_EQ(stencil.bond[k][a], 0.1 * stencil.offset[k][a]);
        square += stencil.bond[k][a] * stencil.bond[k][a];
      }
      EXPECT_DOUBLE_EQ(stencil.length[k], std::sqrt(square));
    }
    EXPECT_TRUE(std::is_sorted(stencil.shift.begin(), stencil.shift.end()));
  }
}

TEST(BondPlanes, JoinAndCutBothEndsAndNothingElse) {
  const Lattice lattice = lattice_of(2);
  const Stencil stencil = make_stencil(lattice, 0.3);
  BondPlanes bonds(stencil.size(), lattice.size());
  std::set<std::pair<std::size_t, std::size_t>> expected;
  const unsigned seed = 20240904;
  Random random(seed);
  for (int n = 0; n < 2000; ++n) {
    const auto k = static_cast<std::size_t>(random.integer(0, static_cast<int>(stencil.size()) - 1));
    const std::size_t i = lattice.index({random.integer(0, 12), random.integer(0, 8), 0});
    const std::size_t j = BondPlanes::neighbour(stencil, k, i);
    if (random.chance(0.6)) {
      bonds.join(stencil, k, i);
      expected.insert({k, i});
      expected.insert({stencil.opposite[k], j});
    } else {
      bonds.cut(stencil, k, i);
      expected.erase({k, i});
      expected.erase({stencil.opposite[k], j});
    }
  }
  for (std::size_t k = 0; k < stencil.size(); ++k)
    for (std::size_t i = 0; i < lattice.size(); ++i) {
      const bool is = expected.contains({k, i});
      ASSERT_EQ(bonds.exists(k, i), is) << "seed " << seed;
      ASSERT_EQ((bonds.masks(i / kLanes)[k] >> (i % kLanes) & 1) != 0, is);
    }
}

}  // namespace
}  // namespace riven::testing
