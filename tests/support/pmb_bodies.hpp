#pragma once

#include <limits>
#include <vector>

#include "body/lattice_body.hpp"
#include "body/listed_body.hpp"
#include "peridynamics/pmb.hpp"
#include "support/instruction_sets.hpp"
#include "support/random.hpp"

namespace riven::testing {

/// A box of so many cells of 0.1 m about the origin, in 1, 2 or 3 dimensions.
inline LatticeBodyInput cells_of(std::vector<int> cells, double horizon_in_cells = 3, Faces mirrored = {}) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  LatticeBodyInput in;
  in.dimension = static_cast<int>(cells.size());
  Box box{{}, {endless, endless, endless}};
  for (std::size_t a = 0; a < cells.size(); ++a) box.half_size[a] = 0.05 * cells[a];
  in.shape = box;
  in.thickness = in.dimension == 3 ? 1 : 0.02;
  in.spacing = 0.1;
  in.horizon = horizon_in_cells * in.spacing;
  in.mirrored = mirrored;
  return in;
}

/// A bar, sheet or block of random size and horizon, perhaps with a hole, a slit, mirrored faces.
inline LatticeBodyInput random_cells(Random& random, int dimension, bool mirrored) {
  std::vector<int> cells;
  for (int a = 0; a < dimension; ++a)
    cells.push_back(random.integer(dimension == 3 ? 7 : 9, dimension == 3 ? 11 : 23));
  LatticeBodyInput in = cells_of(cells, random.between(1, dimension == 3 ? 3.2 : 4.2));
  if (dimension > 1 && random.chance(0.7)) {
    const Point center{random.between(-0.1, 0.1), random.between(-0.1, 0.1), 0};
    if (dimension == 2) in.defects.holes.emplace_back(Disc{center, random.between(0.1, 0.25)});
    if (dimension == 3) in.defects.holes.emplace_back(Ball{center, random.between(0.1, 0.25)});
  }
  if (dimension == 2 && random.chance(0.5)) in.defects.cracks.push_back({{-0.4, 0.31, 0}, {0.3, 0.35, 0}});
  for (std::size_t face = 0; mirrored && face < 2 * static_cast<std::size_t>(dimension); ++face)
    in.mirrored.set(face, random.chance(0.4));
  return in;
}

inline constexpr PmbSettings kGlass{.youngs_modulus = 72e9, .density = 2440};

/// Stored points that are body or ghost.
inline std::vector<std::size_t> bonded_points(const Body& body) {
  std::vector<std::size_t> points = body.points;
  for (const GhostPoint& ghost : body.ghosts) points.push_back(ghost.point);
  return points;
}

/// Displacements of all points, ghosts independently: a smooth part and noise, in spacings.
inline std::vector<double> random_displacements(const PointModel& model, Random& random, double size) {
  const Body& body = model.body();
  std::vector<double> u(model.dofs(), 0.0);
  for (std::size_t d = 0; d < static_cast<std::size_t>(body.dimension); ++d) {
    const Point k{random.between(-3, 3), random.between(-3, 3), random.between(-3, 3)};
    for (const std::size_t i : bonded_points(body)) {
      const Point x = body.position(i);
      u[d * body.size() + i] =
          size * body.spacing * (std::sin(k[0] * x[0] + k[1] * x[1] + k[2] * x[2]) + random.between(-1, 1));
    }
  }
  return u;
}

}  // namespace riven::testing
