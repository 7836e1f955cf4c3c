#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>
#include <string>

#include "geometry/surface.hpp"

namespace riven::testing {

/// Sides of a box, each of two triangles that face outwards.
inline Triangles box_surface(const Point& lower, const Point& upper) {
  Triangles box;
  for (std::size_t n = 0; n < 8; ++n)
    box.corner.push_back({n % 2 == 0 ? lower[0] : upper[0], n / 2 % 2 == 0 ? lower[1] : upper[1],
                          n / 4 == 0 ? lower[2] : upper[2]});
  box.triangle = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return box;
}

/// The octahedron |x| + |y| + |z| <= radius; its sides in four triangles each, so often, moved onto the ball.
inline Triangles ball_surface(double radius, int times) {
  Triangles ball;
  for (std::size_t a = 0; a < 3; ++a)
    for (const double sign : {1.0, -1.0}) {
      Point corner{};
      corner[a] = sign * radius;
      ball.corner.push_back(corner);
    }
  for (const std::uint32_t x : {0U, 1U})
    for (const std::uint32_t y : {2U, 3U})
      for (const std::uint32_t z : {4U, 5U}) {
        const bool even = (x + y + z) % 2 == 0;  // of the octants, every other one is a mirror image
        ball.triangle.push_back(even ? std::array{x, y, z} : std::array{x, z, y});
      }
  for (; times > 0; --times) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
      const auto [place, is_new] =
          middle.emplace(std::minmax(a, b), static_cast<std::uint32_t>(ball.corner.size()));
      if (is_new) {
        Eigen::Vector3d p = (Eigen::Map<const Eigen::Vector3d>(ball.corner[a].data()) +
                             Eigen::Map<const Eigen::Vector3d>(ball.corner[b].data()))
                                .normalized() *
                            radius;
        ball.corner.push_back({p[0], p[1], p[2]});
      }
      return place->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : ball.triangle) {
      const std::uint32_t ab = between(a, b), bc = between(b, c), ca = between(c, a);
      for (const auto& part :
           {std::array{a, ab, ca}, std::array{b, bc, ab}, std::array{c, ca, bc}, std::array{ab, bc, ca}})
        finer.push_back(part);
    }
    ball.triangle = finer;
  }
  return ball;
}

/// A ring around the z axis.
inline Triangles torus_surface(double radius, double thickness, std::uint32_t around, std::uint32_t across) {
  Triangles torus;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double r = radius + thickness * std::cos(v);
      torus.corner.push_back({r * std::cos(u), r * std::sin(u), thickness * std::sin(v)});
      const std::uint32_t next = (i + 1) % around, over = (j + 1) % across;
      const std::uint32_t a = i * across + j, b = next * across + j, c = next * across + over,
                          d = i * across + over;
      torus.triangle.push_back({a, b, c});
      torus.triangle.push_back({a, c, d});
    }
  return torus;
}

inline Triangles moved(Triangles surface, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map) {
  for (Point& corner : surface.corner) {
    const Eigen::Vector3d to = map(Eigen::Map<const Eigen::Vector3d>(corner.data()));
    corner = {to[0], to[1], to[2]};
  }
  return surface;
}

inline Triangles turned_over(Triangles surface) {
  for (auto& triangle : surface.triangle) std::swap(triangle[0], triangle[1]);
  return surface;
}

inline Triangles together(Triangles a, const Triangles& b) {
  const auto first = static_cast<std::uint32_t>(a.corner.size());
  a.corner.insert(a.corner.end(), b.corner.begin(), b.corner.end());
  for (const auto& [i, j, k] : b.triangle) a.triangle.push_back({first + i, first + j, first + k});
  return a;
}

/// The surface as an STL file; in the binary one coordinates are of single precision.
inline std::string stl_text(const Triangles& surface, bool binary) {
  std::ostringstream out;
  out.precision(17);
  const auto raw = [&](auto value) { out.write(reinterpret_cast<const char*>(&value), sizeof value); };
  if (binary) {
    out << "solid, though the file is binary" << std::string(48, ' ');
    raw(static_cast<std::uint32_t>(surface.triangle.size()));
  } else {
    out << "solid of a test\n";
  }
  for (const auto& triangle : surface.triangle) {
    if (binary) {
      for (int n = 0; n < 3; ++n) raw(0.0F);
    } else {
      out << "facet normal 0 0 0\nouter loop\n";
    }
    for (const std::uint32_t n : triangle) {
      const Point& p = surface.corner[n];
      if (binary) {
        for (const double x : p) raw(static_cast<float>(x));
      } else {
        out << "vertex " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
      }
    }
    if (binary) {
      raw(std::uint16_t{7});
    } else {
      out << "endloop\nendfacet\n";
    }
  }
  if (!binary) out << "endsolid of a test\n";
  return out.str();
}

}  // namespace riven::testing
