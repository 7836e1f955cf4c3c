// Rigid spheres and planes that push points: against plain sums, what they conserve.

#include "load/impactor.hpp"

#include <gtest/gtest.h>

#include "support/contact_bodies.hpp"

namespace riven::testing {
namespace {

constexpr double kStiffness = 4e8;

/// Anywhere near a body, so that it meets some of its points.
Impactor random_impactor(Random& random, int dimension) {
  Impactor impactor{.name = "one", .shape = {}, .mass = {}, .stiffness = kStiffness};
  Point place{}, normal{};
  double length = 0;
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
    place[d] = random.between(-0.5, 0.5);
    normal[d] = random.between(-1, 1);
    length += normal[d] * normal[d];
  }
  for (double& component : normal) component /= std::sqrt(length);
  if (random.chance(0.5)) {
    impactor.shape = RigidSphere{place, random.between(0.02, 0.4)};
  } else {
    impactor.shape = RigidPlane{place, normal};
  }
  return impactor;
}

struct Scene {
  Scene(Random& random, int dimension)
      : body(make_lattice_body(random_cells(random, dimension, false))),
        impactor(random_impactor(random, dimension)),
        u(rest_of(body)) {
    for (const std::size_t i : body.points)
      set_vector(u, body, i, 0.2 * random_matrix(random, dimension).col(0));
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
      moved[d] = random.between(-0.1, 0.1);
  }
  /// Depth of a point and the unit vector out, from the shapes' geometry.
  [[nodiscard]] std::pair<double, Eigen::Vector3d> depth(std::size_t i) const {
    const Eigen::Vector3d x = deformed(body, u, i) - Eigen::Vector3d(moved.data());
    const double half = body.spacing / 2;
    if (const auto* plane = std::get_if<RigidPlane>(&impactor.shape)) {
      const Eigen::Vector3d normal(plane->normal.data()), point(plane->point.data());
      return {half - normal.dot(x - point), normal};
    }
    const auto& sphere = std::get<RigidSphere>(impactor.shape);
    const Eigen::Vector3d from = x - Eigen::Vector3d(sphere.center.data());
    return {sphere.radius + half - from.norm(), from.normalized()};
  }
  [[nodiscard]] double energy(const Point& at, const std::vector<double>& of) const {
    return contact_energy(impactor, at, body, of);
  }
  Body body;
  Impactor impactor;
  std::vector<double> u;
  Point moved{};
};

TEST(Impactor, PushesThePointsInItAndIsPushedBack) {
  Random random(3);
  int touched = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Scene scene(random, 1 + trial % 3);
    auto force = rest_of(scene.body);
    const Point on = push(scene.impactor, scene.moved, scene.body, scene.u, force);
    EXPECT_EQ(on, force_on(scene.impactor, scene.moved, scene.body, scene.u));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double energy = 0, scale = 0;
    for (const std::size_t i : scene.body.points) {
      const auto [depth, out] = scene.depth(i);
      const double stiffness = kStiffness * scene.body.volume[i], deep = std::max(depth, 0.0);
      EXPECT_LE((vector_of(force, scene.body, i) - stiffness * deep * out).norm(), 1e-14 * stiffness);
      sum -= vector_of(force, scene.body, i);
      scale += stiffness * deep;
      energy += 0.5 * stiffness * deep * deep;
      if (depth > 0) ++touched;
    }
    EXPECT_LE((sum - Eigen::Vector3d(on.data())).norm(), 1e-14 * scale);  // order of the sum
    EXPECT_NEAR(scene.energy(scene.moved, scene.u), energy, 1e-13 * energy);
  }
  EXPECT_GT(touched, 1000);
}

TEST(Impactor, ForcesAreTheGradientOfTheEnergy) {
  Random random(4);
  for (int trial = 0; trial < 30; ++trial) {
    const Scene scene(random, 1 + trial % 3);
    auto force = rest_of(scene.body);
    const Point on = push(scene.impactor, scene.moved, scene.body, scene.u, force);
    constexpr double h = 1e-6;
    auto ahead = scene.u, behind = scene.u;
    Point moved_ahead = scene.moved, moved_behind = scene.moved;
    double work = 0, scale = 0;
    for (std::size_t d = 0; d < static_cast<std::size_t>(scene.body.dimension); ++d) {
      const double way = random.between(-1, 1);
      moved_ahead[d] += h * way;
      moved_behind[d] -= h * way;
      work -= way * on[d];
    }
    for (std::size_t n = 0; n < force.size(); ++n) {
      const double way = random.between(-1, 1);
      ahead[n] += h * way;
      behind[n] -= h * way;
      work -= way * force[n];
      scale += std::abs(force[n]);
    }
    const double slope = (scene.energy(moved_ahead, ahead) - scene.energy(moved_behind, behind)) / (2 * h);
    // h of the stiffness, where a point comes into reach within h.
    EXPECT_NEAR(slope, work, 1e-5 * scale + 1e-300);
  }
}

TEST(Impactor, BoundsItsStiffness) {
  Random random(5);
  double worst = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Scene scene(random, 1 + trial % 3);
    auto bound = rest_of(scene.body), f = bound, g = bound, there = scene.u;
    const double own = add_bound(scene.impactor, scene.moved, scene.body, scene.u, bound);
    const Point on = push(scene.impactor, scene.moved, scene.body, scene.u, f);
    constexpr double h = 1e-9;
    std::vector<double> v(scene.u.size());
    for (std::size_t n = 0; n < v.size(); ++n) there[n] += h * (v[n] = random.between(-1, 1));
    Point w{}, at = scene.moved;
    for (std::size_t d = 0; d < static_cast<std::size_t>(scene.body.dimension); ++d)
      at[d] += h * (w[d] = random.between(-1, 1));
    const Point on_there = push(scene.impactor, at, scene.body, there, g);
    double rayleigh = 0, most = 0;
    for (std::size_t n = 0; n < v.size(); ++n) {
      rayleigh -= v[n] * (g[n] - f[n]) / h;
      most += bound[n] * v[n] * v[n];
    }
    for (std::size_t d = 0; d < 3; ++d) {
      rayleigh -= w[d] * (on_there[d] - on[d]) / h;
      most += own * w[d] * w[d];
    }
    EXPECT_LE(rayleigh, most);
    if (most > 0) worst = std::max(worst, rayleigh / most);
  }
  EXPECT_GT(worst, 0.1);
}

TEST(Impactor, TouchesTheFaceOfABodyWithoutPushing) {
  const Body body = make_lattice_body(cells_of({6, 4}));
  const auto u = rest_of(body);
  for (const double gap : {0.0, -1e-3}) {
    const Impactor plane{.name = "wall",
                         .shape = RigidPlane{{-0.3 - gap, 0, 0}, {1, 0, 0}},
                         .mass = {},
                         .stiffness = kStiffness};
    const Impactor disc{
        .name = "disc", .shape = RigidSphere{{0.05, 0.5 + gap, 0}, 0.3}, .mass = {}, .stiffness = kStiffness};
    // Four points along the left face; of the top one the one below the disc's centre.
    const double cell = kStiffness * body.volume[body.points[0]];
    EXPECT_NEAR(force_on(plane, {}, body, u)[0], 4 * cell * gap, 1e-12 * cell);
    EXPECT_NEAR(force_on(disc, {}, body, u)[1], -cell * gap, 1e-12 * cell);
  }
}

}  // namespace
}  // namespace riven::testing
