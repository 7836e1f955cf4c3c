// Elements that relax, in time: a block that shakes in shear against the roots of its cubic, strains that are
// prescribed against the point's law, the energy balance, and runs that are resumed.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstring>
#include <functional>
#include <memory>
#include <unsupported/Eigen/MatrixFunctions>

#include "fem/finite_elements.hpp"
#include "material/viscoelastic.hpp"
#include "solver/generalised_alpha.hpp"
#include "solver/newton.hpp"
#include "solver/space_time.hpp"
#include "solver/velocity_verlet.hpp"
#include "support/differences.hpp"
#include "support/stopped_run.hpp"

namespace riven::testing {
namespace {

constexpr double kShear = 3, kShare = 0.6, kTime = 0.4, kDensity = 2;  // modulus (Pa), time (s)

std::unique_ptr<FiniteElements> block(int along, Plane plane) {
  Material material{.name = "rubber", .law = MooneyRivlin{1, 0.5}, .density = kDensity};
  material.volumetric = Volumetric{50};
  material.relaxation = {{kShare, kTime}};
  return std::make_unique<FiniteElements>(
      make_mesh(ElementShape::q4, {along, along}, 0.1, [](const Point& x) { return x; }),
      FiniteElementsSettings{.materials = {material}, .plane = plane});
}

std::size_t entry(const FiniteElements& model, std::size_t axis, std::size_t node) {
  return axis * model.mesh().node.size() + node;
}

using Method =
    std::function<State(Model&, Constraints&, double h, double until, const std::vector<double>& u)>;

template <class Settings>
Settings in_time(double h, double until, const std::vector<double>& u) {
  Settings settings;
  settings.until = settings.every = settings.history_every = until;
  settings.step = h;
  settings.initial_u = u;
  return settings;
}

Method slabs(SlabKind scheme) {
  return [scheme](Model& model, Constraints& constraints, double h, double until, const auto& u) {
    auto settings = in_time<SpaceTimeSettings>(h, until, u);
    settings.scheme = scheme;
    settings.tolerance = 1e-10;
    Observer nobody;
    return march_slabs(model, constraints, settings, nobody);
  };
}

struct MethodCase {
  const char* name;
  Method run;
};

const std::vector<MethodCase>& methods() {
  static const std::vector<MethodCase> all = {
      {"TwoField", slabs(SlabKind::two_field)},
      {"SingleField", slabs(SlabKind::single_field)},
      {"GeneralisedAlpha",
       [](Model& model, Constraints& constraints, double h, double until, const auto& u) {
         auto settings = in_time<GeneralisedAlphaSettings>(h, until, u);
         settings.tolerance = 1e-10;
         Observer nobody;
         return generalised_alpha(model, constraints, settings, nobody);
       }},
      {"Verlet",
       [](Model& model, Constraints& constraints, double h, double until, const auto& u) {
         Observer nobody;
         return march(model, constraints, in_time<VelocityVerletSettings>(h, until, u), nobody);
       }},
  };
  return all;
}

/// One element, fixed below; its upper nodes move along x, together.
struct ShearBlock {
  ShearBlock() : model(block(1, Plane::strain)), constraints(model->dofs(), 1) {
    for (std::size_t node = 0; node < 4; ++node) {
      const bool upper = model->mesh().node[node][1] > 0.5;
      constraints.add({.slave = entry(*model, 1, node), .terms = {}});
      if (!upper) constraints.add({.slave = entry(*model, 0, node), .terms = {}});
      if (upper) top.push_back(entry(*model, 0, node));
    }
  }
  [[nodiscard]] std::vector<double> start(double amplitude) const {
    std::vector<double> u(model->dofs(), 0.0);
    for (const std::size_t i : top) u[i] = amplitude;
    return u;
  }
  std::unique_ptr<FiniteElements> model;
  Constraints constraints;
  std::vector<std::size_t> top;
};

/// u of m u'' + k (stays u + share h) = 0, h' + h/tau = u', from u = h = 1: half the block's mass moves, and
/// simple shear is linear but for the square of the amplitude.
double exact(double t) {
  const double k = kShear / (0.5 * kDensity);
  Eigen::Matrix3d a;
  a << 0, 1, 0, -k * (1 - kShare), 0, -k * kShare, 0, 1, -1 / kTime;
  return ((a * t).exp() * Eigen::Vector3d(1, 0, 1))(0);
}

class Shaking : public ::testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Methods, Shaking, ::testing::Range(std::size_t{0}, methods().size()),
                         [](const auto& row) { return methods()[row.param].name; });

TEST_P(Shaking, FollowsTheCubicToSecondOrder) {
  constexpr double kUntil = 3, kAmplitude = 1e-5;
  const auto error = [&](int steps) {
    ShearBlock shear;
    const State state = methods()[GetParam()].run(*shear.model, shear.constraints, kUntil / steps, kUntil,
                                                  shear.start(kAmplitude));
    return std::abs(state.u[shear.top.front()] / kAmplitude - exact(kUntil));
  };
  const double coarse = error(60), fine = error(120);  // some 40 steps a period and 80
  EXPECT_LT(fine, 3e-3);
  EXPECT_NEAR(coarse / fine, 4, 1);
}

/// All nodes of the rim move as the gradient I + t G says; those inside are free.
struct DrivenBlock {
  explicit DrivenBlock(std::function<double(double)> path, Plane plane = Plane::stress)
      : model(block(3, plane)), constraints(model->dofs(), 1) {
    for (std::size_t node = 0; node < model->mesh().node.size(); ++node) {
      const Point& x = model->mesh().node[node];
      if (x[0] > 0.01 && x[0] < 0.99 && x[1] > 0.01 && x[1] < 0.99) continue;
      for (std::size_t axis = 0; axis < 2; ++axis)
        constraints.add({.slave = entry(*model, axis, node),
                         .terms = {{[path, axis](const Point& at, double t) {
                                      return path(t) * (axis == 0 ? 0.4 * at[0] + 0.3 * at[1] : -0.1 * at[1]);
                                    },
                                    x, static_cast<int>(axis)}}});
    }
  }
  std::unique_ptr<FiniteElements> model;
  Constraints constraints;
};

SpaceTimeSettings at_rest(double h, double until, SlabKind scheme = SlabKind::two_field) {
  auto settings = in_time<SpaceTimeSettings>(h, until, {});
  settings.scheme = scheme;
  settings.inertia = false;
  settings.rest_tolerance = 1e-10;
  settings.tolerance = 1e-10;
  return settings;
}

/// Work that goes into the block over a path, from the law alone in very small steps.
double work_of_point(const std::function<double(double)>& path, double until) {
  Material material{.name = "rubber", .law = MooneyRivlin{1, 0.5}};
  material.volumetric = Volumetric{50};
  material.relaxation = {{kShare, kTime}};
  const Viscoelastic law(material);
  std::vector<double> memory(law.memory()), next = memory;
  law.forget(memory.data());
  constexpr int kSteps = 4000;
  double work = 0;
  for (int n = 0; n <= kSteps; ++n) {
    const double t = until * n / kSteps, dt = n == 0 ? 0 : until / kSteps;
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f(0, 0) += 0.4 * path(t);
    f(0, 1) += 0.3 * path(t);
    f(1, 1) -= 0.1 * path(t);
    f(2, 2) = law.thickness_stretch(f.topLeftCorner<2, 2>(), law.step(memory.data(), dt));
    work = law.remember(memory.data(), dt, f, next.data());
    memory.swap(next);
  }
  return 0.1 * work;  // the block's volume
}

TEST(ViscoelasticRest, TakesUpTheWorkOfThePoint) {
  // A jump, a rise and a fall, without inertia. The slabs' steps are of second order in what is remembered.
  const auto path = [](double t) { return 0.5 + std::sin(2 * t); };
  const double expected = work_of_point(path, 2);
  for (const SlabKind scheme : {SlabKind::two_field, SlabKind::single_field}) {
    const auto error = [&](int slabs) {
      DrivenBlock driven(path);
      Observer nobody;
      const State state =
          march_slabs(*driven.model, driven.constraints, at_rest(2.0 / slabs, 2, scheme), nobody);
      // What the loads gave is what the body has: to the quadrature of the work in a slab.
      EXPECT_LT(std::abs(state.energy.error()), 2e-3);
      return std::abs(state.energy.strain / expected - 1);
    };
    const double coarse = error(20), fine = error(40);
    EXPECT_LT(fine, 2e-3);
    EXPECT_GT(coarse / fine, 3);
  }
}

TEST(ViscoelasticRest, IsTheLimitOfSlowMotion) {
  // What inertia does falls as the square of the time that a motion takes. Waves cross the block in 0.5 s.
  const auto difference = [](double time) {
    const auto path = [time](double t) { return 1 - std::exp(-4 * t * t / (time * time)); };
    DrivenBlock moving(path), resting(path);
    Observer nobody;
    auto settings = in_time<SpaceTimeSettings>(0.02 * time, time, {});
    settings.tolerance = 1e-10;
    const State in_motion = march_slabs(*moving.model, moving.constraints, settings, nobody);
    const State at_any_time =
        march_slabs(*resting.model, resting.constraints, at_rest(0.02 * time, time), nobody);
    EXPECT_EQ(at_any_time.energy.kinetic, 0);
    return relative_difference(in_motion.u, at_any_time.u);
  };
  const double fast = difference(5), slow = difference(20);
  EXPECT_LT(slow, std::pow(0.5 / 20, 2));
  EXPECT_GT(fast / slow, 8);
}

TEST(ViscoelasticResuming, ChangesNoBit) {
  using Run = std::function<State(DrivenBlock&, Observer&, const Snapshot*)>;
  const std::vector<Run> runs = {
      [](DrivenBlock& b, Observer& observer, const Snapshot* from) {
        return march_slabs(*b.model, b.constraints, at_rest(0.1, 2), observer, from);
      },
      [](DrivenBlock& b, Observer& observer, const Snapshot* from) {
        return march_slabs(*b.model, b.constraints,
                           in_time<SpaceTimeSettings>(0.1, 2, std::vector<double>(b.model->dofs(), 0.0)),
                           observer, from);
      },
      [](DrivenBlock& b, Observer& observer, const Snapshot* from) {
        return generalised_alpha(*b.model, b.constraints, in_time<GeneralisedAlphaSettings>(0.1, 2, {}),
                                 observer, from);
      },
      [](DrivenBlock& b, Observer& observer, const Snapshot* from) {
        return march(*b.model, b.constraints, in_time<VelocityVerletSettings>(0.01, 0.3, {}), observer, from);
      }};
  const auto path = [](double t) { return 0.3 * std::sin(2 * t); };
  for (std::size_t n = 0; n < runs.size(); ++n) {
    SCOPED_TRACE(n);
    DrivenBlock whole(path);
    Observer nobody;
    const State expected = runs[n](whole, nobody, nullptr);
    StopsAt<> watch;
    watch.stop_at = 7;
    DrivenBlock stopped(path);
    EXPECT_THROW(runs[n](stopped, watch, nullptr), Stopped);
    DrivenBlock resumed(path);
    const State state = runs[n](resumed, nobody, &watch.snapshot);
    EXPECT_EQ(std::memcmp(state.u.data(), expected.u.data(), state.u.size() * sizeof(double)), 0);
    EXPECT_EQ(state.energy.strain, expected.energy.strain);
  }
}

}  // namespace
}  // namespace riven::testing
