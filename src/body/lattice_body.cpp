#include "body/lattice_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace riven {

namespace {

// Rules of the peridynamics theory, 5a: half-covered cells are kept (3), rigid points reach a little beyond
// the surface so that the bonds that cross it keep a length (4).
constexpr double kKeptFraction = 0.5 - 1e-9;
constexpr double kRigidMargin = 0.15;
constexpr double kTouch = 1e-9;  // of the spacing: below it, touching is no crossing

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
  return {in.dimension, cells, in.spacing, first, stencil_reach(in.horizon, in.spacing)};
}

/// Kinds and volumes of the body's own cells.
class CellFiller {
 public:
  CellFiller(const LatticeBodyInput& in, LatticeBody& body) : in_(in), body_(body) {}

  void fill() {
    const double cell_volume = std::pow(in_.spacing, in_.dimension) * in_.thickness;
    std::vector<std::pair<Cell, double>> removed;  // cells below one half, with the volume they held
    body_.lattice.for_each_cell([&](const Cell& cell, std::size_t i) {
      if (!body_.lattice.inside(cell)) return;
      const Point x = body_.lattice.position(cell);
      const double fraction = material_fraction(x);
      if (const auto inclusion = rigid_inclusion(x)) {
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
  [[nodiscard]] std::optional<std::size_t> rigid_inclusion(const Point& x) const {
    for (std::size_t n = 0; n < in_.defects.inclusions.size(); ++n)
      if (signed_distance(in_.defects.inclusions[n], x) < kRigidMargin * in_.spacing) return n;
    return std::nullopt;
  }

  [[nodiscard]] double material_fraction(const Point& x) const {
    double fraction = covered_fraction(in_.shape, x, in_.spacing, in_.dimension);
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
          if (!body_.lattice.inside(other)) continue;
          const std::size_t index = body_.lattice.index(other);
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
  LatticeBody& body_;
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

void make_ghosts(const Faces& mirrored, LatticeBody& body) {
  body.lattice.for_each_cell([&](const Cell& cell, std::size_t i) {
    if (body.lattice.inside(cell)) return;
    const auto image = reflect_inside(body.lattice, mirrored, cell);
    if (!image) return;
    const std::size_t master = body.lattice.index(image->first);
    if (body.kind[master] != PointKind::body) return;
    body.kind[i] = PointKind::ghost;
    body.ghosts.push_back({i, master, image->second});
  });
}

/// Position of x after the reflections that take a ghost at `cell` into the body.
Point mirror_image(const Lattice& lattice, const Cell& ghost, const Point& x) {
  Point image = x;
  for (std::size_t a = 0; a < 3; ++a) {
    const double lower = lattice.position(Cell{0, 0, 0})[a] - 0.5 * lattice.spacing();
    if (ghost[a] < 0) image[a] = 2 * lower - x[a];
    if (ghost[a] >= lattice.cells()[a])
      image[a] = 2 * (lower + lattice.cells()[a] * lattice.spacing()) - x[a];
  }
  return image;
}

class BondMaker {
 public:
  explicit BondMaker(LatticeBody& body)
      : body_(body),
        holes_{body.defects.holes, {}, {}},
        cracks_{{}, body.defects.cracks, {}},
        touch_(kTouch * body.lattice.spacing()) {}

  void make() {
    for (const std::size_t i : body_.points) {
      const Cell cell = body_.lattice.cell(i);
      const Point x = body_.lattice.position(cell);
      const bool near_defect = body_.defects.distance_to_edge(x) <= 2 * body_.horizon || near_face(cell);
      for (std::size_t k = 0; k < body_.stencil.size(); ++k) make_bond(i, cell, x, k, near_defect);
    }
  }

 private:
  // A bond to a ghost may touch the mirror image of a defect, which the distance to the defect does not tell.
  [[nodiscard]] bool near_face(const Cell& cell) const {
    for (int a = 0; a < body_.lattice.dimension(); ++a) {
      const auto axis = static_cast<std::size_t>(a);
      if (cell[axis] < body_.lattice.reach(a) ||
          cell[axis] >= body_.lattice.cells()[axis] - body_.lattice.reach(a))
        return true;
    }
    return false;
  }

  void make_bond(std::size_t i, const Cell& cell, const Point& x, std::size_t k, bool near_defect) {
    const Cell& o = body_.stencil.offset[k];
    const Cell other{cell[0] + o[0], cell[1] + o[1], cell[2] + o[2]};
    const std::size_t j = BondPlanes::neighbour(body_.stencil, k, i);
    const PointKind kind = body_.kind[j];
    if (kind == PointKind::outside) return;
    const Point y = body_.lattice.position(other);
    if (near_defect) {
      if (meets_inclusion(i, x, y, k) || kind == PointKind::rigid) return;
      if (cut_by(holes_, x, y, other)) return;
      ++body_.whole_family[i];
      if (cut_by(cracks_, x, y, other)) return;
    } else {
      ++body_.whole_family[i];
    }
    body_.bonds.join(body_.stencil, k, i);
  }

  [[nodiscard]] bool cut_by(const Defects& defects, const Point& x, const Point& y, const Cell& other) const {
    if (defects.cuts(x, y, touch_)) return true;
    if (body_.lattice.inside(other)) return false;
    const auto image = [&](const Point& p) { return mirror_image(body_.lattice, other, p); };
    return defects.cuts(image(x), image(y), touch_);
  }

  /// Records the bond as one to an inclusion if it meets one before its end.
  bool meets_inclusion(std::size_t i, const Point& x, const Point& y, std::size_t k) {
    for (std::size_t n = 0; n < body_.defects.inclusions.size(); ++n) {
      const auto inside = chord(body_.defects.inclusions[n], x, y, touch_);
      if (!inside) continue;
      Point end;
      for (std::size_t a = 0; a < 3; ++a) end[a] = x[a] + inside->from * (y[a] - x[a]);
      if (holes_.cuts(x, end, touch_) || cracks_.cuts(x, end, touch_)) return true;
      ++body_.whole_family[i];
      body_.interface.push_back({i, k, n, end});
      return true;
    }
    return false;
  }

  LatticeBody& body_;
  Defects holes_;
  Defects cracks_;
  double touch_;
};

}  // namespace

std::span<const InterfaceBond> LatticeBody::interface_of(std::size_t point) const {
  const auto [first, last] =
      std::equal_range(interface.begin(), interface.end(), InterfaceBond{point, 0, 0, {}},
                       [](const InterfaceBond& a, const InterfaceBond& b) { return a.point < b.point; });
  return {first, last};
}

std::size_t LatticeBody::family_size(std::size_t point) const {
  std::size_t size = interface_of(point).size();
  for (std::size_t k = 0; k < stencil.size(); ++k) size += bonds.exists(k, point) ? 1 : 0;
  return size;
}

LatticeBody make_lattice_body(const LatticeBodyInput& input) {
  LatticeBody body;
  body.lattice = make_lattice(input);
  body.horizon = input.horizon;
  body.thickness = input.thickness;
  body.shape = input.shape;
  body.defects = input.defects;
  body.stencil = make_stencil(body.lattice, input.horizon);
  body.kind.assign(body.lattice.size(), PointKind::outside);
  body.volume.assign(body.lattice.size(), 0.0);
  body.whole_family.assign(body.lattice.size(), 0);
  body.rigid_points.resize(input.defects.inclusions.size());
  body.bonds = BondPlanes(body.stencil.size(), body.lattice.size());

  CellFiller(input, body).fill();
  for (std::size_t i = 0; i < body.lattice.size(); ++i)
    if (body.kind[i] == PointKind::body) body.points.push_back(i);
  if (body.points.empty()) throw InputError("nothing is left of the body: holes and inclusions cover it");
  make_ghosts(input.mirrored, body);
  BondMaker(body).make();
  return body;
}

}  // namespace riven
