#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace riven {

/// Elements with displacements alone: triangle, quadrilaterals of four and eight nodes, tetrahedron,
/// hexahedron.
enum class ElementShape : std::uint8_t { t3, q4, q8, t4, h8 };

/// Shape functions at a place of the reference element, and their slopes along its coordinates.
template <int D, int N>
struct ShapeFunctions {
  Eigen::Matrix<double, N, 1> value;
  Eigen::Matrix<double, N, D> slope;
};

template <int D>
struct QuadraturePoint {
  Eigen::Matrix<double, D, 1> at;
  double weight = 0;
};

// An element type names its dimension D, numbers of nodes N and of quadrature points Q, of sides and of nodes
// on one. Corners come in the order of Gmsh and VTK, then the nodes in the middle of the sides.

struct T3 {
  static constexpr ElementShape shape = ElementShape::t3;
  static constexpr int D = 2, N = 3, Q = 1;
  static constexpr std::array<std::array<int, 2>, 3> sides{{{0, 1}, {1, 2}, {2, 0}}};
  static ShapeFunctions<D, N> at(const Eigen::Vector2d& x) {
    ShapeFunctions<D, N> f;
    f.value << 1 - x(0) - x(1), x(0), x(1);
    f.slope << -1, -1, 1, 0, 0, 1;
    return f;
  }
  static std::array<QuadraturePoint<D>, Q> rule() { return {{{Eigen::Vector2d::Constant(1.0 / 3), 0.5}}}; }
};

struct T4 {
  static constexpr ElementShape shape = ElementShape::t4;
  static constexpr int D = 3, N = 4, Q = 1;
  static constexpr std::array<std::array<int, 3>, 4> sides{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  static ShapeFunctions<D, N> at(const Eigen::Vector3d& x) {
    ShapeFunctions<D, N> f;
    f.value << 1 - x.sum(), x(0), x(1), x(2);
    f.slope << -1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1;
    return f;
  }
  static std::array<QuadraturePoint<D>, Q> rule() { return {{{Eigen::Vector3d::Constant(0.25), 1.0 / 6}}}; }
};

/// Gauss's points on the square or cube of edge 2 with `n` per direction (2: exact to cubes, 3: to fifth
/// powers).
template <int D, int n>
auto gauss() {
  constexpr int kCount = D == 2 ? n * n : n * n * n;
  const std::array<double, 3> x = n == 2 ? std::array{-std::sqrt(1.0 / 3), std::sqrt(1.0 / 3), 0.0}
                                         : std::array{-std::sqrt(0.6), 0.0, std::sqrt(0.6)};
  const std::array<double, 3> w = n == 2 ? std::array{1.0, 1.0, 0.0} : std::array{5.0 / 9, 8.0 / 9, 5.0 / 9};
  std::array<QuadraturePoint<D>, kCount> points;
  for (int p = 0; p < kCount; ++p) {
    points[static_cast<std::size_t>(p)].weight = 1;
    for (int d = 0, rest = p; d < D; ++d, rest /= n) {
      points[static_cast<std::size_t>(p)].at(d) = x[static_cast<std::size_t>(rest % n)];
      points[static_cast<std::size_t>(p)].weight *= w[static_cast<std::size_t>(rest % n)];
    }
  }
  return points;
}

/// Reference square [-1, 1]^2.
struct Q4 {
  static constexpr ElementShape shape = ElementShape::q4;
  static constexpr int D = 2, N = 4, Q = 4;
  static constexpr std::array<std::array<int, 2>, 4> sides{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
  static constexpr std::array<std::array<int, 2>, 4> corners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  static ShapeFunctions<D, N> at(const Eigen::Vector2d& x) {
    ShapeFunctions<D, N> f;
    for (int a = 0; a < N; ++a) {
      const auto [r, s] = corners[static_cast<std::size_t>(a)];
      f.value(a) = 0.25 * (1 + r * x(0)) * (1 + s * x(1));
      f.slope.row(a) << 0.25 * r * (1 + s * x(1)), 0.25 * s * (1 + r * x(0));
    }
    return f;
  }
  static std::array<QuadraturePoint<D>, Q> rule() { return gauss<2, 2>(); }
};

/// Serendipity: the square's corners and the middles of its sides.
struct Q8 {
  static constexpr ElementShape shape = ElementShape::q8;
  static constexpr int D = 2, N = 8, Q = 9;
  static constexpr std::array<std::array<int, 3>, 4> sides{{{0, 1, 4}, {1, 2, 5}, {2, 3, 6}, {3, 0, 7}}};
  static ShapeFunctions<D, N> at(const Eigen::Vector2d& p) {
    ShapeFunctions<D, N> f;
    const double x = p(0), y = p(1);
    for (int a = 0; a < 4; ++a) {
      const auto [r, s] = Q4::corners[static_cast<std::size_t>(a)];
      const double rx = 1 + r * x, sy = 1 + s * y, n = r * x + s * y - 1;
      f.value(a) = 0.25 * rx * sy * n;
      f.slope.row(a) << 0.25 * r * sy * (n + rx), 0.25 * s * rx * (n + sy);
    }
    for (int a = 4; a < 8; ++a) {
      const bool across = a % 2 == 0;  // sides along x, at y = -1 and 1
      const double sign = a == 4 || a == 7 ? -1 : 1;
      const double along = across ? x : y, off = across ? y : x;
      f.value(a) = 0.5 * (1 - along * along) * (1 + sign * off);
      const double d_along = -along * (1 + sign * off), d_off = 0.5 * sign * (1 - along * along);
      if (across)
        f.slope.row(a) << d_along, d_off;
      else
        f.slope.row(a) << d_off, d_along;
    }
    return f;
  }
  static std::array<QuadraturePoint<D>, Q> rule() { return gauss<2, 3>(); }
};

/// Reference cube [-1, 1]^3.
struct H8 {
  static constexpr ElementShape shape = ElementShape::h8;
  static constexpr int D = 3, N = 8, Q = 8;
  static constexpr std::array<std::array<int, 4>, 6> sides{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  static ShapeFunctions<D, N> at(const Eigen::Vector3d& x) {
    ShapeFunctions<D, N> f;
    for (int a = 0; a < N; ++a) {
      const auto [r, s] = Q4::corners[static_cast<std::size_t>(a % 4)];
      const int t = a < 4 ? -1 : 1;
      const double u = 1 + r * x(0), v = 1 + s * x(1), w = 1 + t * x(2);
      f.value(a) = 0.125 * u * v * w;
      f.slope.row(a) << 0.125 * r * v * w, 0.125 * s * u * w, 0.125 * t * u * v;
    }
    return f;
  }
  static std::array<QuadraturePoint<D>, Q> rule() { return gauss<3, 2>(); }
};

/// Calls visit(E{}) with the type of a shape.
template <class Visit>
auto with_element(ElementShape shape, const Visit& visit) {
  switch (shape) {
    case ElementShape::t3:
      return visit(T3{});
    case ElementShape::q4:
      return visit(Q4{});
    case ElementShape::q8:
      return visit(Q8{});
    case ElementShape::t4:
      return visit(T4{});
    default:
      return visit(H8{});
  }
}

[[nodiscard]] inline int dimension_of(ElementShape shape) {
  return with_element(shape, []<class E>(E) { return E::D; });
}
[[nodiscard]] inline std::size_t nodes_of(ElementShape shape) {
  return with_element(shape, []<class E>(E) { return static_cast<std::size_t>(E::N); });
}
/// "t3", "q4", "q8", "t4", "h8".
[[nodiscard]] inline std::string name_of(ElementShape shape) {
  constexpr std::array kNames{"t3", "q4", "q8", "t4", "h8"};
  return kNames[static_cast<std::size_t>(shape)];
}

}  // namespace riven
