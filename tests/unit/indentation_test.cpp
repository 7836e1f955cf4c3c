// Blocks of finite elements under rigid indenters, against closed forms and balances.

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "solver/dynamic_relaxation.hpp"
#include "solver/generalised_alpha.hpp"
#include "solver/space_time.hpp"
#include "solver/velocity_verlet.hpp"
#include "support/indenters.hpp"

namespace riven::testing {
namespace {

using Eigen::Matrix2d;

Material rubber(double density = 1) {
  Material material{"rubber", MooneyRivlin{0.4, 0.1}, density};
  material.volumetric = Volumetric{30, Volumetric::Form::quadratic};
  return material;
}

Material solid(double poissons_ratio) {
  return {"solid", LinearElastic{{1, poissons_ratio}}, 1};
}

/// The nominal stress of a sheet that is pressed to a stretch along y, free along x, from the law alone.
double uniaxial_stress(const Material& material, double stretch) {
  double low = 0.5, high = 3;
  Matrix2d f = stretch * Matrix2d::Identity();
  for (int n = 0; n < 60; ++n) {
    f(0, 0) = 0.5 * (low + high);
    (material.plane_stress(f).stress(0, 0) < 0 ? low : high) = f(0, 0);
  }
  return material.plane_stress(f).stress(1, 1);
}

// A plane wider than the block presses it evenly; it goes in by pressure over stiffness, so that the stretch
// is known but for one number that the law gives.
TEST(Indentation, OfAPlaneIsUniaxialCompression) {
  Random random(1);
  for (const ElementShape shape : {ElementShape::t3, ElementShape::q4, ElementShape::q8})
    for (const double stiffness : {50.0, 5e3}) {
      SCOPED_TRACE(name_of(shape));
      const auto model = elements_of(distorted(shape, random, false), rubber(), Plane::stress);
      const MeshBody& mesh = model->mesh();
      Constraints constraints(model->dofs(), 7);
      hold(constraints, mesh, 0, {0});
      hold(constraints, mesh, 2, {1});
      const auto indenter = indenter_on(
          mesh, {.shape = RigidPlane{{0, 1, 0}, {0, -1, 0}}, .way = down(0.3), .stiffness = stiffness});
      const State state = indented(*model, constraints, indenter);
      const double depth = indenter->depth(0, state.u, 2), stretch = 0.7 + depth;
      const double pressure = -uniaxial_stress(rubber(), stretch);
      EXPECT_NEAR(depth, pressure / stiffness, 1e-9);  // the tolerance of the equilibrium over the stiffness
      EXPECT_NEAR(indenter->force_on(state.u, 2)[1], 0.7 * pressure, 1e-8);  // thickness 0.7
      for (std::size_t n = 0; n < mesh.node.size(); ++n)
        EXPECT_NEAR(state.u[mesh.node.size() + n], (stretch - 1) * mesh.node[n][1], 1e-8);
    }
}

// ---- Hertz ----

/// Half of a block of 40 by 40 contact widths, symmetric to x = 0, with small elements at the contact.
MeshBody half_space(int along) {
  const auto graded = [](double s) { return 40 * std::sinh(5 * s) / std::sinh(5.0); };
  return make_mesh(ElementShape::q4, {along, along}, 1, [&](const Point& x) {
    return Point{graded(x[0]), -graded(1 - x[1]), 0};
  });
}

/// The force per area of the nodes of the top, in the order of their x, and moments of it.
struct Pressure {
  Pressure(const FiniteElements& model, Indenter& indenter, const State& state) {
    std::vector<double> force(model.dofs(), 0.0);
    indenter.add(state.u, {}, state.parameter, force);
    for (const LoadShare& share : indenter.surface()) {
      const double f = -force[model.points() + share.point];
      at.push_back(share.position[0]);
      value.push_back(f / share.extent);
      area.push_back(share.extent);
      total += f;
      second += f * share.position[0] * share.position[0];
    }
  }
  std::vector<double> at, value, area;
  double total = 0, second = 0;
};

/// Presses the upper left of a half space; sides far away are held.
State press(FiniteElements& model, const std::shared_ptr<Indenter>& indenter) {
  Constraints constraints(model.dofs(), 7);
  hold(constraints, model.mesh(), 0, {0});
  hold(constraints, model.mesh(), 1, {0});
  hold(constraints, model.mesh(), 2, {0, 1});
  return indented(model, constraints, indenter, 0.5);
}

// A cylinder of radius 100 on a half space: p = p0 sqrt(1 - x^2/a^2), a^2 = 4 P R / (pi E*), p0 = 2 P / (pi
// a), with P of both halves. That holds for whatever force the finite block answers with; a^2/R^2 = 1e-4 and
// a^2/40^2 = 6e-4 are left out.
TEST(Indentation, OfACylinderIsHertzs) {
  constexpr double radius = 100, poisson = 0.3;
  const auto model = elements_of(half_space(48), solid(poisson), Plane::strain, Dilatation::full);
  const auto indenter = indenter_on(
      model->mesh(), {.shape = RigidSphere{{0, radius, 0}, radius}, .way = down(0.025), .stiffness = 1e3});
  const State state = press(*model, indenter);
  const Pressure pressure(*model, *indenter, state);
  const double modulus = 1 / (1 - poisson * poisson), force = 2 * pressure.total;
  const double a = std::sqrt(4 * force * radius / (std::numbers::pi * modulus));
  EXPECT_GT(a, 1);  // or the elements, 0.055 wide, are too few
  // The moment is a^2 / 4 of the force; it and the peak see elements to the square: measured 0.12 and 0.16 %.
  EXPECT_NEAR(2 * std::sqrt(pressure.second / pressure.total), a, 0.005 * a);
  EXPECT_NEAR(pressure.value[0], 2 * force / (std::numbers::pi * a), 0.005 * pressure.value[0]);
  for (std::size_t n = 0; n < pressure.at.size(); ++n)
    if (pressure.at[n] < 0.9 * a) {
      EXPECT_NEAR(pressure.value[n],
                  2 * force / (std::numbers::pi * a) * std::sqrt(1 - std::pow(pressure.at[n] / a, 2)),
                  0.02 * pressure.value[0])
          << pressure.at[n];
    }
}

// A frictionless flat: p = P / (pi sqrt(a^2 - x^2)), with P of both halves. In the mesh the pressure ends
// between the last node of the flat and the middle of the next side. One that sticks is stiffer, here, at
// Poisson's ratio 0.3, by a few per cent.
TEST(Indentation, OfAFlatHasItsPressureAtTheEnds) {
  double forces[2] = {};
  for (const bool sticking : {false, true}) {
    const auto model = elements_of(half_space(48), solid(0.3), Plane::strain, Dilatation::full);
    const double end = model->mesh().node[model->mesh().nodes_on(3)[16]][0];
    const auto indenter = indenter_on(model->mesh(), {.shape = RigidFlat{{-end, 0, 0}, {end, 0, 0}, 1e-3},
                                                      .way = down(0.01),
                                                      .stiffness = 1e4,
                                                      .sticking = sticking});
    const State state = press(*model, indenter);
    const Pressure pressure(*model, *indenter, state);
    forces[sticking ? 1 : 0] = pressure.total;
    double contact = 0;
    for (std::size_t n = 0; n < pressure.at.size(); ++n)
      if (pressure.value[n] > 0) contact += pressure.area[n];
    EXPECT_GT(contact, end);
    EXPECT_LT(contact, 1.07 * end);
    for (std::size_t n = 0; n < pressure.at.size() && !sticking; ++n) {
      if (pressure.at[n] > 0.7 * end) continue;
      const auto closed = [&](double a) {
        return 2 * pressure.total / (std::numbers::pi * std::sqrt(a * a - std::pow(pressure.at[n], 2)));
      };
      EXPECT_LT(pressure.value[n], closed(end));
      EXPECT_GT(pressure.value[n], closed(contact));
    }
  }
  EXPECT_GT(forces[1], 1.01 * forces[0]);
  EXPECT_LT(forces[1], 1.1 * forces[0]);
}

// ---- symmetry, rotation, methods ----

struct Turned {
  explicit Turned(double angle, ElementShape shape = ElementShape::q4) : turn(angle) {
    const Eigen::Rotation2Dd r(angle);
    model = elements_of(make_mesh(shape, {12, 6}, 1,
                                  [&](const Point& x) {
                                    const Eigen::Vector2d y = r * Eigen::Vector2d(2 * x[0] - 1, x[1] - 1);
                                    return Point{y(0), y(1), 0};
                                  }),
                        rubber(), Plane::stress);
    hold(constraints.emplace(model->dofs(), 7), model->mesh(), 2, {0, 1});
  }
  [[nodiscard]] Point at(double x, double y) const {
    const Eigen::Vector2d z = Eigen::Rotation2Dd(turn) * Eigen::Vector2d(x, y);
    return {z(0), z(1), 0};
  }
  [[nodiscard]] std::function<Point(double)> down(double depth) const {
    return [*this, depth](double stretch) { return at(0, -depth * (stretch - 1)); };
  }
  /// In the directions of the body.
  [[nodiscard]] Eigen::Vector2d displacement(const State& state, std::size_t node) const {
    return Eigen::Rotation2Dd(-turn) * Eigen::Vector2d(state.u[node], state.u[model->points() + node]);
  }
  double turn;
  std::shared_ptr<FiniteElements> model;
  std::optional<Constraints> constraints;
};

std::shared_ptr<Indenter> flat_on(const Turned& body, bool sticking, double depth = 0.2) {
  return indenter_on(body.model->mesh(), {.shape = RigidFlat{body.at(-0.5, 0), body.at(0.5, 0), 0.04},
                                          .way = body.down(depth),
                                          .stiffness = 200,
                                          .sticking = sticking,
                                          .spacing = 0.17});
}

std::shared_ptr<Indenter> disc_on(const Turned& body, bool sticking, double depth = 0.2) {
  return indenter_on(body.model->mesh(), {.shape = RigidSphere{body.at(0, 0.8), 0.8},
                                          .way = body.down(depth),
                                          .stiffness = 200,
                                          .sticking = sticking,
                                          .spacing = 0.17});
}

TEST(Indentation, TurnsWithItsSetUpAndIsSymmetric) {
  for (const auto make : {flat_on, disc_on})
    for (const bool sticking : {false, true}) {
      Turned upright(0), turned(2.1);
      const State one = indented(*upright.model, *upright.constraints, make(upright, sticking, 0.2)),
                  other = indented(*turned.model, *turned.constraints, make(turned, sticking, 0.2));
      const auto& node = upright.model->mesh().node;
      double largest = 0;
      for (std::size_t n = 0; n < node.size(); ++n) {
        const Eigen::Vector2d u = upright.displacement(one, n);
        largest = std::max(largest, u.norm());
        EXPECT_LT((turned.displacement(other, n) - u).norm(), 1e-9);
        for (std::size_t m = 0; m < node.size(); ++m)
          if (std::abs(node[m][0] + node[n][0]) < 1e-9 && std::abs(node[m][1] - node[n][1]) < 1e-9) {
            EXPECT_LT((upright.displacement(one, m) - Eigen::Vector2d(-u(0), u(1))).norm(), 1e-9);
          }
      }
      EXPECT_GT(largest, 0.15);
    }
}

// Nodes under a plane that sticks move with it; where it does not they bulge, and it is softer for that.
TEST(Indentation, IsStifferWhereItSticks) {
  std::array<double, 2> force{}, bulge{};
  for (const bool sticking : {false, true}) {
    Turned body(0);
    const auto plane = indenter_on(body.model->mesh(), {.shape = RigidPlane{{0, 0, 0}, {0, -1, 0}},
                                                        .way = body.down(0.2),
                                                        .stiffness = 200,
                                                        .sticking = sticking});
    const State state = indented(*body.model, *body.constraints, plane);
    force[sticking ? 1 : 0] = plane->force_on(state.u, 2)[1];
    for (const LoadShare& share : plane->surface())
      bulge[sticking ? 1 : 0] = std::max(bulge[sticking ? 1 : 0], std::abs(state.u[share.point]));
  }
  EXPECT_GT(force[1], 1.05 * force[0]);  // measured 1.09
  EXPECT_GT(bulge[0], 0.05);
  EXPECT_LT(bulge[1], 0.01);
}

// Where nothing slides before it sticks: then a path depends on its steps.
TEST(Indentation, IsTheSameByRelaxationAndNewton) {
  for (const auto& [make, sticking] : {std::pair{&flat_on, true}, std::pair{&disc_on, false}}) {
    Turned one(0), other(0);
    const auto first = make(one, sticking, 0.2), second = make(other, sticking, 0.2);
    Observer nobody;
    LoadStepSettings settings{.targets = {2}, .increment = 0.25, .tolerance = 1e-7};
    settings.external = {first};
    const State relaxed = relax(*one.model, *one.constraints, settings, nobody);
    const State newtons = indented(*other.model, *other.constraints, second);
    EXPECT_NEAR(first->force_on(relaxed.u, 2)[1], second->force_on(newtons.u, 2)[1], 1e-5);
  }
}

// The work is that of the trapezoidal rule over load steps: of second order.
TEST(Indentation, KeepsTheBalanceInStatics) {
  for (const bool sticking : {false, true}) {
    const auto error = [&](double increment) {
      Turned body(0);
      const State state = indented(*body.model, *body.constraints, disc_on(body, sticking), increment);
      EXPECT_GT(state.energy.held, 0.001 * state.energy.strain);
      return std::abs(state.energy.error());
    };
    EXPECT_LT(error(0.05), 2e-3);
    EXPECT_LT(error(0.05), 0.5 * error(0.1));
  }
}

TEST(Indentation, OfASphereIsBalancedInSpace) {
  const auto model = elements_of(make_mesh(ElementShape::h8, {6, 6, 3}, 1,
                                           [](const Point& x) {
                                             return Point{2 * x[0] - 1, 2 * x[1] - 1, x[2] - 1};
                                           }),
                                 rubber(), Plane::strain);
  Constraints constraints(model->dofs(), 7);
  hold(constraints, model->mesh(), 4, {0, 1, 2});
  const auto indenter = indenter_on(model->mesh(),
                                    {.shape = RigidSphere{{0, 0, 1}, 1},
                                     .way =
                                         [](double s) {
                                           return Point{0, 0, -0.1 * (s - 1)};
                                         },
                                     .stiffness = 200,
                                     .sticking = true,
                                     .spacing = 0.33},
                                    {5});
  const State state = indented(*model, constraints, indenter);
  const Point force = indenter->force_on(state.u, 2);
  EXPECT_GT(force[2], 0.01);
  EXPECT_NEAR(constraints.reaction(4)[2], force[2], 1e-8 * force[2]);
  EXPECT_NEAR(force[0], 0, 1e-8 * force[2]);
  EXPECT_NEAR(force[1], 0, 1e-8 * force[2]);
}

// ---- motion ----

/// In and out again: (1 - cos) / 2 of the depth in a time of 2.
std::function<Point(double)> in_and_out(double depth) {
  return [depth](double t) { return Point{0, -0.5 * depth * (1 - std::cos(std::numbers::pi * t)), 0}; };
}

std::shared_ptr<Indenter> striking(const Turned& body, bool sticking) {
  return indenter_on(body.model->mesh(), {.shape = RigidSphere{{0, 0.8, 0}, 0.8},
                                          .way = in_and_out(0.2),
                                          .stiffness = 20,
                                          .sticking = sticking,
                                          .spacing = 0.17});
}

/// Keeps the largest error of the balance (J).
class Balance : public Observer {
 public:
  void reached(const State& state, const Constraints&, bool) override {
    worst = std::max(worst, std::abs(state.energy.error() * state.energy.largest));
    largest = std::max(largest, state.energy.largest);
  }
  double worst = 0, largest = 0;
};

template <class Settings>
Settings motion(std::shared_ptr<Indenter> indenter, double step) {
  Settings settings{};
  settings.until = 1.6;
  settings.every = settings.history_every = 0.1;
  settings.step = step;
  settings.external = {std::move(indenter)};
  return settings;
}

// Of second order, but for what nodes that stuck lose as they come off: it is known to the step before.
TEST(Indentation, ByVerletKeepsTheBalance) {
  for (const bool sticking : {false, true}) {
    const auto error = [&](double step) {
      Turned body(0);
      Balance balance;
      const auto indenter = striking(body, sticking);
      static_cast<void>(
          march(*body.model, *body.constraints, motion<VelocityVerletSettings>(indenter, step), balance));
      return balance.worst / balance.largest;
    };
    const double coarse = error(2e-3), fine = error(1e-3);
    EXPECT_LT(fine, sticking ? 1e-4 : 1e-5);  // measured 1.5e-5 and 1.9e-6
    EXPECT_LT(fine, (sticking ? 0.7 : 0.3) * coarse);
  }
}

TEST(Indentation, ImplicitlyIsThatOfVerletAndKeepsTheBalance) {
  Turned body(0);
  Balance balance;
  const auto indenter = striking(body, false);
  const State expected =
      march(*body.model, *body.constraints, motion<VelocityVerletSettings>(indenter, 1e-3), balance);
  const auto compare = [&](const State& state, const Balance& own, double tolerance) {
    double difference = 0, size = 0;
    for (std::size_t i = 0; i < state.u.size(); ++i) {
      difference = std::max(difference, std::abs(state.u[i] - expected.u[i]));
      size = std::max(size, std::abs(expected.u[i]));
    }
    EXPECT_LT(difference, 10 * tolerance * size);
    EXPECT_LT(own.worst, tolerance * own.largest);
  };
  for (const SlabKind scheme : {SlabKind::two_field, SlabKind::single_field}) {
    Turned other(0);
    Balance own;
    auto settings = motion<SpaceTimeSettings>(striking(other, false), 0.02);
    settings.scheme = scheme;
    compare(march_slabs(*other.model, *other.constraints, settings, own), own,
            1e-3);  // measured 2e-3 and 1e-3, 4e-7 and 1e-9
  }
  Turned other(0);
  Balance own;
  auto settings = motion<GeneralisedAlphaSettings>(striking(other, false), 0.01);
  settings.spectral_radius = 0.9;
  compare(generalised_alpha(*other.model, *other.constraints, settings, own), own,
          1e-3);  // measured 4e-3, 5e-5
}

// A plane that comes from a little above keeps the face's end where it was, by every method, if it sticks.
TEST(Indentation, SticksByEveryMethod) {
  const auto aside = [](bool sticking, const auto& solve) {
    Turned body(0);
    Observer nobody;
    const auto plane = indenter_on(body.model->mesh(), {.shape = RigidPlane{{0, 0.02, 0}, {0, -1, 0}},
                                                        .way = in_and_out(0.2),
                                                        .stiffness = 200,
                                                        .sticking = sticking});
    const State state = solve(body, plane, nobody);
    double largest = 0;
    for (const LoadShare& share : plane->surface())
      largest = std::max(largest, std::abs(state.u[share.point]));
    return largest;
  };
  const auto verlet = [](Turned& body, std::shared_ptr<Indenter> indenter, Observer& nobody) {
    auto settings = motion<VelocityVerletSettings>(std::move(indenter), 1e-3);
    settings.until = 1;
    return march(*body.model, *body.constraints, settings, nobody);
  };
  const auto slabs = [](Turned& body, std::shared_ptr<Indenter> indenter, Observer& nobody) {
    auto settings = motion<SpaceTimeSettings>(std::move(indenter), 0.01);
    settings.until = 1;
    return march_slabs(*body.model, *body.constraints, settings, nobody);
  };
  const auto alpha = [](Turned& body, std::shared_ptr<Indenter> indenter, Observer& nobody) {
    auto settings = motion<GeneralisedAlphaSettings>(std::move(indenter), 0.01);
    settings.until = 1;
    return generalised_alpha(*body.model, *body.constraints, settings, nobody);
  };
  const auto statics = [](Turned& body, std::shared_ptr<Indenter> indenter, Observer& nobody) {
    LoadStepSettings settings{.targets = {1}, .start = 0, .increment = 0.02, .tolerance = 1e-9};
    settings.external = {std::move(indenter)};
    return newton(*body.model, *body.constraints, settings, nobody);
  };
  const auto expect = [&](const auto& solve, const char* name) {
    EXPECT_LT(aside(true, solve), 0.01) << name;
    EXPECT_GT(aside(false, solve), 0.05) << name;
  };
  expect(verlet, "verlet");
  expect(slabs, "slabs");
  expect(alpha, "alpha");
  expect(statics, "newton");
}

// ---- going on after a stop ----

/// Takes a snapshot at the n-th safe point.
class Stop : public Observer {
 public:
  explicit Stop(int at) : left_(at) {}
  void safe_point(const std::function<Snapshot()>& take) override {
    if (left_-- == 0) snapshot = take();
  }
  std::optional<Snapshot> snapshot;

 private:
  int left_;
};

TEST(Indentation, GoesOnWithTheSameBits) {
  const auto expect_same = [](const auto& solve, int at) {
    Stop stop(at);
    const State whole = solve(stop, nullptr);
    ASSERT_TRUE(stop.snapshot);
    Stop none(-1);
    const State resumed = solve(none, &*stop.snapshot);
    EXPECT_EQ(whole.u, resumed.u);
    EXPECT_EQ(whole.energy.external_work, resumed.energy.external_work);
    EXPECT_EQ(whole.energy.held, resumed.energy.held);
  };
  expect_same(
      [](Observer& observer, const Snapshot* from) {
        Turned body(0);
        return march(*body.model, *body.constraints,
                     motion<VelocityVerletSettings>(striking(body, true), 2e-3), observer, from);
      },
      500);
  // Factors that are kept are of what stuck when they were made.
  for (const int at : {3, 8, 12, 17}) {
    SCOPED_TRACE(at);
    expect_same(
        [](Observer& observer, const Snapshot* from) {
          Turned body(0);
          return march_slabs(*body.model, *body.constraints,
                             motion<SpaceTimeSettings>(striking(body, true), 0.05), observer, from);
        },
        at);
    expect_same(
        [](Observer& observer, const Snapshot* from) {
          Turned body(0);
          return generalised_alpha(*body.model, *body.constraints,
                                   motion<GeneralisedAlphaSettings>(striking(body, true), 0.05), observer,
                                   from);
        },
        at);
  }
  expect_same(
      [](Observer& observer, const Snapshot* from) {
        Turned body(0);
        LoadStepSettings settings{.targets = {2}, .increment = 0.25, .tolerance = 1e-9};
        settings.external = {disc_on(body, true)};
        return newton(*body.model, *body.constraints, settings, observer, from);
      },
      9);
}

}  // namespace
}  // namespace riven::testing
