// What an indenter does to nodes, whatever holds them.

#include "load/indenter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <numeric>

#include "support/differences.hpp"
#include "support/indenters.hpp"

namespace riven::testing {
namespace {

using Eigen::Vector3d;

struct Shape {
  std::string name;
  int dimension;
  IndenterShape shape;  // its surface goes through the origin, or near it, and it is above
};

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> all{{"disc", 2, RigidSphere{{0.1, 0.8, 0}, 0.8}},
                                      {"sphere", 3, RigidSphere{{0.1, 0.2, 0.8}, 0.9}},
                                      {"plane", 2, RigidPlane{{0, 0, 0}, {0.6, -0.8, 0}}},
                                      {"plane in space", 3, RigidPlane{{0, 0, 0}, {0.48, 0.6, -0.64}}},
                                      {"flat", 2, RigidFlat{{-0.5, 0.1, 0}, {0.3, -0.1, 0}, 0.6}}};
  return all;
}

/// Nodes at random around the origin, under an indenter that comes down along y and aside.
struct Problem {
  Problem(const Shape& of, bool sticking, unsigned seed, std::size_t count = 40) : random(seed) {
    std::vector<LoadShare> surface;
    for (std::size_t n = 0; n < count; ++n) surface.push_back({n, {}, random.between(0.1, 1)});
    for (LoadShare& share : surface)
      for (int d = 0; d < of.dimension; ++d)
        share.position[static_cast<std::size_t>(d)] = random.between(-0.9, 0.9);
    const auto way = [](double t) { return Point{0.3 * t, -0.2 * t * t, 0.1 * t}; };
    indenter = std::make_unique<Indenter>(IndenterSettings{"punch", of.shape, way, 7, sticking, 0.2}, surface,
                                          count, of.dimension);
    if (of.dimension == 2)
      indenter = std::make_unique<Indenter>(IndenterSettings{"punch", of.shape,
                                                             [way](double t) {
                                                               return Point{way(t)[0], way(t)[1], 0};
                                                             },
                                                             7, sticking, 0.2},
                                            surface, count, of.dimension);
    dofs = count * static_cast<std::size_t>(of.dimension);
  }
  std::vector<double> state(double size) {
    std::vector<double> u(dofs);
    for (double& entry : u) entry = random.between(-size, size);
    return u;
  }
  std::vector<double> force(const std::vector<double>& u, double t) {
    std::vector<double> f(dofs, 0.0);
    indenter->add(u, {}, t, f);
    return f;
  }
  Random random;
  std::unique_ptr<Indenter> indenter;
  std::size_t dofs = 0;
};

template <class Body>
void for_all(const Body& body) {
  unsigned seed = 0;
  for (const Shape& shape : shapes())
    for (const bool sticking : {false, true}) {
      SCOPED_TRACE(shape.name + (sticking ? ", sticking" : ""));
      Problem problem(shape, sticking, ++seed);
      problem.indenter->advance(problem.state(0.05), 0.5);
      body(problem);
    }
}

std::vector<double> along(const std::vector<double>& u, const std::vector<double>& direction, double part) {
  std::vector<double> there = u;
  for (std::size_t i = 0; i < u.size(); ++i) there[i] += part * direction[i];
  return there;
}

TEST(Indenter, ForceIsMinusTheGradientOfWhatItHoldsAndHasATangent) {
  for_all([](Problem& p) {
    const auto u = p.state(0.05), direction = p.state(1);
    // Where no node goes in or out in the five states.
    const auto force = p.force(u, 0.6);
    const double slope =
        derivative([&](double s) { return p.indenter->held(along(u, direction, s), 0.6); }, 0, 1e-5);
    const double expected = -std::inner_product(force.begin(), force.end(), direction.begin(), 0.0);
    EXPECT_GT(std::abs(expected), 0.01);
    EXPECT_NEAR(slope, expected, 1e-9);  // energies of 10 J: 1e-15 / 1e-5
    TangentBlocks blocks;
    p.indenter->tangent(u, 0.6, blocks);
    Eigen::VectorXd product = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(p.dofs));
    std::size_t at = 0;
    for (std::size_t b = 0; b + 1 < blocks.begin.size(); ++b)
      for (std::size_t r = blocks.begin[b]; r < blocks.begin[b + 1]; ++r)
        for (std::size_t c = blocks.begin[b]; c < blocks.begin[b + 1]; ++c)
          product(static_cast<Eigen::Index>(blocks.dofs[r])) +=
              blocks.values[at++] * direction[blocks.dofs[c]];
    EXPECT_EQ(at, blocks.values.size());
    const Eigen::VectorXd change = derivative(
        [&](double s) {
          const auto f = p.force(along(u, direction, s), 0.6);
          return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(f.data(), product.size()));
        },
        0, 1e-5);
    EXPECT_GT(product.norm(), 1);
    EXPECT_LT((change + product).cwiseAbs().maxCoeff(), 1e-9);
  });
}

TEST(Indenter, FeelsWhatItDoes) {
  for_all([](Problem& p) {
    const auto u = p.state(0.05), force = p.force(u, 0.6);
    const Point on = p.indenter->force_on(u, 0.6);
    const std::size_t nodes = p.indenter->surface().size();
    for (std::size_t d = 0; d < p.dofs / nodes; ++d)
      EXPECT_NEAR(on[d],
                  -std::accumulate(force.begin() + static_cast<std::ptrdiff_t>(d * nodes),
                                   force.begin() + static_cast<std::ptrdiff_t>((d + 1) * nodes), 0.0),
                  1e-13);
  });
}

// What nodes get is what comes from the indenter's motion, less what is held, to the third power of a step in
// which no node touches.
TEST(Indenter, WorksAsMuchAsNodesAndStoreGet) {
  for_all([](Problem& p) {
    constexpr double h = 1e-4;
    const auto u = p.state(0.05), velocity = p.state(1), later = along(u, velocity, h);
    const auto before = p.force(u, 0.6), after = p.force(later, 0.6 + h);
    double got = 0;
    for (std::size_t i = 0; i < u.size(); ++i) got += 0.5 * (before[i] + after[i]) * h * velocity[i];
    const double work = p.indenter->work(u, 0.6, later, 0.6 + h);
    EXPECT_GT(std::abs(work), 1e-5);
    EXPECT_NEAR(work, got + p.indenter->held(later, 0.6 + h) - p.indenter->held(u, 0.6), 1e-9);
  });
}

// A node at rest that a plane meets or leaves within a step has all of the work: or a run that begins with a
// touch would miss most of its energy.
TEST(Indenter, WorksFromTheTouchOn) {
  Indenter plane({"punch", RigidPlane{{0, 0.3, 0}, {0, -1, 0}},
                  [](double t) {
                    return Point{0, -t, 0};
                  },
                  7},
                 {{0, {}, 1}}, 1, 2);
  const std::vector<double> u(2, 0.0);
  for (const double depth : {1e-6, 0.1, 2.0}) {
    EXPECT_NEAR(plane.work(u, 0.1, u, 0.3 + depth), 3.5 * depth * depth, 1e-14);
    EXPECT_NEAR(plane.work(u, 0.3 + depth, u, 0.1), -3.5 * depth * depth, 1e-14);
    EXPECT_NEAR(plane.work(u, 0.4, u, 0.4 + depth), plane.held(u, 0.4 + depth) - plane.held(u, 0.4), 1e-14);
  }
  EXPECT_EQ(plane.work(u, 0.1, u, 0.2), 0);
}

// Nodes stick where `advance` found them, it changes no force, and pulls them nowhere; frictionless ones
// slide.
TEST(Indenter, HoldsNodesThatStick) {
  for_all([](Problem& p) {
    const auto u = p.state(0.05);
    Problem fresh = std::move(p);
    const auto before = fresh.force(u, 0.6);
    fresh.indenter->advance(u, 0.6);
    EXPECT_EQ(fresh.force(u, 0.6), before);
  });
  const Shape plane = shapes()[2];
  for (const bool sticking : {false, true}) {
    Problem p(plane, sticking, 3, 1);
    const Vector3d normal(0.6, -0.8, 0), tangent(0.8, 0.6, 0);
    const double area = p.indenter->surface()[0].extent;
    const Point x = p.indenter->surface()[0].position;
    const auto at = [&](double depth, double aside) {  // relative to where the plane has come at time 1
      const Vector3d y = -depth * normal + aside * tangent + Vector3d(0.3, -0.2, 0);
      return std::vector<double>{y(0) - x[0], y(1) - x[1]};
    };
    p.indenter->advance(at(0.01, 0), 1);
    const auto f = p.force(at(0.02, 0.005), 1);
    const Vector3d expected = 7 * area * (0.02 * normal - (sticking ? 0.005 : 0) * tangent);
    EXPECT_NEAR(f[0], expected(0), 1e-14);
    EXPECT_NEAR(f[1], expected(1), 1e-14);
    // Off, and on again elsewhere: what was held when it came off is kept.
    p.indenter->advance(at(0.02, 0.005), 1);
    const double held = p.indenter->held(at(0.02, 0.005), 1);
    EXPECT_NEAR(held, 3.5 * area * (4e-4 + (sticking ? 2.5e-5 : 0)), 1e-14);
    EXPECT_EQ(p.indenter->held(at(-0.01, 0.1), 1), sticking ? held : 0);
    EXPECT_EQ(p.force(at(-0.01, 0.1), 1), std::vector<double>(2, 0.0));
    p.indenter->advance(at(-0.01, 0.1), 1);
    EXPECT_EQ(p.indenter->held(at(-0.01, 0.1), 1), sticking ? held : 0);
    p.indenter->advance(at(0, 0.2), 1);
    const auto again = p.force(at(0.02, 0.205), 1);
    EXPECT_NEAR(again[0], expected(0), 1e-14);
    EXPECT_NEAR(again[1], expected(1), 1e-14);
  }
}

// No node is stiffer than its bound, but for what curvature and fading add, which grows with the depth, and
// for what sticks to a round indenter: the sine of the angle by which it has slipped around, here up to 0.15.
TEST(Indenter, BoundsItsTangent) {
  for_all([](Problem& p) {
    const auto u = p.state(0.05);
    std::vector<double> bound(p.dofs, 0.0);
    p.indenter->stiffness_bound(u, 0.6, bound);
    TangentBlocks blocks;
    p.indenter->tangent(u, 0.6, blocks);
    const auto n = static_cast<Eigen::Index>(p.dofs / p.indenter->surface().size());
    for (std::size_t b = 0; b + 1 < blocks.begin.size(); ++b) {
      const std::size_t node = blocks.dofs[blocks.begin[b]];
      if (p.indenter->depth(node, u, 0.6) > 0.1) continue;
      const Eigen::MatrixXd block = Eigen::Map<const Eigen::MatrixXd>(
          blocks.values.data() + static_cast<Eigen::Index>(b) * n * n, n, n);
      double largest = 0;
      for (const std::size_t dof :
           std::span(blocks.dofs).subspan(blocks.begin[b], static_cast<std::size_t>(n)))
        largest = std::max(largest, bound[dof]);
      EXPECT_LT(block.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff(), 1.2 * largest);
    }
  });
}

// What is deeper than it ever stays has the tangent of a depth that it may have: forces are the same, the
// stiffness across, -g / R of the one along, is bounded.
TEST(Indenter, IsTameWhereNodesAreDeep) {
  const RigidSphere disc{{0, 1, 0}, 1};
  const auto tangent = [&](double depth, double deepest) {
    Indenter indenter({"punch", disc, [](double) { return Point{}; }, 7, false, 0.2, deepest},
                      {{0, {0, depth, 0}, 1}}, 1, 2);
    const std::vector<double> u(2, 0.0);
    std::vector<double> force(2, 0.0);
    indenter.add(u, {}, 0, force);
    EXPECT_NEAR(force[1], -7 * depth, 1e-14);
    TangentBlocks blocks;
    indenter.tangent(u, 0, blocks);
    EXPECT_NEAR(blocks.values[3], 7, 1e-14);
    return blocks.values[0];
  };
  EXPECT_NEAR(tangent(0.05, 0.1), -7 * 0.05 / 0.95, 1e-14);
  EXPECT_NEAR(tangent(0.5, 1), -7 * 0.5 / 0.5, 1e-14);
  EXPECT_NEAR(tangent(0.5, 0.1), -7 * 0.1 / 0.5, 1e-14);
}

}  // namespace
}  // namespace riven::testing
