// The membrane in states with known answers: rest, rigid motion, homogeneous deformation, cut and folded
// sheets.

#include "peridynamics/membrane.hpp"

#include <gtest/gtest.h>

#include <map>

#include "base/error.hpp"
#include "support/bodies.hpp"
#include "support/laws.hpp"
#include "support/membrane_reference.hpp"

namespace riven::testing {
namespace {

constexpr double kStabilisation = 4;

class Sheet : public ::testing::TestWithParam<LawCase> {
 protected:
  static Membrane make(const LatticeBodyInput& in) {
    return Membrane(make_lattice_body(in), GetParam().material(), kStabilisation);
  }
};
INSTANTIATE_TEST_SUITE_P(Membranes, Sheet, ::testing::ValuesIn(unit_laws()), law_name);

/// Size of the bond forces in a body: mu times thickness times spacing.
double force_scale(const Membrane& membrane) {
  return membrane.body().thickness * membrane.body().spacing * membrane.material().small_strain().shear;
}

/// Whether a point has bonds that span the plane; one without has no stress of its own.
bool has_family(const Membrane& membrane, std::size_t point) {
  bool any = false;
  membrane.for_each_bond(point, [&](const MembraneBond&) { any = true; });
  return any;
}

TEST_P(Sheet, OfAnyShapeRestsWithoutForceAndEnergy) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    Membrane membrane = make(random_body(random));
    const State2 u(membrane.dofs(), 0.0);
    // Rounding of bond forces that cancel, those of the short bonds at inclusions the largest: 1.7e-14
    // measured.
    EXPECT_LT(largest(force_of(membrane, u)), 1e-12 * force_scale(membrane)) << "seed " << seed;
    EXPECT_NEAR(membrane.strain_energy(u), 0, 1e-13) << "seed " << seed;  // J, of a sheet with mu V = 2.5 J
    EXPECT_FALSE(membrane.inspect(u));
  }
}

TEST_P(Sheet, OfAnyShapeMovesRigidlyWithoutForce) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    Membrane membrane = make(random_body(random));
    const State2 u =
        affine_state(membrane, random.rotation(), {random.between(-3, 3), random.between(-3, 3)});
    // Positions of 3 m carry a rounding of 4e-16 m; stretches of bonds of 0.1 m (0.015 m at inclusions) as
    // much over that.
    EXPECT_LT(largest(force_of(membrane, u)), 1e-11 * force_scale(membrane)) << "seed " << seed;
    EXPECT_NEAR(membrane.strain_energy(u), 0, 1e-12);
    EXPECT_FALSE(membrane.inspect(u));
  }
}

TEST_P(Sheet, OfAnyShapeHasTheStressAndEnergyOfAHomogeneousState) {
  // The patch test: whatever the family, a whole one, one at an edge, hole or slit, or one that goes by the
  // gradient.
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    Membrane membrane = make(random_body(random, {.inclusions = false}));
    const Eigen::Matrix2d f = random.gradient(0.7, 2);
    const State2 u = affine_state(membrane, f, {random.between(-1, 1), random.between(-1, 1)});
    const State2 force = force_of(membrane, u);
    const PlaneResponse exact = membrane.material().plane_stress(f);
    // Rounding of the weights' moments and of the stretches; measured 3e-14.
    const double tolerance = 1e-11;
    const double scale = exact.tangent.norm();
    double energy = 0;
    for (const std::size_t i : membrane.body().points) {
      if (!has_family(membrane, i)) continue;
      EXPECT_LT((membrane.nominal_stress(i, u) - exact.stress).norm(), tolerance * scale) << "seed " << seed;
      energy += membrane.body().volume[i] * exact.energy;
    }
    EXPECT_NEAR(membrane.strain_energy(u), energy, tolerance * energy);
    const ModelField density = membrane.fields(u)[1];
    ASSERT_EQ(density.name, "strain_energy_density");
    for (std::size_t n = 0; n < membrane.points(); ++n) {
      if (has_family(membrane, membrane.body().points[n])) {
        EXPECT_NEAR(density.values[n], exact.energy, tolerance * scale);
      }
    }
  }
}

TEST_P(Sheet, InsideHasNoNetForceInAHomogeneousState) {
  Random random(7);
  Membrane membrane = make(sheet(16, 14, 0.1));
  for (int n = 0; n < 10; ++n) {
    const State2 u = affine_state(membrane, random.gradient(0.7, 2)), force = force_of(membrane, u);
    const Lattice& lattice = membrane.body().on_lattice()->lattice;
    double edge = 0;
    for (const std::size_t i : membrane.body().points) {
      const Cell c = lattice.cell(i);
      const bool inside =
          c[0] >= 6 && c[0] < 10 && c[1] >= 6 && c[1] < 8;  // the whole families of all neighbours
      const double size = std::hypot(force[i], force[lattice.size() + i]);
      if (inside) {
        EXPECT_LT(size, 1e-12 * force_scale(membrane) * 50);  // stresses up to 50 mu; 3e-15 measured
      }
      edge = std::max(edge, size);
    }
    EXPECT_GT(edge, 1e-3 * force_scale(membrane));  // the edges do pull
  }
}

TEST_P(Sheet, CutInTwoBehavesAsTwoSheets) {
  const double d = 0.1;
  Membrane cut = make(sheet(16, 9, d, {}, {{}, {{{0, -1, 0}, {0, 1, 0}}}, {}}));
  Membrane half = make(sheet(8, 9, d));
  const std::size_t n = cut.body().size(), m = half.body().size();
  Random random(3);
  const State2 u = random_state(half, random);
  // The left half holds the state, the right one is undeformed and far away.
  State2 v(cut.dofs(), 0.0);
  for (const std::size_t i : cut.body().points) {
    const Cell c = cut.body().on_lattice()->lattice.cell(i);
    if (c[0] >= 8) {
      v[i] = 5;
      continue;
    }
    const std::size_t j = half.body().on_lattice()->lattice.index(c);
    v[i] = u[j];
    v[n + i] = u[m + j];
  }
  const State2 force = force_of(cut, v), expected = force_of(half, u);
  for (const std::size_t i : cut.body().points) {
    const Cell c = cut.body().on_lattice()->lattice.cell(i);
    const std::size_t j = half.body().on_lattice()->lattice.index(c[0] < 8 ? c : Cell{c[0] - 8, c[1], 0});
    const double fx = c[0] < 8 ? expected[j] : 0, fy = c[0] < 8 ? expected[m + j] : 0;
    EXPECT_NEAR(force[i], fx,
                1e-12 * largest(expected));  // the same operations on other vectors: 3e-15 measured
    EXPECT_NEAR(force[n + i], fy, 1e-12 * largest(expected));
  }
  EXPECT_NEAR(cut.strain_energy(v), half.strain_energy(u), 1e-12 * half.strain_energy(u));
}

TEST_P(Sheet, StandsPointsThatDefectsHaveCutOff) {
  // Crossing slits leave points with one bond, with bonds on one line, or with none.
  const double d = 0.1;
  std::vector<Segment> slits;
  for (const double side : {-1.0, 1.0}) {
    slits.push_back(
        {{-1.5 * d, side * 0.95 * d + 0.05, 0}, {2.6 * d, side * 0.95 * d + 0.05, 0}});  // along a row
    slits.push_back(
        {{side * 0.8 * d + 0.05, -3 * d, 0}, {side * 0.8 * d + 0.05, 3 * d, 0}});  // around a column
  }
  Membrane membrane = make(sheet(10, 10, d, {}, {{}, slits, {}}));
  std::size_t alone = 0;
  for (const std::size_t i : membrane.body().points) alone += has_family(membrane, i) ? 0 : 1;
  EXPECT_GT(alone, 0U);
  const State2 rest(membrane.dofs(), 0.0);
  EXPECT_LT(largest(force_of(membrane, rest)), 1e-12 * force_scale(membrane));
  EXPECT_FALSE(membrane.inspect(rest));
  for (const ModelField& field : membrane.fields(rest))
    for (const double value : field.values) EXPECT_TRUE(std::isfinite(value)) << field.name;
}

TEST_P(Sheet, TellsFoldedAndCollapsedStates) {
  Membrane membrane = make(sheet(10, 10, 0.1));
  const auto diagonal = [](double x, double y) { return Eigen::Matrix2d{{x, 0}, {0, y}}; };
  State2 force(membrane.dofs());
  const State2 folded = affine_state(membrane, diagonal(-1, 1));  // turned over: lengths alone do not show it
  EXPECT_FALSE(membrane.internal_force(folded, force));
  const auto breakdown = membrane.inspect(folded);
  ASSERT_TRUE(breakdown);
  EXPECT_NE(breakdown->what.find("folded"), std::string::npos);
  for (const auto& f : {diagonal(1.3, 0), diagonal(0, 0), diagonal(1, 1e-4)}) {
    const State2 collapsed = affine_state(membrane, f);
    const auto no_force = membrane.internal_force(collapsed, force);
    ASSERT_TRUE(no_force) << f;
    EXPECT_NE(no_force->what.find("collapses"), std::string::npos);
    EXPECT_TRUE(membrane.inspect(collapsed));
  }
  EXPECT_FALSE(membrane.inspect(affine_state(membrane, diagonal(2, 0.5))));
}

TEST_P(Sheet, NamesThePlaceOfAFold) {
  // The upper half turned over along a line between two rows: every bond within a half has its length, and
  // there is nothing wrong with the forces.
  Membrane membrane = make(sheet(12, 16, 0.1));
  const Lattice& lattice = membrane.body().on_lattice()->lattice;
  State2 u(membrane.dofs(), 0.0), force(membrane.dofs());
  for (const std::size_t i : membrane.body().points)
    u[lattice.size() + i] = -2 * std::max(0.0, lattice.position(i)[1]);
  EXPECT_FALSE(membrane.internal_force(u, force));
  for (const double f : force) EXPECT_TRUE(std::isfinite(f));
  const auto breakdown = membrane.inspect(u);
  ASSERT_TRUE(breakdown);
  EXPECT_NE(breakdown->what.find("folded"), std::string::npos);
  EXPECT_GT(breakdown->position[1], 0);
  EXPECT_LT(breakdown->position[1], 3 * 0.1);  // the first points above the line
}

TEST(Membrane, IsTwoDimensional) {
  LatticeBodyInput block = sheet(6, 6, 0.1);
  block.dimension = 3;
  block.shape = Box{{0, 0, 0}, {0.3, 0.3, 0.3}};
  EXPECT_THROW(Membrane(make_lattice_body(block), unit_laws()[0].material(), 4), InputError);
}

TEST(Membrane, HasTheMassOfItsBodyAndInclusions) {
  Random random(11);
  for (int n = 0; n < 10; ++n) {
    const LatticeBodyInput in = random_body(random);
    const Membrane membrane(make_lattice_body(in), unit_laws()[0].material(900), 4);
    State2 mass(membrane.dofs());
    membrane.mass(mass);
    double expected = 0, total = 0;
    for (const double v : membrane.body().volume) expected += 2 * 900 * v;
    for (const Shape& shape : in.defects.inclusions) {
      const auto* disc = std::get_if<Disc>(&shape);
      const double half = disc ? std::sqrt(std::acos(-1.0) / 4) * disc->radius : 0;
      const double area =
          disc ? 4 * half * half : 4 * std::get<Box>(shape).half_size[0] * std::get<Box>(shape).half_size[1];
      expected +=
          3 * 900 * area * in.thickness;  // the turning entry carries the same mass by its choice of length
    }
    for (const double m : mass) total += m;
    EXPECT_NEAR(total, expected, 1e-12 * expected);
  }
}

// Points at the corners of a slot are stretched like this. J^2 / a^2 = 4 / l^3 is small there, and the family
// is sound.
TEST(Membrane, TakesStrongUniaxialStretchForWhatItIs) {
  Membrane membrane(make_lattice_body(sheet(10, 9, 0.1, all_edges())), unit_laws()[0].material(),
                    kStabilisation);
  for (const double stretch : {5.0, 20.0, 60.0}) {
    Eigen::Matrix2d f;
    f << stretch, 0, 0, 1 / std::sqrt(stretch);
    const State2 u = affine_state(membrane, f);
    State2 force(membrane.dofs());
    EXPECT_FALSE(membrane.internal_force(u, force)) << stretch;
    EXPECT_FALSE(membrane.inspect(u)) << stretch;
    const Eigen::Matrix2d stress = membrane.nominal_stress(membrane.body().points[44], u);
    // J^2 = 3 a^2 - 2 b loses the digits that a^2 has more than J^2: l^3/4 times the rounding of doubles.
    const double exact = unit_laws()[0].material().plane_stress(f).stress(0, 0);
    EXPECT_NEAR(stress(0, 0) / exact, 1, 1e-14 * stretch * stretch * stretch);
  }
}

}  // namespace
}  // namespace riven::testing
