// Bodies with listed bonds: the same as lattice bodies where both exist, and right where points lie anywhere.

#include "body/listed_body.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include "base/error.hpp"
#include "support/bodies.hpp"
#include "support/differences.hpp"
#include "support/laws.hpp"
#include "support/listed_bodies.hpp"
#include "support/membrane_reference.hpp"

namespace riven::testing {
namespace {

constexpr double kStabilisation = 4;

/// Names a bond by the positions of its ends, in steps far below the spacing.
using BondKey = std::array<long, 4>;
std::vector<BondKey> bond_keys(const Body& body) {
  std::vector<BondKey> keys;
  const auto step = [](double x) { return std::lround(1e6 * x); };
  for (const std::size_t i : body.points) {
    const Point x = body.position(i);
    const auto add = [&](const Point& y) {
      keys.push_back({step(x[0]), step(x[1]), step(y[0]), step(y[1])});
    };
    body.for_each_neighbour(i, [&](std::size_t j) { add(body.position(j)); });
    for (const InterfaceBond& bond : body.interface_of(i)) add(bond.end);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

TEST(ListedBody, FindsTheBondsOfTheLattice) {
  // The lattice drops cells that are covered by half, a list drops points inside: only holes whose edges cut
  // no cell keep the same points. Slits, inclusions and mirrored edges are the same.
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    LatticeBodyInput in = random_body(random);
    in.defects.holes = {rectangle(4 * in.spacing, 4 * in.spacing, in.spacing, 2 * in.spacing)};
    if (std::lround(std::get<Box>(in.shape).half_size[0] / in.spacing * 2) % 2 != 0 ||
        std::lround(std::get<Box>(in.shape).half_size[1] / in.spacing * 2) % 2 != 0)
      continue;
    const Body lattice = make_lattice_body(in), list = make_listed_body(points_of(in));
    EXPECT_EQ(bond_keys(lattice), bond_keys(list)) << "seed " << seed;
    EXPECT_EQ(lattice.ghosts.size(), list.ghosts.size());
    for (std::size_t n = 0; n < lattice.points.size(); ++n) {
      EXPECT_EQ(lattice.whole_family[lattice.points[n]], list.whole_family[list.points[n]]);
      EXPECT_NEAR(lattice.spacing, list.spacing, 1e-12);
    }
  }
}

TEST(ListedBody, ExistsInOneAndThreeDimensions) {
  const double d = 0.1;
  const LatticeBodyInput bar{.dimension = 1,
                             .shape = Box{{0.5, 0, 0}, {0.5, 1, 1}},
                             .thickness = 2,
                             .spacing = d,
                             .horizon = 3 * d,
                             .defects = {},
                             .mirrored = Faces(0b10)};
  EXPECT_EQ(bond_keys(make_lattice_body(bar)), bond_keys(make_listed_body(points_of(bar))));
  const LatticeBodyInput block{.dimension = 3,
                               .shape = Box{{}, {0.4, 0.3, 0.35}},
                               .thickness = 1,
                               .spacing = d,
                               .horizon = 3 * d,
                               .defects = {},
                               .mirrored = Faces(0b100010)};
  const Body lattice = make_lattice_body(block), list = make_listed_body(points_of(block));
  ASSERT_EQ(lattice.points.size(), list.points.size());
  EXPECT_EQ(lattice.ghosts.size(), list.ghosts.size());
  for (std::size_t n = 0; n < lattice.points.size(); ++n)
    EXPECT_EQ(lattice.family_size(lattice.points[n]), list.family_size(list.points[n]));
}

TEST(ListedBody, IsRefusedWhenNothingIsLeft) {
  ListedBodyInput in = points_of(sheet(5, 5, 0.1));
  in.defects.holes = {rectangle(0, 0, 1, 1)};
  EXPECT_THROW(make_listed_body(in), InputError);
}

/// A membrane on a random lattice body, the same one with listed bonds, and where the entries of the first
/// stand in the second.
struct Pair {
  Membrane lattice, list;
  std::vector<std::size_t> place;  // number of entries of the lattice's state where there is none

  explicit Pair(const LatticeBodyInput& in, const LawCase& law)
      : lattice(make_lattice_body(in), law.material(), kStabilisation),
        list(listed(lattice.body()), law.material(), kStabilisation),
        place(lattice.dofs(), lattice.dofs()) {
    const Body& a = lattice.body();
    const Body& b = list.body();
    const auto match = [&](std::size_t i, std::size_t j) {
      for (std::size_t axis = 0; axis < 2; ++axis) place[axis * a.size() + i] = axis * b.size() + j;
    };
    for (std::size_t n = 0; n < a.points.size(); ++n) match(a.points[n], b.points[n]);
    for (std::size_t n = 0; n < a.ghosts.size(); ++n) match(a.ghosts[n].point, b.ghosts[n].point);
    for (std::size_t e = 2 * a.size(); e < lattice.dofs(); ++e) place[e] = 2 * b.size() + e - 2 * a.size();
  }

  [[nodiscard]] State2 to_list(const State2& v) const {
    State2 w(list.dofs(), 0.0);
    for (std::size_t e = 0; e < v.size(); ++e)
      if (place[e] < v.size()) w[place[e]] = v[e];
    return w;
  }
};

class ListedMembrane : public ::testing::TestWithParam<LawCase> {};
INSTANTIATE_TEST_SUITE_P(Membranes, ListedMembrane, ::testing::ValuesIn(unit_laws()), law_name);

TEST_P(ListedMembrane, AgreesWithTheLattice) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    Pair pair(random_body(random), GetParam());
    const State2 u = random_state(pair.lattice, random), v = pair.to_list(u);
    const State2 force = pair.to_list(force_of(pair.lattice, u)), listed_force = force_of(pair.list, v);
    // Bond vectors differ by the rounding of positions, 1e-16 of the body over a bond of a tenth of it (0.015
    // at inclusions). 2.2e-14 measured.
    for (std::size_t e = 0; e < force.size(); ++e)
      ASSERT_NEAR(listed_force[e], force[e], 1e-11 * largest(force)) << "entry " << e;
    const double energy = pair.lattice.strain_energy(u);
    EXPECT_NEAR(pair.list.strain_energy(v), energy, 1e-12 * energy);
    const auto fields = pair.lattice.fields(u), listed_fields = pair.list.fields(v);
    for (std::size_t f = 0; f < fields.size(); ++f) {
      ASSERT_EQ(listed_fields[f].name, fields[f].name);
      for (std::size_t n = 0; n < fields[f].values.size(); ++n)
        ASSERT_NEAR(listed_fields[f].values[n], fields[f].values[n], 1e-10 * largest(fields[f].values));
    }
    State2 bound(pair.lattice.dofs()), listed_bound(pair.list.dofs());
    pair.lattice.stiffness_bound(u, bound);
    pair.list.stiffness_bound(v, listed_bound);
    bound = pair.to_list(bound);
    for (std::size_t e = 0; e < bound.size(); ++e)
      ASSERT_NEAR(listed_bound[e], bound[e], 1e-10 * largest(bound)) << "entry " << e;
    EXPECT_EQ(pair.list.bonds(), pair.lattice.bonds());
    EXPECT_FALSE(pair.list.inspect(v));
  }
}

TEST_P(ListedMembrane, HasTheSameBitsOnAnyNumberOfThreads) {
  Random random(11);
  Pair pair(random_body(random), GetParam());
  const State2 u = random_state(pair.lattice, random), v = pair.to_list(u);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const State2 one = force_of(pair.list, v), lattice_one = force_of(pair.lattice, u);
  const double energy = pair.list.strain_energy(v);
  for (const int threads : {2, 3, 5}) {
    omp_set_num_threads(threads);
    EXPECT_EQ(force_of(pair.list, v), one);
    EXPECT_EQ(force_of(pair.lattice, u), lattice_one);
    EXPECT_EQ(pair.list.strain_energy(v), energy);
  }
  omp_set_num_threads(before);
}

TEST_P(ListedMembrane, OfScatteredPointsIsExactInAHomogeneousState) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    LatticeBodyInput in = random_body(random, {.inclusions = false});
    Membrane membrane(make_listed_body(jittered(in, random)), GetParam().material(), kStabilisation);
    const Eigen::Matrix2d f = random.gradient(0.7, 2);
    const State2 u = affine_state(membrane, f, {random.between(-1, 1), random.between(-1, 1)});
    static_cast<void>(force_of(membrane, u));
    const PlaneResponse exact = membrane.material().plane_stress(f);
    // Rounding of the weights' moments; irregular families need least squares more often. 4e-15 measured.
    for (const std::size_t i : membrane.body().points)
      if (membrane.body().family_size(i) > 2) {
        EXPECT_LT((membrane.nominal_stress(i, u) - exact.stress).norm(), 1e-11 * exact.tangent.norm())
            << "seed " << seed << ", point " << i;
      }
  }
}

TEST_P(ListedMembrane, OfScatteredPointsHasAForceThatIsTheGradientOfItsEnergy) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    Random random(seed);
    Membrane membrane(make_listed_body(jittered(random_body(random), random)), GetParam().material(),
                      kStabilisation);
    State2 u = random_state(membrane, random);
    const State2 force = force_of(membrane, u);
    const double h = 2e-4 * membrane.body().spacing, tolerance = 1e-8 * largest(force);  // as for lattices
    for (const std::size_t e : live_entries(membrane)) {
      const auto energy = [&](double value) {
        const double kept = std::exchange(u[e], value);
        const double result = membrane.strain_energy(u);
        u[e] = kept;
        return result;
      };
      ASSERT_NEAR(force[e], -derivative(energy, u[e], h), tolerance) << "seed " << seed << ", entry " << e;
    }
  }
}

}  // namespace
}  // namespace riven::testing
