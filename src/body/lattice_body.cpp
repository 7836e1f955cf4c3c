#include "body/lattice_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "body/bond_rules.hpp"

namespace riven {

namespace {

// Rule 3 of the peridynamics theory, 5a: half-covered cells are kept.
constexpr double kKeptFraction = 0.5 - 1e-9;

struct Bounds {
  Point lower{}, upper{};
};

Bounds bounds_of(const Shape& shape, int dimension) {
  Bounds b;
  const auto grow = [&](const Point& center, const Point& half) {
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
      b.lower[a] = center[a] - half[a];
      b.upper[a] = center[a] + half[a];
    }
  };
  if (const auto* box = std::get_if<Box>(&shape)) grow(box->center, box->half_size);
  if (const auto* disc = std::get_if<Disc>(&shape)) grow(disc->center, {disc->radius, disc->radius, 0});
  if (const auto* ball = std::get_if<Ball>(&shape))
    grow(ball->center, {ball->radius, ball->radius, ball->radius});
  return b;
}

/// The lattice is centred on the body; it ends at its faces when the spacing divides the size.
Lattice make_lattice(const LatticeBodyInput& in) {
  const Bounds b = bounds_of(in.shape, in.dimension);
  std::array<int, 3> cells{1, 1, 1};
  Point first{};
  for (std::size_t a = 0; a < static_cast<std::size_t>(in.dimension); ++a) {
    const double size = b.upper[a] - b.lower[a];
    cells[a] = std::max(1, static_cast<int>(std::ceil(size / in.spacing - 1e-6)));
    first[a] = 0.5 * (b.lower[a] + b.upper[a]) - 0.5 * (cells[a] - 1) * in.spacing;
    for (std::size_t side = 0; side < 2; ++side)
      if (in.mirrored.test(2 * a + side) && std::abs(cells[a] * in.spacing - size) > 1e-6 * in.spacing)
        throw InputError(fmt::format(
            "a load on the edge \"{}\" needs points that end there: the spacing {:g} m does not divide the "
            "size "
            "{:g} m; the nearest one that does is {:g} m",
            kFaceNames[2 * a + side], in.spacing, size, size / std::max(1.0, std::round(size / in.spacing))));
  }
  const int reach = stencil_reach(in.horizon, in.spacing);
  std::array<int, 3> layers{};  // of ghosts, where there are any
  for (std::size_t a = 0; a < 3; ++a)
    if (in.mirrored.test(2 * a) || in.mirrored.test(2 * a + 1)) layers[a] = reach;
  return {in.dimension, cells, in.spacing, first, reach, layers};
}

/// Kinds and volumes of the body's own cells.
class CellFiller {
 public:
  CellFiller(const LatticeBodyInput& in, const Lattice& lattice, Body& body)
      : in_(in), lattice_(lattice), body_(body) {}

  void fill() {
    const BondRules rules(body_);
    const double cell_volume = std::pow(in_.spacing, in_.dimension) * in_.thickness;
    std::vector<std::pair<Cell, double>> removed;  // cells below one half, with the volume they held
    lattice_.for_each_cell([&](const Cell& cell, std::size_t i) {
      if (!lattice_.inside(cell)) return;
      const Point x = lattice_.position(cell);
      const double fraction = material_fraction(cell, x);
      if (const auto inclusion = rules.rigid_inclusion(x)) {
        body_.kind[i] = PointKind::rigid;
        body_.rigid_points[*inclusion].push_back(i);
      } else if (fraction >= kKeptFraction) {
        body_.kind[i] = PointKind::body;
        body_.volume[i] = std::min(fraction, 1.0) * cell_volume;
      }
      if (body_.kind[i] != PointKind::body && fraction > 0)
        removed.emplace_back(cell, fraction * cell_volume);
    });
    for (const auto& [cell, volume] : removed) share_with_nearest(cell, volume);
  }

 private:
  double material_fraction(const Cell& cell, const Point& x) {
    // A surface is asked once for each row.
    if (in_.surface != nullptr && cell[0] == 0)
      row_ = in_.surface->covered_fractions(x, in_.spacing, lattice_.cells()[0]);
    double fraction = in_.surface != nullptr ? row_[static_cast<std::size_t>(cell[0])]
                                             : covered_fraction(in_.shape, x, in_.spacing, in_.dimension);
    for (const auto* shapes : {&in_.defects.holes, &in_.defects.inclusions})
      for (const Shape& shape : *shapes) fraction -= covered_fraction(shape, x, in_.spacing, in_.dimension);
    return fraction;
  }

  /// Gives the volume of a removed cell to the nearest kept one, in equal parts where several are as near.
  void share_with_nearest(const Cell& cell, double volume) {
    std::vector<std::size_t> nearest;
    int best = std::numeric_limits<int>::max();
    const int reach = 3;
    const auto along = [&](int axis) { return axis < in_.dimension ? reach : 0; };
    for (int k = -along(2); k <= along(2); ++k)
      for (int j = -along(1); j <= along(1); ++j)
        for (int i = -along(0); i <= along(0); ++i) {
          const Cell other{cell[0] + i, cell[1] + j, cell[2] + k};
          if (!lattice_.inside(other)) continue;
          const std::size_t index = lattice_.index(other);
          const int distance = i * i + j * j + k * k;
          if (body_.kind[index] != PointKind::body || distance > best) continue;
          if (distance < best) nearest.clear();
          best = distance;
          nearest.push_back(index);
        }
    for (const std::size_t index : nearest)
      body_.volume[index] += volume / static_cast<double>(nearest.size());
  }

  const LatticeBodyInput& in_;
  const Lattice& lattice_;
  Body& body_;
  std::vector<double> row_;  // parts of the cells of a row that a surface covers
};

/// Reflections that bring a ghost cell into the body, or nothing if a face in between has no ghosts.
std::optional<std::pair<Cell, Faces>> reflect_inside(const Lattice& lattice, const Faces& mirrored,
                                                     Cell cell) {
  Faces faces;
  for (std::size_t a = 0; a < 3; ++a) {
    const bool below = cell[a] < 0;
    if (!below && cell[a] < lattice.cells()[a]) continue;
    const std::size_t face = 2 * a + (below ? 0 : 1);
    if (!mirrored.test(face)) return std::nullopt;
    faces.set(face);
    cell[a] = below ? -1 - cell[a] : 2 * lattice.cells()[a] - 1 - cell[a];
  }
  return lattice.inside(cell) ? std::make_optional(std::make_pair(cell, faces)) : std::nullopt;
}

void make_ghosts(const Faces& mirrored, const Lattice& lattice, Body& body) {
  lattice.for_each_cell([&](const Cell& cell, std::size_t i) {
    if (lattice.inside(cell)) return;
    const auto image = reflect_inside(lattice, mirrored, cell);
    if (!image) return;
    const std::size_t master = lattice.index(image->first);
    if (body.kind[master] != PointKind::body) return;
    body.kind[i] = PointKind::ghost;
    body.ghosts.push_back({i, master, image->second});
  });
}

/// Faces behind which a cell lies.
Faces faces_before(const Lattice& lattice, const Cell& cell) {
  Faces faces;
  for (std::size_t a = 0; a < 3; ++a) {
    faces.set(2 * a, cell[a] < 0);
    faces.set(2 * a + 1, cell[a] >= lattice.cells()[a]);
  }
  return faces;
}

class BondMaker {
 public:
  BondMaker(Body& body, LatticeBonds& bonds)
      : body_(body), rules_(body), lattice_(bonds.lattice), stencil_(bonds.stencil), planes_(bonds.bonds) {}

  void make() {
    for (const std::size_t i : body_.points) {
      const Cell cell = lattice_.cell(i);
      const Point x = lattice_.position(cell);
      const bool near_defect = rules_.near_defect(x);
      std::size_t family = 0;
      for (std::size_t k = 0; k < stencil_.size(); ++k)
        family += make_bond(i, cell, x, k, near_defect) ? 1 : 0;
      body_.complete[i] = family == stencil_.size();
    }
  }

 private:
  bool make_bond(std::size_t i, const Cell& cell, const Point& x, std::size_t k, bool near_defect) {
    const Cell& o = stencil_.offset[k];
    const Cell other{cell[0] + o[0], cell[1] + o[1], cell[2] + o[2]};
    if (!lattice_.stored(other)) return false;
    const std::size_t j = BondPlanes::neighbour(stencil_, k, i);
    if (body_.kind[j] == PointKind::outside) return false;
    BondRules::Bond bond;
    if (near_defect)
      bond = rules_.between(x, lattice_.position(other), body_.kind[j], faces_before(lattice_, other));
    if (bond.verdict == BondRules::Verdict::none) return false;
    ++body_.whole_family[i];
    if (bond.verdict == BondRules::Verdict::cracked) return false;
    if (bond.verdict == BondRules::Verdict::interface) {
      const double volume = std::pow(body_.spacing, body_.dimension) * body_.thickness;
      body_.interface.push_back({i, j, bond.inclusion, bond.end, volume});
    } else {
      planes_.join(stencil_, k, i);
    }
    return true;
  }

  Body& body_;
  BondRules rules_;
  const Lattice& lattice_;
  const Stencil& stencil_;
  BondPlanes& planes_;
};

}  // namespace

Body make_lattice_body(const LatticeBodyInput& input) {
  LatticeBonds grid;
  grid.lattice = make_lattice(input);
  grid.stencil = make_stencil(grid.lattice, input.horizon);
  const std::size_t size = grid.lattice.size();
  grid.bonds = BondPlanes(grid.stencil.size(), size);
  Body body;
  body.dimension = input.dimension;
  body.spacing = input.spacing;
  body.horizon = input.horizon;
  body.thickness = input.thickness;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    body.faces[2 * axis] = grid.lattice.position(Cell{0, 0, 0})[axis] - 0.5 * input.spacing;
    body.faces[2 * axis + 1] = body.faces[2 * axis] + grid.lattice.cells()[axis] * input.spacing;
  }
  body.defects = input.defects;
  body.kind.assign(size, PointKind::outside);
  body.volume.assign(size, 0.0);
  body.whole_family.assign(size, 0);
  body.complete.assign(size, false);
  body.rigid_points.resize(input.defects.inclusions.size());

  CellFiller(input, grid.lattice, body).fill();
  for (std::size_t i = 0; i < size; ++i)
    if (body.kind[i] == PointKind::body) body.points.push_back(i);
  if (body.points.empty()) throw InputError("nothing is left of the body: holes and inclusions cover it");
  make_ghosts(input.mirrored, grid.lattice, body);
  BondMaker(body, grid).make();
  body.bonds = std::move(grid);
  return body;
}

}  // namespace riven
