// The published bond-based membrane: its forces, its corrections, and what is wrong with them.

#include "peridynamics/bond_membrane.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <numbers>

#include "base/error.hpp"
#include "body/listed_body.hpp"
#include "solver/dynamic_relaxation.hpp"
#include "support/bodies.hpp"
#include "support/bond_membrane_reference.hpp"
#include "support/differences.hpp"
#include "support/laws.hpp"
#include "support/loads.hpp"
#include "support/states.hpp"

namespace riven::testing {
namespace {

const std::vector<Loading> kLoadings = {Loading::equibiaxial, Loading::planar, Loading::uniaxial,
                                        Loading::uniaxial_compression};

struct Kind {
  Loading loading;
  bool zero_residual;
  [[nodiscard]] BondMembraneSettings settings(bool corrected = true) const {
    return {loading, zero_residual, corrected};
  }
};

std::vector<Kind> kinds() {
  std::vector<Kind> all;
  for (const Loading loading : kLoadings)
    for (const bool zero_residual : {false, true}) all.push_back({loading, zero_residual});
  return all;
}

std::string kind_name(const ::testing::TestParamInfo<Kind>& info) {
  const std::vector<std::string> names = {"equibiaxial", "planar", "uniaxial", "uniaxial_compression"};
  return names[static_cast<std::size_t>(info.param.loading)] +
         (info.param.zero_residual ? "_zero_residual" : "_published");
}

class BondSheet : public ::testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Membranes, BondSheet, ::testing::ValuesIn(kinds()), kind_name);

/// A random state of a random body, by way of a `Membrane` on the same body.
State2 random_state_of(const LatticeBodyInput& in, Random& random) {
  Membrane sound(make_lattice_body(in), rubber(), 4);
  return random_state(sound, random);
}

State2 bond_force(BondMembrane& membrane, const State2& u) {
  State2 force(membrane.dofs());
  if (const auto breakdown = membrane.internal_force(u, force)) throw std::logic_error(breakdown->what);
  return force;
}

TEST_P(BondSheet, AgreesWithPlainLoopsOverTheBonds) {
  for (unsigned seed = 1; seed <= 15; ++seed) {
    Random random(seed);
    const LatticeBodyInput in = random_body(random, {.inclusions = false});
    const State2 u = random_state_of(in, random);
    BondMembrane membrane(make_lattice_body(in), rubber(), GetParam().settings());
    const State2 force = bond_force(membrane, u), expected = plain_force(membrane, u);
    // Rounding of some thirty terms with powers up to eight; 3e-14 measured.
    for (std::size_t e = 0; e < force.size(); ++e)
      ASSERT_NEAR(force[e], expected[e], 1e-12 * largest(expected)) << "seed " << seed << ", entry " << e;
  }
}

TEST_P(BondSheet, IsTheSameWithListedBondsAndOnAnyNumberOfThreads) {
  const int before = omp_get_max_threads();
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    const LatticeBodyInput in = random_body(random);
    const State2 u = random_state_of(in, random);
    BondMembrane membrane(make_lattice_body(in), rubber(), GetParam().settings());
    BondMembrane list(listed(membrane.body()), rubber(), GetParam().settings());
    const Body &a = membrane.body(), &b = list.body();
    std::vector<std::pair<std::size_t, std::size_t>> same;
    const auto match = [&](std::size_t i, std::size_t j) {
      same.emplace_back(i, j);
      same.emplace_back(a.size() + i, b.size() + j);
    };
    for (std::size_t n = 0; n < a.points.size(); ++n) match(a.points[n], b.points[n]);
    for (std::size_t n = 0; n < a.ghosts.size(); ++n) match(a.ghosts[n].point, b.ghosts[n].point);
    for (std::size_t e = 2 * a.size(); e < membrane.dofs(); ++e)
      same.emplace_back(e, 2 * b.size() + e - 2 * a.size());
    State2 v(list.dofs(), 0.0);
    for (const auto& [i, j] : same) v[j] = u[i];
    omp_set_num_threads(1);
    const State2 force = bond_force(membrane, u), listed_force = bond_force(list, v);
    const double energy = membrane.strain_energy(u);
    // Rounding of positions over the shortest bonds, those to inclusions; 4e-14 measured.
    for (const auto& [i, j] : same) ASSERT_NEAR(listed_force[j], force[i], 1e-10 * largest(force));
    EXPECT_NEAR(list.strain_energy(v), energy, 1e-10 * std::abs(energy));
    for (const int threads : {2, 3}) {
      omp_set_num_threads(threads);
      EXPECT_EQ(bond_force(membrane, u), force);
      EXPECT_EQ(bond_force(list, v), listed_force);
      EXPECT_EQ(membrane.strain_energy(u), energy);
    }
  }
  omp_set_num_threads(before);
}

constexpr double kLoopStretch = 1.5, kLoopAngle = 0.6;

/// Work (J) of the internal force on a free sheet around a closed loop: stretch it, turn it, release the
/// stretch, turn it back.
double work_around_loop(PointModel& model) {
  const auto state = [&](double stretch, double angle) {
    return affine_state(model, stretch * Eigen::Rotation2Dd(angle).toRotationMatrix());
  };
  const std::array<std::array<double, 2>, 5> corner = {
      {{1, 0}, {kLoopStretch, 0}, {kLoopStretch, kLoopAngle}, {1, kLoopAngle}, {1, 0}}};
  constexpr int kSteps = 100;
  double work = 0;
  for (std::size_t leg = 0; leg < 4; ++leg)
    for (int n = 0; n < kSteps; ++n) {
      const auto at = [&](double t) {
        return state(corner[leg][0] + t * (corner[leg + 1][0] - corner[leg][0]),
                     corner[leg][1] + t * (corner[leg + 1][1] - corner[leg][1]));
      };
      const State2 before = at(static_cast<double>(n) / kSteps), after = at((n + 1.0) / kSteps);
      State2 force(model.dofs());
      if (model.internal_force(at((n + 0.5) / kSteps), force)) throw std::logic_error("the loop fails");
      for (std::size_t e = 0; e < force.size(); ++e) work += force[e] * (after[e] - before[e]);
    }
  return work;
}

TEST_P(BondSheet, HasNoEnergyWhereBondsTurn) {
  const LatticeBodyInput in = sheet(8, 8, 0.1);
  BondMembrane membrane(make_lattice_body(in), rubber(), GetParam().settings());
  Membrane sound(make_lattice_body(in), rubber(), 4);
  EXPECT_FALSE(membrane.conservative());
  EXPECT_TRUE(sound.conservative());
  const auto stored = [&](PointModel& model) {
    return model.strain_energy(affine_state(model, kLoopStretch * Eigen::Matrix2d::Identity())) -
           model.strain_energy(State2(model.dofs(), 0.0));
  };
  // A model with an energy gets back what it gave: the midpoint rule's errors on the way out and back cancel,
  // 1.7e-14 measured.
  EXPECT_LT(std::abs(work_around_loop(sound)), 1e-11 * stored(sound));
  // Here a turned sheet gives back cos^2 of what it stored, and the loop loses the rest; 7e-4 measured, the
  // midpoint rule's error for the compression law.
  const double lost = std::pow(std::sin(kLoopAngle), 2) * stored(membrane);
  EXPECT_NEAR(work_around_loop(membrane), -lost, 1e-3 * std::abs(lost));
}

TEST_P(BondSheet, HasAnEnergyWhereBondsOnlyStretch) {
  // In equibiaxial states no bond turns: the power of a stretching sheet is the rate of its energy.
  BondMembrane membrane(make_lattice_body(sheet(9, 7, 0.1)), rubber(), GetParam().settings());
  const auto state = [&](double l) { return affine_state(membrane, l * Eigen::Matrix2d::Identity()); };
  for (const double l : {0.9, 1.3, 2.2}) {
    const State2 force = bond_force(membrane, state(l));
    double power = 0;
    for (const std::size_t i : membrane.body().points) {
      const Point x = membrane.body().position(i);
      power += force[i] * x[0] + force[membrane.body().size() + i] * x[1];
    }
    const double rate = derivative([&](double s) { return membrane.strain_energy(state(s)); }, l, 1e-3);
    EXPECT_NEAR(power, -rate, 1e-8 * std::abs(rate));  // differences: h^4
  }
}

TEST_P(BondSheet, DependsOnTheObserver) {
  // The cosine is taken with the undeformed bond, so a rigid rotation by t scales all forces by cos^2 t.
  BondMembrane membrane(make_lattice_body(sheet(9, 7, 0.1)), rubber(), GetParam().settings());
  const Eigen::Matrix2d stretch = 1.4 * Eigen::Matrix2d::Identity();
  const double angle = 0.5;
  const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(angle).toRotationMatrix();
  const State2 straight = bond_force(membrane, affine_state(membrane, stretch));
  const State2 turned = bond_force(membrane, affine_state(membrane, rotation * stretch));
  EXPECT_NEAR(largest(straight) > 0 ? norm(turned) / norm(straight) : 0, std::pow(std::cos(angle), 2), 1e-12);
}

TEST_P(BondSheet, HasForcesAtRestAsItsLawSays) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    BondMembrane membrane(make_lattice_body(random_body(random)), rubber(), GetParam().settings());
    const double force = largest(bond_force(membrane, State2(membrane.dofs(), 0.0)));
    // Forces of bonds in a stretch of 1: thickness times spacing times C1.
    const double scale = membrane.body().thickness * membrane.body().spacing * kC1;
    if (membrane.law().force_at_rest() == 0 || GetParam().zero_residual) {
      EXPECT_LT(force, 1e-12 * scale);
    } else {
      EXPECT_GT(force, 1e-3 * scale);
    }
  }
}

TEST_P(BondSheet, IsStiffAtMostAsItsBoundSays) {
  Random random(5);
  const LatticeBodyInput in = random_body(random);
  State2 u = random_state_of(in, random);
  BondMembrane membrane(make_lattice_body(in), rubber(), GetParam().settings());
  State2 bound(membrane.dofs()), row(membrane.dofs(), 0.0);
  membrane.stiffness_bound(u, bound);
  const double h = 1e-5 * membrane.body().spacing;
  for (const std::size_t i : live_points(membrane.body()))
    for (const std::size_t e : {i, membrane.body().size() + i}) {
      const double kept = u[e];
      u[e] = kept + h;
      const State2 above = bond_force(membrane, u);
      u[e] = kept - h;
      const State2 below = bond_force(membrane, u);
      u[e] = kept;
      for (const std::size_t j : membrane.body().points)
        for (const std::size_t r : {j, membrane.body().size() + j})
          row[r] += std::abs(above[r] - below[r]) / (2 * h);
    }
  double tightest = 1e300;
  for (const std::size_t j : membrane.body().points) {
    if (membrane.body().family_size(j) == 0) continue;
    // A row sums both components; Gershgorin's circle in the norm of a point's vector is smaller by up to
    // 2^1/2.
    EXPECT_GT(std::numbers::sqrt2 * bound[j], row[j]) << "point " << j;
    tightest = std::min(tightest, bound[j] / row[j]);
  }
  RecordProperty("tightest", std::to_string(tightest));
}

TEST(BondMembrane, HasTheCorrectionFactorsOfTheTheoryNote) {
  struct Row {
    Loading loading;
    double horizon, bulk, edge_x, edge_y, corner;  // factors along x
  };
  // Printed with three decimals.
  for (const Row& row : {Row{Loading::equibiaxial, 3.015, 1.250, 2.013, 2.013, 3.370},
                         Row{Loading::planar, 3.015, 1.198, 2.396, 1.517, 3.034},
                         Row{Loading::uniaxial, 3.015, 0.972, 1.633, 1.281, 2.277},
                         Row{Loading::equibiaxial, 9.015, 1.079, 1.949, 1.949, 3.552},
                         Row{Loading::planar, 9.015, 1.068, 2.135, 1.686, 3.372},
                         Row{Loading::uniaxial, 9.015, 0.991, 1.802, 1.558, 2.889}}) {
    LatticeBodyInput in = sheet(21, 21, 0.1);
    in.horizon = row.horizon * in.spacing;
    const BondMembrane membrane(make_lattice_body(in), rubber(), {row.loading, false, true});
    const Lattice& lattice = membrane.body().on_lattice()->lattice;
    const auto factor = [&](int i, int j) { return membrane.correction(lattice.index({i, j, 0})); };
    EXPECT_NEAR(factor(10, 10).x(), row.bulk, 6e-4);
    EXPECT_NEAR(factor(0, 10).x(), row.edge_x, 6e-4);
    EXPECT_NEAR(factor(10, 0).x(), row.edge_y, 6e-4);
    EXPECT_NEAR(factor(0, 0).x(), row.corner, 6e-4);
    EXPECT_NEAR(factor(10, 10).y(), row.loading == Loading::planar ? 1 : row.bulk, 6e-4);
  }
}

TEST(BondMembrane, TakesTheVolumesBehindAnInclusionFromItsPoints) {
  // A large point far away makes the mean spacing larger and must not be felt at the inclusion.
  ListedBodyInput in;
  for (int i = -8; i < 8; ++i)
    for (int j = -8; j < 8; ++j) {
      in.position.push_back({0.1 * i + 0.05, 0.1 * j + 0.05, 0});
      in.volume.push_back(0.01);
    }
  in.horizon = 0.3;
  in.faces = {-0.8, 9, -0.8, 0.8, -1, 1};
  in.defects.inclusions.emplace_back(rectangle(0, 0, 0.2, 0.2));  // no point lies near its surface
  const BondMembrane alone(make_listed_body(in), rubber(), {Loading::uniaxial, false, true});
  in.position.push_back({8, 0, 0});
  in.volume.push_back(1);
  const BondMembrane beside(make_listed_body(in), rubber(), {Loading::uniaxial, false, true});
  EXPECT_GT(beside.body().spacing, 1.1 * alone.body().spacing);
  ASSERT_EQ(beside.body().interface.size(), alone.body().interface.size());
  for (std::size_t n = 0; n < alone.body().points.size(); ++n) {
    const std::size_t i = alone.body().points[n];
    // Where a bond meets the surface is found to 1e-9 of the spacing.
    EXPECT_LT((beside.correction(i) - alone.correction(i)).norm(), 1e-7) << "point " << n;
  }
}

TEST(BondMembrane, OfTheEquibiaxialLawIsExactThere) {
  // The correction makes the energy of every family right, and the law is exact in this loading.
  BondMembrane membrane(make_lattice_body(sheet(12, 12, 0.05, all_edges())), rubber(),
                        {Loading::equibiaxial, false, true});
  Constraints constraints = constrain(membrane, equibiaxial());
  for (const double l : {1.2, 2.0, 3.5}) {
    State2 u = affine_state(membrane, l * Eigen::Matrix2d::Identity());
    constraints.set_parameter(l);
    constraints.apply(u);
    State2 force = bond_force(membrane, u);
    constraints.reduce(force);
    const double expected = 2 * kC1 * (l - std::pow(l, -5)) * 0.7 * 12 * 0.05;
    EXPECT_LT(largest(force), 1e-12 * expected);
    for (std::size_t face = 0; face < 4; ++face) {
      const double sign = face % 2 == 0 ? -1 : 1;
      EXPECT_NEAR(constraints.reaction(face)[face / 2], sign * expected, 1e-11 * expected);
    }
  }
}

TEST(BondMembrane, IsNotFreeOfLateralStressInUniaxialTension) {
  // Section 12: central pair forces with this law leave a lateral stretch of 0.890 at 1.5, not 0.816.
  BondMembrane membrane(make_lattice_body([] {
                          LatticeBodyInput in = sheet(24, 24, 1.0 / 24, Faces(0b0011));
                          in.horizon = 5 * in.spacing;
                          return in;
                        }()),
                        rubber(), {Loading::uniaxial, false, false});
  Constraints constraints = constrain(membrane, uniaxial());
  Observer quiet;
  const State end = relax(membrane, constraints, {.targets = {1.5}}, quiet);
  const Lattice& lattice = membrane.body().on_lattice()->lattice;
  const auto uy = [&](int j) { return end.u[membrane.body().size() + lattice.index({12, j, 0})]; };
  const double lateral = 1 + (uy(14) - uy(9)) / (5.0 / 24);
  EXPECT_NEAR(lateral, 0.8901, 0.02);  // 0.9047 measured: bonds of few directions, edges without correction
  RecordProperty("lateral", std::to_string(lateral));
}

TEST(BondMembrane, RefusesWhatItCannotBe) {
  EXPECT_THROW(BondMembrane(make_lattice_body(sheet(6, 6, 0.1)), {"yeoh", Yeoh{1, 0, 0}, 1}, {}), InputError);
}

}  // namespace
}  // namespace riven::testing
