#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "body/lattice_body.hpp"
#include "support/random.hpp"

namespace riven::testing {

inline Box rectangle(double x, double y, double half_x, double half_y) {
  return {{x, y, 0}, {half_x, half_y, std::numeric_limits<double>::infinity()}};
}

inline Faces all_edges() {
  return Faces(0b1111);
}

/// A sheet of nx times ny cells centred at the origin, with a horizon of three cells.
inline LatticeBodyInput sheet(int nx, int ny, double spacing, Faces mirrored = {}, Defects defects = {}) {
  return {.dimension = 2,
          .shape = rectangle(0, 0, 0.5 * nx * spacing, 0.5 * ny * spacing),
          .thickness = 0.7,
          .spacing = spacing,
          .horizon = 3 * spacing,
          .defects = std::move(defects),
          .mirrored = mirrored};
}

struct RandomBodyOptions {
  bool inclusions = true;
  bool ghosts = true;
};

/// A sheet of about 20 x 18 cells with, in each quarter by chance: a hole, a slot, slits, an inclusion;
/// perhaps a notch in an edge; some edges mirrored.
inline LatticeBodyInput random_body(Random& random, const RandomBodyOptions& options = {}) {
  const double d = 0.1;
  LatticeBodyInput in = sheet(random.integer(18, 22), random.integer(16, 20), d);
  const auto place = [&](int x, int y) {
    return Point{x * 4.6 * d + random.between(-0.5, 0.5) * d, y * 4.2 * d + random.between(-0.5, 0.5) * d, 0};
  };
  if (random.chance(0.7)) in.defects.holes.emplace_back(Disc{place(1, 1), random.between(0.6, 2.4) * d});
  if (random.chance(0.6)) {
    const Point c = place(-1, -1);
    in.defects.holes.emplace_back(
        rectangle(c[0], c[1], random.between(0.2, 0.8) * d, random.between(1, 2.4) * d));
  }
  for (int slits = random.integer(0, 4); slits > 0; --slits) {  // they may cross
    const Point c = place(-1, 1);
    const double angle = random.between(0, 3.2), half = random.between(0.7, 2.4) * d;
    const Point along{half * std::cos(angle), half * std::sin(angle), 0};
    in.defects.cracks.push_back(
        {{c[0] - along[0], c[1] - along[1], 0}, {c[0] + along[0], c[1] + along[1], 0}});
  }
  if (options.inclusions && random.chance(0.7)) {
    const Point c = place(1, -1);
    if (random.chance(0.5)) {
      in.defects.inclusions.emplace_back(Disc{c, random.between(0.8, 2.2) * d});
    } else {
      in.defects.inclusions.emplace_back(
          rectangle(c[0], c[1], random.between(0.7, 2) * d, random.between(0.7, 2) * d));
    }
  }
  if (options.ghosts)
    for (std::size_t face = 0; face < 4; ++face) in.mirrored.set(face, random.chance(0.5));
  if (!in.mirrored.test(3) && random.chance(0.5)) {
    const double top = std::get<Box>(in.shape).half_size[1];
    in.defects.holes.emplace_back(
        Disc{{random.between(-0.5, 0.5) * d, top, 0}, random.between(0.6, 1.8) * d});
  }
  return in;
}

}  // namespace riven::testing
