#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "body/body.hpp"
#include "fem/element.hpp"
#include "geometry/shape.hpp"

namespace riven {

/// A part of a mesh's boundary: an edge of an element in two dimensions, a face in three.
struct Side {
  std::vector<std::uint32_t> node;  // corners first; seen from outside, counterclockwise
};

/// Sides under a name of their own: a physical group of a mesh.
struct SideGroup {
  std::string name;
  std::vector<Side> sides;
  std::optional<std::size_t> axis{};  // that they all are perpendicular to, if there is one
  bool inside = false;                // some have elements on both of their sides
};

/// A node's share of an integral over a part of a mesh: the integral of its shape function.
struct NodeShare {
  std::uint32_t node = 0;
  double extent = 0;  // m^2 of a side, m^3 of an element
};

/// Elements of one shape.
struct MeshBody {
  ElementShape shape = ElementShape::q4;
  double thickness = 1;                     // m, in two dimensions
  std::vector<Point> node;                  // m
  std::vector<std::uint32_t> corner;        // nodes of every element, one after the other
  std::vector<std::uint8_t> material;       // of each element; empty: all have material 0
  std::array<std::vector<Side>, 6> face{};  // left, right, bottom, top, back, front
  std::vector<SideGroup> group{};           // further edges
  std::vector<std::size_t> number{};        // of each element in its file; empty: they count from 1

  [[nodiscard]] int dimension() const { return dimension_of(shape); }
  [[nodiscard]] std::size_t elements() const { return corner.size() / nodes_of(shape); }
  [[nodiscard]] std::span<const std::uint32_t> nodes(std::size_t element) const {
    const std::size_t n = nodes_of(shape);
    return std::span(corner).subspan(element * n, n);
  }
  [[nodiscard]] std::size_t material_of(std::size_t element) const {
    return material.empty() ? 0 : material[element];
  }
  /// Mean of its nodes (m).
  [[nodiscard]] Point centre(std::size_t element) const;
  /// What messages call an element.
  [[nodiscard]] std::size_t label(std::size_t element) const {
    return number.empty() ? element + 1 : number[element];
  }

  // An edge has a number: 0 to 5 are the faces of the box around the mesh, from 6 on the groups of sides.
  [[nodiscard]] std::size_t edges() const { return face.size() + group.size(); }
  [[nodiscard]] const std::vector<Side>& sides(std::size_t edge) const {
    return edge < face.size() ? face[edge] : group[edge - face.size()].sides;
  }
  /// The axis that an edge is perpendicular to.
  [[nodiscard]] std::optional<std::size_t> axis_across(std::size_t edge) const;
  /// Nodes of an edge, ascending.
  [[nodiscard]] std::vector<std::uint32_t> nodes_on(std::size_t edge) const;
  /// Area of an edge (m^2), shared by its nodes.
  [[nodiscard]] std::vector<NodeShare> face_shares(std::size_t edge) const;
  [[nodiscard]] double face_area(std::size_t edge) const;
  /// Volume of elements (m^3), shared by their nodes.
  [[nodiscard]] std::vector<NodeShare> volume_shares(std::span<const std::size_t> elements) const;
  /// Volume (m^3) of each element that a lumped mass gives to each of its nodes: row sums, of eight-node
  /// quadrilaterals the diagonal of the consistent mass scaled to the whole, where row sums are negative.
  [[nodiscard]] std::vector<double> lumped_volumes() const;
};

/// Where a place lies: the shape functions of an element's nodes there.
struct PlaceInMesh {
  std::size_t element = 0;
  std::vector<double> value;
};

/// The element that holds a place, on its edge within `tolerance` of its size; nothing outside of the mesh.
[[nodiscard]] std::optional<PlaceInMesh> locate(const MeshBody& mesh, const Point& place,
                                                double tolerance = 1e-6);

/// A regular mesh of the unit square or cube, carried to its place by `map`; `elements` along each axis.
/// Triangles halve the cells, tetrahedra are sixths of them.
[[nodiscard]] MeshBody make_mesh(ElementShape shape, const std::vector<int>& elements, double thickness,
                                 const std::function<Point(const Point&)>& map);

/// Part of a circular ring, upright, symmetric to x = 0; the ends of its middle line are at y = 0.
struct Arch {
  double span = 0, rise = 0, depth = 0;  // m; of the middle line, and across it
};
/// For make_mesh: x runs along the arch, y across it.
[[nodiscard]] std::function<Point(const Point&)> arch_map(const Arch& arch);
/// A quadrilateral with straight edges; corners counterclockwise, the first one lower left.
[[nodiscard]] std::function<Point(const Point&)> quadrilateral_map(const std::array<Point, 4>& corner);
[[nodiscard]] std::function<Point(const Point&)> box_map(const Box& box, int dimension);

/// The nodes as points without bonds: what loads, sets and probes work on.
[[nodiscard]] Body nodes_as_body(const MeshBody& mesh);

/// Throws InputError for an element that is turned over or has no volume.
void check_elements(const MeshBody& mesh);

}  // namespace riven
