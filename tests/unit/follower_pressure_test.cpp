// Pressure that follows the body: force, tangent and work against what they are derived from, and the
// inflation of a thick ring.

#include "load/follower_pressure.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <numbers>

#include "support/finite_element_bodies.hpp"
#include "support/tangents.hpp"

namespace riven::testing {
namespace {

using Eigen::VectorXd;

std::vector<PressedSide> sides_of(const MeshBody& mesh, const std::vector<std::size_t>& edges) {
  std::vector<PressedSide> sides;
  for (const std::size_t edge : edges)
    for (const Side& side : mesh.sides(edge)) sides.push_back({side.node});
  return sides;
}

FollowerPressure pressure_on(const MeshBody& mesh, const std::vector<std::size_t>& edges,
                             LoadFunction pressure) {
  return {std::move(pressure), sides_of(mesh, edges), mesh.node, mesh.dimension(), mesh.thickness};
}

std::vector<std::size_t> all_faces(const MeshBody& mesh) {
  return mesh.dimension() == 2 ? std::vector<std::size_t>{0, 1, 2, 3}
                               : std::vector<std::size_t>{0, 1, 2, 3, 4, 5};
}

VectorXd force_of(FollowerPressure& load, const std::vector<double>& u, double parameter = 1) {
  VectorXd force = VectorXd::Zero(static_cast<Eigen::Index>(u.size()));
  load.add(u, {}, parameter, {force.data(), u.size()});
  return force;
}

Eigen::MatrixXd tangent_of(const FollowerPressure& load, const std::vector<double>& u, double parameter = 1) {
  TangentBlocks blocks;
  load.tangent(u, parameter, blocks);
  return sum_of(blocks, u.size());
}

VectorXd difference(FollowerPressure& load, const std::vector<double>& u,
                    const std::vector<double>& direction) {
  return derivative(
      [&](double t) {
        std::vector<double> moved = u;
        for (std::size_t i = 0; i < u.size(); ++i) moved[i] += t * direction[i];
        return force_of(load, moved);
      },
      0, 1e-4);
}

/// Volume (m^3) of the deformed elements, by their own quadrature: integral of J.
double volume_of(const MeshBody& mesh, const std::vector<double>& u) {
  return with_element(mesh.shape, [&]<class E>(E) {
    double volume = 0;
    for (std::size_t e = 0; e < mesh.elements(); ++e) {
      Eigen::Matrix<double, E::N, E::D> x;
      for (int a = 0; a < E::N; ++a)
        for (int d = 0; d < E::D; ++d) {
          const auto axis = static_cast<std::size_t>(d),
                     node = std::size_t{mesh.nodes(e)[static_cast<std::size_t>(a)]};
          x(a, d) = mesh.node[node][axis] + u[axis * mesh.node.size() + node];
        }
      for (const auto& point : E::rule())
        volume += point.weight * (x.transpose() * E::at(point.at).slope).determinant() *
                  (E::D == 2 ? mesh.thickness : 1);
    }
    return volume;
  });
}

struct Deformed {
  MeshBody mesh;
  std::vector<double> u, direction;

  Deformed(ElementShape shape, Random& random) : mesh(distorted(shape, random)) {
    if (mesh.dimension() == 3) mesh.thickness = 1;
    const Eigen::Matrix3d g = random_gradient_in(random, mesh.dimension(), 0.3);
    for (std::size_t d = 0; d < static_cast<std::size_t>(mesh.dimension()); ++d)
      for (const Point& x : mesh.node) {
        u.push_back(g.row(static_cast<Eigen::Index>(d)).dot(Eigen::Vector3d(x.data())) +
                    random.between(-0.03, 0.03));
        direction.push_back(random.between(-1, 1));
      }
  }
};

// A constant pressure all round has the energy p V: its force is that of the volume, exactly.
TEST(FollowerPressure, AllRoundIsTheGradientOfTheVolume) {
  Random random(1);
  for (const ElementShape shape : element_shapes()) {
    const Deformed body(shape, random);
    FollowerPressure load =
        pressure_on(body.mesh, all_faces(body.mesh), [](const Point&, double) { return 2.5; });
    const auto volume = [&](double t) {
      std::vector<double> moved = body.u;
      for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += t * body.direction[i];
      return volume_of(body.mesh, moved);
    };
    const VectorXd force = force_of(load, body.u);
    const double power = force.dot(Eigen::Map<const VectorXd>(body.direction.data(), force.size()));
    EXPECT_NEAR(power, -2.5 * derivative(volume, 0, 1e-3), 1e-9 * force.norm()) << name_of(shape);
    // No net force, no moment.
    const auto nodes = static_cast<Eigen::Index>(body.mesh.node.size());
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), moment = sum;
    for (Eigen::Index n = 0; n < nodes; ++n) {
      Eigen::Vector3d f = Eigen::Vector3d::Zero(), x(body.mesh.node[static_cast<std::size_t>(n)].data());
      for (int d = 0; d < body.mesh.dimension(); ++d) {
        f(d) = force(d * nodes + n);
        x(d) += body.u[static_cast<std::size_t>(d * nodes + n)];
      }
      sum += f;
      moment += x.cross(f);
    }
    EXPECT_LT(sum.norm() + moment.norm(), 1e-14 * static_cast<double>(nodes) * force.norm())
        << name_of(shape);
    const Point total = load.total(body.u, 1);
    EXPECT_LT(Eigen::Vector3d(total.data()).norm(), 1e-13 * force.norm());
  }
}

// On a closed surface the tangent is symmetric, so that the symmetric part is all of it.
TEST(FollowerPressure, AllRoundHasTheTangentOfItsForce) {
  Random random(2);
  for (const ElementShape shape : element_shapes()) {
    const Deformed body(shape, random);
    FollowerPressure load =
        pressure_on(body.mesh, all_faces(body.mesh), [](const Point&, double) { return 2.5; });
    const VectorXd change = difference(load, body.u, body.direction);
    const VectorXd product =
        tangent_of(load, body.u) * Eigen::Map<const VectorXd>(body.direction.data(), change.size());
    EXPECT_LT((change + product).cwiseAbs().maxCoeff(), 1e-9 * product.cwiseAbs().maxCoeff())
        << name_of(shape);
  }
}

// On one edge, and where the pressure changes over it, it is the symmetric part of the derivative.
TEST(FollowerPressure, HasTheSymmetricPartOfTheTangent) {
  Random random(3);
  for (const ElementShape shape : {ElementShape::q4, ElementShape::q8, ElementShape::t4, ElementShape::h8}) {
    const Deformed body(shape, random);
    FollowerPressure load = pressure_on(
        body.mesh, {1}, [](const Point& x, double t) { return (1 + x[1] * x[1] + 0.3 * x[2]) * t; });
    const auto size = static_cast<Eigen::Index>(body.u.size());
    Eigen::MatrixXd whole(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      std::vector<double> unit(body.u.size(), 0.0);
      unit[static_cast<std::size_t>(i)] = 1;
      whole.col(i) = -difference(load, body.u, unit);
    }
    const Eigen::MatrixXd k = tangent_of(load, body.u);
    EXPECT_LT((k - 0.5 * (whole + whole.transpose())).norm(), 1e-9 * k.norm()) << name_of(shape);
    EXPECT_GT((whole - whole.transpose()).norm(), 1e-3 * k.norm());  // there is another part
  }
}

TEST(FollowerPressure, WorksByTheVolumeItSweeps) {
  Random random(4);
  for (const ElementShape shape : element_shapes()) {
    const Deformed body(shape, random);
    const FollowerPressure load =
        pressure_on(body.mesh, all_faces(body.mesh), [](const Point&, double t) { return 2.5 * t; });
    const std::vector<double> rest(body.u.size(), 0.0);
    const double before = volume_of(body.mesh, rest), after = volume_of(body.mesh, body.u);
    EXPECT_NEAR(load.work(rest, 2, body.u, 2), -5 * (after - before), 1e-12 * std::abs(after))
        << name_of(shape);
    // A pressure that grows by the way: Simpson's rule in many steps.
    double sum = 0;
    constexpr int kSteps = 200;
    std::vector<double> at(rest);
    double last = before;
    for (int n = 1; n <= kSteps; ++n) {
      for (std::size_t i = 0; i < at.size(); ++i) at[i] = body.u[i] * n / kSteps;
      const double here = volume_of(body.mesh, at);
      sum -= 2.5 * (1 + (n - 0.5) / kSteps) * (here - last);
      last = here;
    }
    EXPECT_NEAR(load.work(rest, 1, body.u, 2), sum, 1e-4 * std::abs(sum));  // midpoints: second order
  }
}

// On a flat edge at rest it is a traction against the normal.
TEST(FollowerPressure, PressesIntoTheBody) {
  for (const ElementShape shape : element_shapes()) {
    const MeshBody mesh =
        make_mesh(shape, dimension_of(shape) == 3 ? std::vector{2, 2, 2} : std::vector{2, 2}, 0.5,
                  [](const Point& x) { return x; });
    const std::vector<double> rest(mesh.node.size() * static_cast<std::size_t>(mesh.dimension()), 0.0);
    for (const std::size_t face : all_faces(mesh)) {
      const FollowerPressure load = pressure_on(mesh, {face}, [](const Point&, double t) { return 3 * t; });
      Point expected{};
      expected[face / 2] = (face % 2 == 0 ? 1 : -1) * 6 * (mesh.dimension() == 2 ? 0.5 : 1);
      const Point total = load.total(rest, 2);
      for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(total[d], expected[d], 1e-14);
    }
    // 1 + 6 y on the right face, with the shape functions as weights: 4 in the mean, moment of the y 1/2 + 2.
    FollowerPressure load = pressure_on(mesh, {1}, [](const Point& x, double) { return 1 + 6 * x[1]; });
    const VectorXd force = force_of(load, rest);
    double sum = 0, moment = 0;
    for (std::size_t n = 0; n < mesh.node.size(); ++n) {
      sum += force(static_cast<Eigen::Index>(n));
      moment += mesh.node[n][1] * force(static_cast<Eigen::Index>(n));
    }
    const double across = mesh.dimension() == 2 ? 0.5 : 1;
    EXPECT_NEAR(sum, -4 * across, 1e-13) << name_of(shape);
    EXPECT_NEAR(moment, -2.5 * across, 1e-13) << name_of(shape);
  }
}

// ---- inflation of a thick ring in plane strain ----

constexpr double kInner = 1, kOuter = 2, kShear = 1;

/// Pressure that opens an incompressible neo-Hookean ring to the inner radius a: with c = a^2 - A^2 the
/// integral of mu (r^2/(r^2 - c) - (r^2 - c)/r^2) / r from a to b.
double ring_pressure(double a) {
  const double c = a * a - kInner * kInner, b = std::sqrt(kOuter * kOuter + c);
  return kShear * (std::log(kOuter / kInner) - std::log(b / a) + 0.5 * c * (1 / (a * a) - 1 / (b * b)));
}

/// A quarter of it under pressure inside, held at its two straight ends (in space across its thickness too),
/// by full Newton steps; norms of their increments.
struct Ring {
  std::unique_ptr<FiniteElements> model;
  std::vector<double> u;
  std::vector<double> increments;

  Ring(ElementShape shape, int radial, double pressure, double bulk) {
    const bool in_space = dimension_of(shape) == 3;
    std::vector<int> along{radial, 2 * radial};
    if (in_space) along.push_back(1);
    const auto map = [](const Point& x) {
      const double r = kInner + x[0] * (kOuter - kInner), angle = 0.5 * std::numbers::pi * x[1];
      return Point{r * std::cos(angle), r * std::sin(angle), 0.2 * x[2]};
    };
    const Material rubber{
        .name = "rubber", .law = NeoHookean{kShear / 2}, .density = 1, .volumetric = Volumetric{bulk}};
    model = elements_of(make_mesh(shape, along, 1, map), rubber, Plane::strain);
    FollowerPressure load = pressure_on(model->mesh(), {0}, [](const Point&, double t) { return t; });
    const std::size_t nodes = model->points();
    std::vector<bool> held(model->dofs(), false);
    for (const std::uint32_t n : model->mesh().nodes_on(2)) held[nodes + n] = true;
    for (const std::uint32_t n : model->mesh().nodes_on(3)) held[n] = true;
    for (std::size_t n = 0; n < nodes && in_space; ++n) held[2 * nodes + n] = true;
    u.assign(model->dofs(), 0.0);
    constexpr int kSteps = 4;
    for (int step = 1; step <= kSteps; ++step) {
      increments.clear();
      do {
        iterate(load, held, pressure * step / kSteps);
      } while (increments.back() > 1e-13 && increments.size() < 20);
    }
  }

  [[nodiscard]] double inner_radius() const {
    const std::uint32_t node = model->mesh().nodes_on(0)[0];  // on the x axis
    return model->mesh().node[node][0] + u[node];
  }

 private:
  void iterate(FollowerPressure& load, const std::vector<bool>& held, double pressure) {
    const auto size = static_cast<Eigen::Index>(u.size());
    VectorXd residual = force_of(load, u, pressure);
    const std::vector<double> inner = force_in(*model, u);
    residual += Eigen::Map<const VectorXd>(inner.data(), size);
    Eigen::MatrixXd k = assembled(*model, u) + tangent_of(load, u, pressure);
    for (Eigen::Index i = 0; i < size; ++i)
      if (held[static_cast<std::size_t>(i)]) {
        residual(i) = 0;
        k.row(i).setZero();
        k.col(i).setZero();
        k(i, i) = 1;
      }
    const VectorXd step = k.ldlt().solve(residual);
    for (std::size_t i = 0; i < u.size(); ++i) u[i] += step(static_cast<Eigen::Index>(i));
    increments.push_back(step.norm() / std::sqrt(static_cast<double>(size)));
  }
};

TEST(FollowerPressure, InflatesAThickRing) {
  const double a = 1.5 * kInner, pressure = ring_pressure(a);
  // Of second order in the size: 1.49644, 1.49912 measured; the bulk modulus of 1e5 changes 1e-5 of it.
  const double coarse = Ring(ElementShape::q4, 4, pressure, 1e5).inner_radius(),
               fine = Ring(ElementShape::q4, 8, pressure, 1e5).inner_radius();
  EXPECT_LT(std::abs(fine - a), 0.3 * std::abs(coarse - a));
  EXPECT_NEAR(fine, a, 0.005 * a);
  const double q8 = Ring(ElementShape::q8, 4, pressure, 1e5).inner_radius();
  EXPECT_NEAR(q8, a, 0.001 * a);  // 1.50030 with one mean per element
  const double h8 = Ring(ElementShape::h8, 4, pressure, 1e5).inner_radius();
  EXPECT_NEAR(h8, coarse, 1e-9 * a);  // one layer that is held across is plane strain
}

// Ends of the pressed edge slide on walls across it: there the load has an energy, and Newton's method the
// whole tangent.
TEST(FollowerPressure, LetsNewtonConvergeQuadratically) {
  for (const ElementShape shape : {ElementShape::q4, ElementShape::q8, ElementShape::h8}) {
    const Ring ring(shape, 2, 0.3, 100);
    ASSERT_GE(ring.increments.size(), 3U);
    EXPECT_LE(ring.increments.size(), 6U);
    std::size_t seen = 0;
    for (std::size_t n = 0; n + 1 < ring.increments.size(); ++n) {
      const double now = ring.increments[n], next = ring.increments[n + 1];
      if (now > 0.1 || next < 1e-14) continue;
      // The stiffness changes by about bulk over shear modulus along a displacement of the ring's size.
      EXPECT_LT(next, 100 * now * now) << name_of(shape);  // up to 33 measured
      ++seen;
    }
    EXPECT_GE(seen, 2U);
  }
}

}  // namespace
}  // namespace riven::testing
