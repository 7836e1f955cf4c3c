// Motion of PMB bodies: waves against the lattice's own and the continuum's dispersion, and the energy of a
// plate that breaks.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "load/mirror.hpp"
#include "solver/velocity_verlet.hpp"
#include "support/pmb_bodies.hpp"

namespace riven::testing {
namespace {

/// A bar of 2 m held at both ends, in its first mode: angular frequency from the displacement after a while.
struct Bar {
  double measured = 0, discrete = 0, continuum = 0;  // rad/s
};

Bar ring(int points, double horizon) {
  LatticeBodyInput in = cells_of({points}, horizon, Faces(0b11));
  in.spacing = 2.0 / points;
  in.horizon = horizon * in.spacing;
  in.shape = Box{{}, {1, 1, 1}};
  Pmb model(make_lattice_body(in), kGlass);
  const Body& body = model.body();
  Constraints constraints(model.dofs(), 7);
  std::array<std::optional<FaceLoad>, 6> held;
  for (std::size_t face = 0; face < 2; ++face) {
    held[face] = FaceLoad{.displacement = {}, .load = face};
    held[face]->displacement[0] = [](const Point&, double) { return 0.0; };
  }
  add_mirror_constraints(body, held, model.conservative(), constraints);

  const double k = std::numbers::pi / 2, amplitude = 1e-6;
  Bar bar;
  bar.continuum = k * std::sqrt(kGlass.youngs_modulus / kGlass.density);
  double squared = 0;
  const Stencil& stencil = body.on_lattice()->stencil;
  for (std::size_t n = 0; n < stencil.size(); ++n)
    squared += model.micromodulus() / kGlass.density * body.spacing * body.thickness / stencil.length[n] *
               (1 - std::cos(k * stencil.bond[n][0]));
  const double quarter = 0.25 * 2 * std::numbers::pi / bar.continuum;
  VelocityVerletSettings settings{
      .until = 5.2 * quarter, .every = 5.2 * quarter, .history_every = 5.2 * quarter};
  settings.step =
      settings.until /
      std::ceil(settings.until / (0.2 * stable_step(model, constraints, std::vector<double>(model.dofs()))));
  // Verlet's own frequency: sin(omega dt / 2) = omega_0 dt / 2.
  bar.discrete = 2 / *settings.step * std::asin(0.5 * *settings.step * std::sqrt(squared));
  settings.initial_u.assign(model.dofs(), 0.0);
  for (const std::size_t i : body.points)
    settings.initial_u[i] = amplitude * std::cos(k * body.position(i)[0]);
  Observer nobody;
  const State state = march(model, constraints, settings, nobody);
  // Between four and six quarter periods the cosine goes down from 1: the arc cosine is the phase beyond
  // four.
  double mode = 0, norm = 0;
  for (const std::size_t i : body.points) {
    const double shape = std::cos(k * body.position(i)[0]);
    mode += shape * state.u[i];
    norm += shape * shape;
  }
  bar.measured = (2 * std::numbers::pi + std::acos(mode / (amplitude * norm))) / settings.until;
  return bar;
}

TEST(PmbMotion, RingsAtTheFrequencyOfItsLattice) {
  for (const double horizon : {1.0, 2.0, 3.0}) {
    const Bar bar = ring(40, horizon);
    // Strains of 1e-6 make the spring's own nonlinearity, of that order, the largest error.
    EXPECT_NEAR(bar.measured, bar.discrete, 1e-6 * bar.discrete) << horizon;
  }
}

// At a fixed number of spacings per horizon the frequency converges to the continuum's with order 2.
TEST(PmbMotion, ConvergesToTheContinuumWithOrderTwo) {
  for (const double horizon : {1.0, 3.0}) {
    const auto error = [&](int points) {
      const Bar bar = ring(points, horizon);
      return std::abs(bar.measured / bar.continuum - 1);
    };
    const double coarse = error(20), fine = error(40);
    EXPECT_LT(fine, 0.01);
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1) << horizon;
  }
}

/// A plate with a slit whose halves fly apart; what its energy balance errs by at the end, and what it
/// dissipated.
std::pair<double, double> tear(double part_of_stable_step) {
  LatticeBodyInput in = cells_of({30, 20});
  in.defects.cracks.push_back({{-1.6, 0.0, 0}, {-0.4, 0.0, 0}});
  Pmb model(make_lattice_body(in), kGlass);
  model.set_limits(FailureLimits::uniform(1e-3));
  const Body& body = model.body();
  const Constraints none(model.dofs(), 7);
  Constraints constraints = none;
  const double speed = std::sqrt(kGlass.youngs_modulus / kGlass.density);
  VelocityVerletSettings motion{.until = 4 / speed, .every = 4 / speed, .history_every = 4 / speed};
  motion.safety = part_of_stable_step;
  motion.initial_v.assign(model.dofs(), 0.0);
  for (const std::size_t i : body.points)
    motion.initial_v[body.size() + i] = 1.5e-3 * speed * body.position(i)[1];
  Observer nobody;
  const State state = march(model, constraints, motion, nobody);
  EXPECT_EQ(state.energy.dissipated, model.dissipated_energy());
  return {std::abs(state.energy.error()), state.energy.dissipated / state.energy.external_work};
}

// A bond does its work in the step that breaks it, so that the balance is as exact as without fracture: order
// 2 in the step.
TEST(PmbMotion, ClosesItsEnergyBalanceThroughFracture) {
  const auto [coarse, coarse_dissipated] = tear(0.4);
  const auto [fine, fine_dissipated] = tear(0.1);
  EXPECT_GT(fine_dissipated, 0.2);  // it does break
  EXPECT_LT(fine, 1e-3 * fine_dissipated);
  EXPECT_NEAR(std::log2(coarse / fine) / 2, 2, 0.5);  // breaking is discrete: the order is rough
}

}  // namespace
}  // namespace riven::testing
