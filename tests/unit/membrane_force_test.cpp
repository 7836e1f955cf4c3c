// Forces of the membrane on random bodies in random states: gradient of the energy, momentum, a plain
// reference.

#include <gtest/gtest.h>

#include "support/bodies.hpp"
#include "support/differences.hpp"
#include "support/laws.hpp"
#include "support/membrane_reference.hpp"

namespace riven::testing {
namespace {

constexpr double kStabilisation = 4;  // as in the cases

struct Sample {
  Membrane membrane;
  State2 u;
};

Sample sample(unsigned seed, const LawCase& law) {
  Random random(seed);
  Sample s{Membrane(make_lattice_body(random_body(random)), law.material(), kStabilisation), {}};
  s.u = random_state(s.membrane, random);
  return s;
}

class RandomBody : public ::testing::TestWithParam<LawCase> {};
INSTANTIATE_TEST_SUITE_P(Membranes, RandomBody, ::testing::ValuesIn(unit_laws()), law_name);

TEST_P(RandomBody, ForceIsTheGradientOfTheEnergy) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    auto [membrane, u] = sample(seed, GetParam());
    const State2 force = force_of(membrane, u);
    // Differences: h^4 of the fifth derivative, largest on the short bonds at inclusions, and 1e-16 E / h of
    // rounding. Measured: 3.5e-10 of the largest force.
    const double h = 2e-4 * membrane.body().spacing, tolerance = 1e-8 * largest(force);
    for (const std::size_t e : live_entries(membrane)) {
      const auto energy = [&](double value) {
        const double kept = std::exchange(u[e], value);
        const double result = membrane.strain_energy(u);
        u[e] = kept;
        return result;
      };
      ASSERT_NEAR(force[e], -derivative(energy, u[e], h), tolerance) << "entry " << e;
    }
  }
}

TEST_P(RandomBody, AgreesWithPlainLoopsOverTheBonds) {
  std::size_t gradient = 0, least_squares = 0, at_inclusions = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    auto [membrane, u] = sample(seed, GetParam());
    const PlainMembrane plain(membrane, kStabilisation);
    const auto reference = plain.evaluate(u);
    const State2 force = force_of(membrane, u);
    // Rounding: 1e-14 of the energy and 5e-14 of the largest force measured.
    EXPECT_NEAR(membrane.strain_energy(u), reference.energy, 1e-12 * reference.energy) << "seed " << seed;
    for (std::size_t e = 0; e < force.size(); ++e)
      ASSERT_NEAR(force[e], reference.force[e], 1e-12 * largest(force)) << "seed " << seed << ", entry " << e;
    gradient += membrane.points_by_gradient();
    least_squares += membrane.points_by_least_squares();
    at_inclusions += membrane.body().interface.size();
    std::size_t counted = 0;
    for (const std::size_t i : membrane.body().points) counted += plain.by_gradient(i) ? 1 : 0;
    EXPECT_EQ(counted, membrane.points_by_gradient());
  }
  // The bodies reach every kind of point.
  EXPECT_GT(gradient, 20U);
  EXPECT_GT(least_squares, 0U);  // rare: only crossing slits make them
  EXPECT_GT(at_inclusions, 20U);
}

TEST_P(RandomBody, KeepsLinearAndAngularMomentum) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    auto [membrane, u] = sample(seed, GetParam());
    const Body& body = membrane.body();
    const State2 force = force_of(membrane, u);
    const std::size_t n = body.size();
    Eigen::Vector2d sum(0, 0);
    double torque = 0, scale = 0;
    const auto add = [&](const Eigen::Vector2d& y, const Eigen::Vector2d& f) {
      sum += f;
      torque += y.x() * f.y() - y.y() * f.x();
      scale += f.norm();
    };
    for (const std::size_t i : live_points(body))
      add(plane(body.position(i)) + Eigen::Vector2d(u[i], u[n + i]), {force[i], force[n + i]});
    for (std::size_t c = 0; c < body.defects.inclusions.size(); ++c) {
      const Shape& shape = body.defects.inclusions[c];
      const std::size_t dof = membrane.inclusion_dof(c);
      add(center_of(shape) + Eigen::Vector2d(u[dof], u[dof + 1]), {force[dof], force[dof + 1]});
      torque += force[dof + 2] * gyration_of(shape);
    }
    // Rounding of sums of some thousand bond forces, positions up to 3 m. Measured: 2e-16 and 9e-17.
    EXPECT_LT(sum.norm(), 1e-13 * scale) << "seed " << seed;
    EXPECT_LT(std::abs(torque), 1e-12 * scale) << "seed " << seed;
  }
}

}  // namespace
}  // namespace riven::testing
