#include "fem/mesh_body.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "geometry/side_rule.hpp"

namespace riven {

namespace {

template <class E>
using Places = Eigen::Matrix<double, E::N, E::D>;

template <class E>
Places<E> places_of(const MeshBody& mesh, std::size_t element) {
  Places<E> x;
  const auto nodes = mesh.nodes(element);
  for (int a = 0; a < E::N; ++a)
    for (int d = 0; d < E::D; ++d)
      x(a, d) = mesh.node[nodes[static_cast<std::size_t>(a)]][static_cast<std::size_t>(d)];
  return x;
}

/// Calls visit(shape functions, weight times the map's determinant) for the quadrature points of an element.
template <class E, class Visit>
void for_each_quadrature_point(const MeshBody& mesh, std::size_t element, const Visit& visit) {
  const Places<E> x = places_of<E>(mesh, element);
  for (const auto& point : E::rule()) {
    const auto f = E::at(point.at);
    const Eigen::Matrix<double, E::D, E::D> jacobian = x.transpose() * f.slope;
    visit(f, point.weight * jacobian.determinant() * (E::D == 2 ? mesh.thickness : 1));
  }
}

/// Integrals of a side's shape functions: length or area, without thickness, by Gauss's rule.
std::vector<double> side_integrals(const MeshBody& mesh, const Side& side) {
  std::vector<double> integrals(side.node.size(), 0.0);
  const bool in_space = mesh.dimension() == 3;
  for (const SidePoint& point : side_rule(mesh.dimension(), side.node.size())) {
    Eigen::Vector3d r = Eigen::Vector3d::Zero(), s = r;
    for (std::size_t a = 0; a < side.node.size(); ++a) {
      const Eigen::Map<const Eigen::Vector3d> x(mesh.node[side.node[a]].data());
      r += point.slope[0][a] * x;
      s += point.slope[1][a] * x;
    }
    const double size = point.weight * (in_space ? r.cross(s).norm() : r.norm());
    for (std::size_t a = 0; a < side.node.size(); ++a) integrals[a] += size * point.value[a];
  }
  return integrals;
}

/// One entry per node, ascending.
std::vector<NodeShare> summed(std::vector<NodeShare> shares) {
  std::stable_sort(shares.begin(), shares.end(),
                   [](const NodeShare& a, const NodeShare& b) { return a.node < b.node; });
  std::vector<NodeShare> sums;
  for (const NodeShare& share : shares)
    if (!sums.empty() && sums.back().node == share.node)
      sums.back().extent += share.extent;
    else
      sums.push_back(share);
  return sums;
}

/// Local coordinates of a place by Newton's method on the element's map; nothing if it is not inside.
template <class E>
std::optional<Eigen::Matrix<double, E::N, 1>> values_at(const MeshBody& mesh, std::size_t element,
                                                        const Eigen::Matrix<double, E::D, 1>& place,
                                                        double tolerance) {
  constexpr int kMost = 30;
  const Places<E> x = places_of<E>(mesh, element);
  const double size = (x.colwise().maxCoeff() - x.colwise().minCoeff()).maxCoeff();
  for (int d = 0; d < E::D; ++d)  // curved sides may bulge out of their nodes' box
    if (place(d) < x.col(d).minCoeff() - 0.3 * size || place(d) > x.col(d).maxCoeff() + 0.3 * size) return {};
  Eigen::Matrix<double, E::D, 1> at = E::rule().front().at * (E::N == E::D + 1 ? 1 : 0);
  for (int n = 0; n < kMost; ++n) {
    const auto f = E::at(at);
    const Eigen::Matrix<double, E::D, 1> miss = place - x.transpose() * f.value;
    const Eigen::Matrix<double, E::D, E::D> jacobian = x.transpose() * f.slope;
    if (miss.norm() <= 1e-12 * size) break;
    at += jacobian.inverse() * miss;
    if (!(at.norm() < 10)) return {};
  }
  const auto f = E::at(at);
  if (!((place - x.transpose() * f.value).norm() <= 1e-9 * size)) return {};
  const bool inside = E::N == E::D + 1 ? at.minCoeff() >= -tolerance && at.sum() <= 1 + tolerance
                                       : at.cwiseAbs().maxCoeff() <= 1 + tolerance;
  if (!inside) return {};
  return f.value;
}

// ---- regular meshes ----

/// Nodes of the grid by their places along the axes, in half cells; numbered as they are asked for.
class GridNodes {
 public:
  GridNodes(const std::vector<int>& cells) {
    for (std::size_t d = 0; d < cells.size(); ++d) points_[d] = 2 * static_cast<std::size_t>(cells[d]) + 1;
    number_.assign(points_[0] * points_[1] * points_[2], kNone);
  }
  std::uint32_t operator()(std::size_t i, std::size_t j, std::size_t k) {
    std::uint32_t& number = number_[(k * points_[1] + j) * points_[0] + i];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(place.size());
      place.push_back({i, j, k});
    }
    return number;
  }
  [[nodiscard]] std::size_t last(std::size_t axis) const { return points_[axis] - 1; }

  std::vector<std::array<std::size_t, 3>> place;  // of each node

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::array<std::size_t, 3> points_{1, 1, 1};
  std::vector<std::uint32_t> number_;
};

using Corners = std::vector<std::uint32_t>;

/// Appends the elements of a cell with lower corner (i, j, k), in half cells.
void add_cell(ElementShape shape, GridNodes& node, std::size_t i, std::size_t j, std::size_t k, Corners& to) {
  const auto add = [&to](const std::vector<std::uint32_t>& nodes) {
    to.insert(to.end(), nodes.begin(), nodes.end());
  };
  const std::array<std::uint32_t, 4> c{node(i, j, k), node(i + 2, j, k), node(i + 2, j + 2, k),
                                       node(i, j + 2, k)};
  if (shape == ElementShape::q4) return add({c[0], c[1], c[2], c[3]});
  if (shape == ElementShape::q8)
    return add({c[0], c[1], c[2], c[3], node(i + 1, j, k), node(i + 2, j + 1, k), node(i + 1, j + 2, k),
                node(i, j + 1, k)});
  if (shape == ElementShape::t3) {
    if ((i + j) / 2 % 2 == 0)  // diagonals that alternate prefer no direction
      return add({c[0], c[1], c[2], c[0], c[2], c[3]});
    return add({c[0], c[1], c[3], c[1], c[2], c[3]});
  }
  const std::array<std::uint32_t, 4> t{node(i, j, k + 2), node(i + 2, j, k + 2), node(i + 2, j + 2, k + 2),
                                       node(i, j + 2, k + 2)};
  if (shape == ElementShape::h8) return add({c[0], c[1], c[2], c[3], t[0], t[1], t[2], t[3]});
  // Six ways from the lower corner to the upper one along edges: sixths that fit those of the next cells.
  add({c[0], c[1], c[2], t[2], c[0], c[2], c[3], t[2], c[0], c[3], t[3], t[2]});
  add({c[0], t[3], t[0], t[2], c[0], t[0], t[1], t[2], c[0], t[1], c[1], t[2]});
}

/// Sides of elements on the faces of the grid.
template <class E>
void add_faces(MeshBody& mesh, const GridNodes& grid) {
  for (std::size_t e = 0; e < mesh.elements(); ++e)
    for (const auto& side : E::sides)
      for (std::size_t face = 0; face < 2 * static_cast<std::size_t>(E::D); ++face) {
        const std::size_t axis = face / 2, at = face % 2 == 0 ? 0 : grid.last(axis);
        Side found;
        for (const int a : side) {
          const std::uint32_t node = mesh.nodes(e)[static_cast<std::size_t>(a)];
          if (grid.place[node][axis] == at) found.node.push_back(node);
        }
        if (found.node.size() == side.size()) mesh.face[face].push_back(std::move(found));
      }
}

}  // namespace

Point MeshBody::centre(std::size_t element) const {
  Point sum{};
  const auto list = nodes(element);
  for (const std::uint32_t n : list)
    for (std::size_t d = 0; d < 3; ++d) sum[d] += node[n][d] / static_cast<double>(list.size());
  return sum;
}

std::vector<std::uint32_t> MeshBody::nodes_on(std::size_t edge) const {
  std::vector<std::uint32_t> list;
  for (const Side& side : sides(edge)) list.insert(list.end(), side.node.begin(), side.node.end());
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

std::vector<NodeShare> MeshBody::face_shares(std::size_t edge) const {
  std::vector<NodeShare> shares;
  const double across = dimension() == 2 ? thickness : 1;
  for (const Side& side : sides(edge)) {
    const std::vector<double> integrals = side_integrals(*this, side);
    for (std::size_t a = 0; a < integrals.size(); ++a)
      shares.push_back({side.node[a], across * integrals[a]});
  }
  return summed(std::move(shares));
}

double MeshBody::face_area(std::size_t edge) const {
  const std::vector<NodeShare> shares = face_shares(edge);
  return std::accumulate(shares.begin(), shares.end(), 0.0,
                         [](double sum, const NodeShare& share) { return sum + share.extent; });
}

std::optional<std::size_t> MeshBody::axis_across(std::size_t edge) const {
  return edge < face.size() ? std::optional(edge / 2) : group[edge - face.size()].axis;
}

std::vector<NodeShare> MeshBody::volume_shares(std::span<const std::size_t> list) const {
  return with_element(shape, [&]<class E>(E) {
    std::vector<NodeShare> shares;
    for (const std::size_t e : list) {
      Eigen::Matrix<double, E::N, 1> sum = Eigen::Matrix<double, E::N, 1>::Zero();
      for_each_quadrature_point<E>(*this, e, [&](const auto& f, double w) { sum += w * f.value; });
      for (int a = 0; a < E::N; ++a) shares.push_back({nodes(e)[static_cast<std::size_t>(a)], sum(a)});
    }
    return summed(std::move(shares));
  });
}

std::vector<double> MeshBody::lumped_volumes() const {
  return with_element(shape, [&]<class E>(E) {
    std::vector<double> volumes;
    for (std::size_t e = 0; e < elements(); ++e) {
      Eigen::Matrix<double, E::N, 1> sum = Eigen::Matrix<double, E::N, 1>::Zero(), square = sum;
      for_each_quadrature_point<E>(*this, e, [&](const auto& f, double w) {
        sum += w * f.value;
        square += w * f.value.cwiseAbs2();
      });
      if (E::shape == ElementShape::q8) sum = sum.sum() / square.sum() * square.eval();
      volumes.insert(volumes.end(), sum.data(), sum.data() + E::N);
    }
    return volumes;
  });
}

std::optional<PlaceInMesh> locate(const MeshBody& mesh, const Point& place, double tolerance) {
  return with_element(mesh.shape, [&]<class E>(E) -> std::optional<PlaceInMesh> {
    const Eigen::Matrix<double, E::D, 1> x = Eigen::Map<const Eigen::Matrix<double, E::D, 1>>(place.data());
    for (std::size_t e = 0; e < mesh.elements(); ++e)
      if (const auto value = values_at<E>(mesh, e, x, tolerance))
        return PlaceInMesh{e, {value->data(), value->data() + E::N}};
    return std::nullopt;
  });
}

MeshBody make_mesh(ElementShape shape, const std::vector<int>& elements, double thickness,
                   const std::function<Point(const Point&)>& map) {
  MeshBody mesh{.shape = shape, .thickness = thickness};
  GridNodes grid(elements);
  std::array<std::size_t, 3> cells{1, 1, 1};
  for (std::size_t d = 0; d < elements.size(); ++d) cells[d] = static_cast<std::size_t>(elements[d]);
  for (std::size_t k = 0; k < cells[2]; ++k)
    for (std::size_t j = 0; j < cells[1]; ++j)
      for (std::size_t i = 0; i < cells[0]; ++i) add_cell(shape, grid, 2 * i, 2 * j, 2 * k, mesh.corner);
  for (const auto& place : grid.place) {
    Point x{};
    for (std::size_t d = 0; d < elements.size(); ++d)
      x[d] = static_cast<double>(place[d]) / static_cast<double>(grid.last(d));
    mesh.node.push_back(map(x));
  }
  with_element(shape, [&]<class E>(E) { add_faces<E>(mesh, grid); });
  return mesh;
}

std::function<Point(const Point&)> arch_map(const Arch& arch) {
  const double half = 2 * std::atan(2 * arch.rise / arch.span);  // angle of half the arch
  const double radius = (0.25 * arch.span * arch.span + arch.rise * arch.rise) / (2 * arch.rise);
  return [=](const Point& x) {
    const double angle = (2 * x[0] - 1) * half, r = radius + (x[1] - 0.5) * arch.depth;
    return Point{r * std::sin(angle), r * std::cos(angle) - (radius - arch.rise), 0};
  };
}

std::function<Point(const Point&)> quadrilateral_map(const std::array<Point, 4>& corner) {
  return [=](const Point& x) {
    const auto f = Q4::at({2 * x[0] - 1, 2 * x[1] - 1});
    Point y{};
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t d = 0; d < 2; ++d) y[d] += f.value(static_cast<int>(a)) * corner[a][d];
    return y;
  };
}

std::function<Point(const Point&)> box_map(const Box& box, int dimension) {
  return [=](const Point& x) {
    Point y{};
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
      y[d] = box.center[d] + (2 * x[d] - 1) * box.half_size[d];
    return y;
  };
}

Body nodes_as_body(const MeshBody& mesh) {
  const std::size_t nodes = mesh.node.size();
  Body body;
  body.dimension = mesh.dimension();
  body.thickness = mesh.thickness;
  body.kind.assign(nodes, PointKind::body);
  body.volume.assign(nodes, 0.0);
  const std::vector<double> volumes = mesh.lumped_volumes();
  for (std::size_t n = 0; n < volumes.size(); ++n) body.volume[mesh.corner[n]] += volumes[n];
  const double whole = std::accumulate(volumes.begin(), volumes.end(), 0.0);
  body.spacing =
      std::pow(whole / (body.thickness * static_cast<double>(mesh.elements())), 1.0 / body.dimension);
  body.horizon = 2 * body.spacing;  // within which displacements are interpolated
  body.whole_family.assign(nodes, 0);
  body.complete.assign(nodes, true);
  body.points.resize(nodes);
  std::iota(body.points.begin(), body.points.end(), std::size_t{0});
  body.faces.fill(0);
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(body.dimension); ++axis) {
    const auto [low, high] =
        std::minmax_element(mesh.node.begin(), mesh.node.end(),
                            [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; });
    body.faces[2 * axis] = (*low)[axis];
    body.faces[2 * axis + 1] = (*high)[axis];
  }
  ListedBonds none{.position = mesh.node, .begin = std::vector<std::size_t>(nodes + 1, 0)};
  none.close();
  body.bonds = std::move(none);
  return body;
}

void check_elements(const MeshBody& mesh) {
  with_element(mesh.shape, [&]<class E>(E) {
    for (std::size_t e = 0; e < mesh.elements(); ++e)
      for_each_quadrature_point<E>(mesh, e, [&](const auto&, double w) {
        if (w > 0) return;
        const Point at = mesh.centre(e);
        throw InputError(
            fmt::format("element {} at ({:.4g}, {:.4g}, {:.4g}) m is turned over or folded; expected "
                        "corners counterclockwise and no reentrant ones",
                        mesh.label(e), at[0], at[1], at[2]));
      });
  });
}

}  // namespace riven
