// The kernels of every instruction set give the forces of plain loops over the bonds.

#include <gtest/gtest.h>

#include "support/bond_membrane_reference.hpp"
#include "support/instruction_sets.hpp"
#include "support/laws.hpp"
#include "support/listed_bodies.hpp"
#include "support/membrane_reference.hpp"

namespace riven::testing {
namespace {

constexpr double kStabilisation = 4;

class Kernels : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override {
    if (!supported(GetParam())) GTEST_SKIP() << "this processor has no " << name(GetParam());
    use_.emplace(GetParam());
  }

 private:
  std::optional<UseSet> use_;
};
INSTANTIATE_TEST_SUITE_P(Membranes, Kernels, ::testing::ValuesIn(all_sets()),
                         [](const auto& row) { return std::string(name(row.param)); });

/// The random bodies, every other one so wide that blocks of eight points lie more than two horizons away
/// from its edges: those take the loops for whole families.
LatticeBodyInput body_of(unsigned seed, Random& random, bool inclusions) {
  LatticeBodyInput in = random_body(random, {.inclusions = inclusions});
  if (seed % 2 == 0) in.shape = rectangle(1.1, 0, 2.3, std::get<Box>(in.shape).half_size[1]);
  return in;
}

void expect_plain_force(Membrane& membrane, Random& random, unsigned seed) {
  const State2 u = random_state(membrane, random), force = force_of(membrane, u);
  const auto plain = PlainMembrane(membrane, kStabilisation).evaluate(u);
  // Rounding of some thirty terms; on lists also that of positions, 1e-16 of the body over a bond of 0.015 of
  // it. Measured: 7e-14 of the largest force, 2e-14 of the energy.
  EXPECT_NEAR(membrane.strain_energy(u), plain.energy, 1e-12 * plain.energy) << "seed " << seed;
  for (std::size_t e = 0; e < force.size(); ++e)
    ASSERT_NEAR(force[e], plain.force[e], 1e-11 * largest(plain.force)) << "seed " << seed << ", entry " << e;
}

TEST_P(Kernels, OfMembranesAgreeWithPlainLoops) {
  std::size_t listed_exceptions = 0;
  for (const LawCase& law : unit_laws())
    for (unsigned seed = 1; seed <= 8; ++seed) {
      Random random(seed);
      const LatticeBodyInput in = body_of(seed, random, true);
      Membrane lattice(make_lattice_body(in), law.material(), kStabilisation);
      expect_plain_force(lattice, random, seed);
      Membrane same(listed(lattice.body()), law.material(), kStabilisation);
      expect_plain_force(same, random, seed);
      Membrane scattered(make_listed_body(jittered(in, random)), law.material(), kStabilisation);
      expect_plain_force(scattered, random, seed);
      listed_exceptions += scattered.points_by_gradient() + scattered.points_by_least_squares();
    }
  EXPECT_GT(listed_exceptions, 0U);
}

TEST_P(Kernels, OfBondMembranesAgreeWithPlainLoops) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    const LatticeBodyInput in = body_of(seed, random, false);
    Membrane sound(make_lattice_body(in), rubber(), kStabilisation);
    const State2 u = random_state(sound, random);
    for (const Loading loading :
         {Loading::equibiaxial, Loading::planar, Loading::uniaxial, Loading::uniaxial_compression}) {
      BondMembrane membrane(make_lattice_body(in), rubber(), {.loading = loading});
      State2 force(membrane.dofs());
      ASSERT_FALSE(membrane.internal_force(u, force));
      const State2 plain = plain_force(membrane, u);
      // Rounding of some thirty terms with powers up to eight.
      for (std::size_t e = 0; e < force.size(); ++e)
        ASSERT_NEAR(force[e], plain[e], 1e-12 * largest(plain)) << "seed " << seed << ", entry " << e;
    }
  }
}

}  // namespace
}  // namespace riven::testing
