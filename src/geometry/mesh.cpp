#include "geometry/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace riven {
namespace {

struct KindFacts {
  const char* name;
  int dimension;
  std::size_t corners;
  // The element as a cube, or a square, some corners of which coincide: the map is the same polynomial.
  std::array<std::size_t, 8> as_cube;
  std::vector<std::vector<std::size_t>> sides;
};

const KindFacts& facts(ElementKind kind) {
  static const std::array<KindFacts, 8> all = {{
      {"point", 0, 1, {}, {}},
      {"line", 1, 2, {}, {}},
      {"triangle", 2, 3, {0, 1, 2, 2}, {{0, 1}, {1, 2}, {2, 0}}},
      {"quadrangle", 2, 4, {0, 1, 2, 3}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
      {"tetrahedron", 3, 4, {0, 1, 2, 2, 3, 3, 3, 3}, {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}}},
      {"hexahedron",
       3,
       8,
       {0, 1, 2, 3, 4, 5, 6, 7},
       {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
      {"prism",
       3,
       6,
       {0, 1, 2, 2, 3, 4, 5, 5},
       {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
      {"pyramid", 3, 5, {0, 1, 2, 3, 4, 4, 4, 4}, {{0, 1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}},
  }};
  return all[static_cast<std::size_t>(kind)];
}

/// Where the trilinear map of a cube of edge 1 brings a place, and its determinant there.
struct Mapped {
  Point x{};
  double determinant = 0;
};

Mapped map_cube(const std::array<Point, 8>& corner, const Point& place) {
  constexpr std::array<std::array<int, 3>, 8> kAt = {
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  Mapped mapped;
  std::array<Point, 3> along{};  // derivatives by the three directions of the cube
  for (std::size_t n = 0; n < 8; ++n) {
    std::array<double, 3> value{}, slope{};
    for (std::size_t d = 0; d < 3; ++d) {
      value[d] = kAt[n][d] == 1 ? place[d] : 1 - place[d];
      slope[d] = kAt[n][d] == 1 ? 1 : -1;
    }
    for (std::size_t a = 0; a < 3; ++a) {
      mapped.x[a] += value[0] * value[1] * value[2] * corner[n][a];
      along[0][a] += slope[0] * value[1] * value[2] * corner[n][a];
      along[1][a] += value[0] * slope[1] * value[2] * corner[n][a];
      along[2][a] += value[0] * value[1] * slope[2] * corner[n][a];
    }
  }
  const auto& [u, v, w] = along;
  mapped.determinant = u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
                       u[2] * (v[0] * w[1] - v[1] * w[0]);
  return mapped;
}

/// The corners of the cube that stands for an element, seen from its first one: far from the origin nothing
/// cancels. Over an element in the plane it is 1 high, so that its volume is the area.
std::array<Point, 8> cube_of(const Mesh& mesh, const ElementBlock& block, std::size_t element) {
  const KindFacts& kind = facts(block.kind);
  const auto node = block.corners(element);
  const Point& origin = mesh.node[node[0]];
  std::array<Point, 8> cube{};
  for (std::size_t n = 0; n < 8; ++n) {
    const Point& x = mesh.node[node[kind.as_cube[kind.dimension == 2 ? n % 4 : n]]];
    for (std::size_t a = 0; a < static_cast<std::size_t>(kind.dimension); ++a) cube[n][a] = x[a] - origin[a];
    if (kind.dimension == 2) cube[n][2] = n < 4 ? -0.5 : 0.5;
  }
  return cube;
}

/// Length or area of a side that lies in a plane across an axis; its corners go round.
double side_size(const std::vector<Point>& corner, int dimension) {
  if (dimension == 2) return std::hypot(corner[1][0] - corner[0][0], corner[1][1] - corner[0][1]);
  Point area{};
  for (std::size_t n = 1; n + 1 < corner.size(); ++n)
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      area[a] += 0.5 * ((corner[n][b] - corner[0][b]) * (corner[n + 1][c] - corner[0][c]) -
                        (corner[n][c] - corner[0][c]) * (corner[n + 1][b] - corner[0][b]));
    }
  return std::hypot(area[0], area[1], area[2]);
}

template <class Visit>
void for_each_element(const Mesh& mesh, const Visit& visit) {
  const int dimension = mesh.dimension();
  for (const ElementBlock& block : mesh.blocks)
    if (dimension_of(block.kind) == dimension)
      for (std::size_t n = 0; n < block.size(); ++n) visit(block, n);
}

}  // namespace

int dimension_of(ElementKind kind) {
  return facts(kind).dimension;
}

std::size_t corners_of(ElementKind kind) {
  return facts(kind).corners;
}

const char* name_of(ElementKind kind) {
  return facts(kind).name;
}

const std::vector<std::vector<std::size_t>>& sides_of(ElementKind kind) {
  return facts(kind).sides;
}

int Mesh::dimension() const {
  int highest = 0;
  for (const ElementBlock& block : blocks)
    if (block.size() > 0) highest = std::max(highest, dimension_of(block.kind));
  return highest;
}

ElementMeasure measure(const Mesh& mesh, const ElementBlock& block, std::size_t element) {
  // Two Gauss points a direction are exact for polynomials of degree 3: position times determinant.
  const std::array<double, 2> gauss = {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)};
  const std::array<Point, 8> cube = cube_of(mesh, block, element);
  ElementMeasure sum;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const double a : gauss)
    for (const double b : gauss)
      for (const double c : gauss) {
        const Mapped at = map_cube(cube, {a, b, c});
        sum.size += at.determinant / 8;
        for (std::size_t d = 0; d < 3; ++d) sum.centroid[d] += at.determinant / 8 * at.x[d];
        least = std::min(least, at.determinant);
        most = std::max(most, at.determinant);
      }
  sum.one_sided = least > 0 || most < 0;
  const Point& origin = mesh.node[block.corners(element)[0]];
  for (std::size_t d = 0; d < 3; ++d) sum.centroid[d] = origin[d] + sum.centroid[d] / sum.size;
  if (dimension_of(block.kind) == 2) sum.centroid[2] = 0;
  return sum;
}

Box box_around(const Mesh& mesh) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  Point lower{endless, endless, endless}, upper{-endless, -endless, -endless};
  for_each_element(mesh, [&](const ElementBlock& block, std::size_t n) {
    for (const std::uint32_t node : block.corners(n))
      for (std::size_t a = 0; a < 3; ++a) {
        lower[a] = std::min(lower[a], mesh.node[node][a]);
        upper[a] = std::max(upper[a], mesh.node[node][a]);
      }
  });
  Box box{{}, {endless, endless, endless}};
  for (std::size_t a = 0; a < static_cast<std::size_t>(mesh.dimension()); ++a) {
    box.center[a] = 0.5 * (lower[a] + upper[a]);
    box.half_size[a] = 0.5 * (upper[a] - lower[a]);
  }
  return box;
}

std::array<bool, 6> filled_faces(const Mesh& mesh, const Box& box) {
  constexpr double kRounding = 1e-6;  // of the box, as files keep six digits and more
  const int dimension = mesh.dimension();
  const auto axes = static_cast<std::size_t>(dimension);
  std::array<double, 6> covered{};
  std::vector<Point> corner;
  for_each_element(mesh, [&](const ElementBlock& block, std::size_t n) {
    for (const std::vector<std::size_t>& side : facts(block.kind).sides) {
      corner.clear();
      for (const std::size_t c : side) corner.push_back(mesh.node[block.corners(n)[c]]);
      for (std::size_t face = 0; face < 2 * axes; ++face) {
        const std::size_t axis = face / 2;
        const double end = box.center[axis] + (face % 2 == 0 ? -1 : 1) * box.half_size[axis];
        const bool on_face = std::all_of(corner.begin(), corner.end(), [&](const Point& x) {
          return std::abs(x[axis] - end) <= kRounding * box.half_size[axis];
        });
        if (on_face) covered[face] += side_size(corner, dimension);
      }
    }
  });
  std::array<bool, 6> filled{};
  for (std::size_t face = 0; face < 2 * axes; ++face) {
    double whole = 1;
    for (std::size_t axis = 0; axis < axes; ++axis)
      if (axis != face / 2) whole *= 2 * box.half_size[axis];
    filled[face] = std::abs(covered[face] - whole) <= 10 * kRounding * whole;
  }
  return filled;
}

}  // namespace riven
