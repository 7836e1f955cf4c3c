// Loads on edges by mirror layers: the field they hold, the forces they report, the work they do.

#include "load/constraints.hpp"

#include <gtest/gtest.h>

#include "solver/work.hpp"
#include "support/bodies.hpp"
#include "support/differences.hpp"
#include "support/laws.hpp"
#include "support/loads.hpp"
#include "support/states.hpp"

namespace riven::testing {
namespace {

constexpr double kStabilisation = 4;

struct LoadCase {
  std::string name;
  GradientPath path;
  bool rollers;
};

Eigen::Matrix2d diagonal(double x, double y) {
  return Eigen::Matrix2d{{x, 0}, {0, y}};
}

const std::vector<LoadCase> kLoads = {
    {"equibiaxial", [](double l) { return diagonal(l, l); }, false},
    {"planar", [](double l) { return diagonal(l, 1); }, true},
    {"biaxial_rollers", [](double l) { return diagonal(l, 2 - l); }, true},
    {"shear",
     [](double l) {
       return Eigen::Matrix2d{{1, l - 1}, {0, 1}};
     },
     false},
    {"shear_stretch_turn",
     [](double l) {
       return Eigen::Matrix2d{{l, 0.7 * (l - 1)}, {-0.4 * (l - 1), 0.8 + 0.2 * l}};
     },
     false}};

TEST(MirrorLayers, HoldAffineFields) {
  Membrane membrane(make_lattice_body(sheet(11, 9, 0.1, all_edges())), unit_laws()[0].material(),
                    kStabilisation);
  for (const LoadCase& load : kLoads) {
    Constraints constraints = constrain(membrane, edges(load.path, all_edges(), load.rollers));
    constraints.set_parameter(1.4);
    const State2 exact = affine_state(membrane, load.path(1.4));
    State2 u = exact;
    for (const GhostPoint& ghost : membrane.body().ghosts)
      u[ghost.point] = u[membrane.body().size() + ghost.point] = 99;
    constraints.apply(u);
    for (std::size_t e = 0; e < u.size(); ++e)
      EXPECT_NEAR(u[e], exact[e], 1e-15) << load.name;  // 4e-16 measured
  }
}

TEST(MirrorLayers, ReportTheForceOfHomogeneousSheetsAtEveryEdge) {
  for (const LawCase& law : unit_laws())
    for (const LoadCase& load : kLoads) {
      SCOPED_TRACE(law.name + " " + load.name);
      Membrane membrane(make_lattice_body(sheet(13, 10, 0.1, all_edges())), law.material(), kStabilisation);
      Constraints constraints = constrain(membrane, edges(load.path, all_edges(), load.rollers));
      constraints.set_parameter(1.5);
      State2 force = force_of(membrane, affine_state(membrane, load.path(1.5)));
      constraints.reduce(force);
      const double thickness = membrane.body().thickness, width = 1.3, height = 1.0;
      const Eigen::Matrix2d p = law.material().plane_stress(load.path(1.5)).stress;
      // Component a of an edge is told apart at corners only if it is normal to the edge; shear forces of
      // both components are shared with the neighbouring edge, so only their sum is known: it vanishes for a
      // homogeneous stress.
      const double tolerance = 1e-12 * p.norm();  // 5e-15 measured
      EXPECT_NEAR(constraints.reaction(0)[0], -p(0, 0) * thickness * height, tolerance);
      EXPECT_NEAR(constraints.reaction(1)[0], p(0, 0) * thickness * height, tolerance);
      EXPECT_NEAR(constraints.reaction(2)[1], -p(1, 1) * thickness * width, tolerance);
      EXPECT_NEAR(constraints.reaction(3)[1], p(1, 1) * thickness * width, tolerance);
      for (const std::size_t axis : {0U, 1U}) {
        double sum = 0;
        for (std::size_t face = 0; face < 4; ++face) sum += constraints.reaction(face)[axis];
        EXPECT_NEAR(sum, 0, tolerance);
      }
      EXPECT_LT(largest(force), tolerance);  // equilibrium: nothing is left on free entries
    }
}

TEST(MirrorLayers, ReduceTheForceToTheGradientInTheFreeEntries) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Random random(seed);
    LatticeBodyInput in = random_body(random);
    in.mirrored = Faces(0b1011);
    Membrane membrane(make_lattice_body(in), unit_laws()[seed % 3].material(), kStabilisation);
    Constraints constraints =
        constrain(membrane, edges(kLoads[seed].path, in.mirrored, kLoads[seed].rollers));
    State2 u(membrane.dofs(), 0.0);  // near rest, so that what the loads make of it is admissible
    for (const std::size_t e : live_entries(membrane))
      u[e] = 0.01 * membrane.body().spacing * random.between(-1, 1);
    constraints.set_parameter(1.003);
    constraints.apply(u);
    State2 force = force_of(membrane, u);
    constraints.reduce(force);
    // Short: the stabilisation's growth has a kink in its second derivative. Rounding of E / h leaves 6e-10
    // of the largest force.
    const double h = 2e-5 * membrane.body().spacing;
    for (const std::size_t e : live_entries(membrane)) {
      if (!constraints.is_free(e)) {
        EXPECT_EQ(force[e], 0);
        continue;
      }
      const double slope = derivative(
          [&](double value) {
            State2 v = u;
            v[e] = value;
            constraints.apply(v);
            return membrane.strain_energy(v);
          },
          u[e], h);
      ASSERT_NEAR(force[e], -slope, 1e-8 * largest(force)) << "seed " << seed << ", entry " << e;
    }
  }
}

TEST(MirrorLayers, FoldBoundsToTheMasters) {
  Membrane membrane(make_lattice_body(sheet(10, 8, 0.1, all_edges())), unit_laws()[0].material(),
                    kStabilisation);
  const Constraints constraints = constrain(membrane, planar());
  State2 bound(membrane.dofs(), 0.0);
  for (const std::size_t e : live_entries(membrane)) bound[e] = 1;
  constraints.fold(bound);
  double sum = 0;
  for (std::size_t e = 0; e < bound.size(); ++e) {
    sum += bound[e];
    if (!constraints.is_free(e)) {
      EXPECT_EQ(bound[e], 0);
    }
  }
  EXPECT_EQ(sum, static_cast<double>(live_entries(membrane).size()));
}

TEST(Constraints, PrescribedEntriesTakeTheForceAndReportIt) {
  Constraints constraints(4, 2);
  constraints.add({.slave = 0,
                   .master = Constraint::kNone,
                   .sign = 1,
                   .terms = {{[](const Point& x, double p) { return p * x[0]; }, Point{2, 0, 0}, 0, 1, 1}}});
  constraints.add({.slave = 3, .master = 0, .sign = -1, .terms = {}});
  constraints.set_parameter(3);
  State2 u = {0, 1, 2, 7};
  constraints.apply(u);
  EXPECT_EQ(u, (State2{6, 1, 2, -6}));
  State2 force = {10, 20, 30, 40};
  constraints.reduce(force);
  EXPECT_EQ(force, (State2{0, 20, 30, 0}));
  EXPECT_EQ(constraints.reaction(1)[0], -(10 - 40));  // what keeps entry 0 in place, its slave included
  EXPECT_FALSE(constraints.is_free(0));
  EXPECT_TRUE(constraints.is_free(1));
}

TEST(Constraints, FindTheAffinePartOfALoad) {
  Membrane membrane(make_lattice_body(sheet(11, 9, 0.1, all_edges())), unit_laws()[0].material(),
                    kStabilisation);
  const Eigen::Matrix2d change = kLoads[4].path(1.5) - kLoads[4].path(1.2);
  const AffineIncrement found =
      constrain(membrane, edges(kLoads[4].path, all_edges(), false)).affine_increment(1.2, 1.5);
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      EXPECT_NEAR(found.gradient[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)], change(a, b),
                  1e-14);
  EXPECT_NEAR(std::hypot(found.shift[0], found.shift[1]), 0, 1e-15);
}

TEST(Work, OfTheLoadsIsTheChangeOfStrainEnergy) {
  // Along homogeneous states, which are equilibria. The error falls as the square of the steps by the
  // trapezoidal rule, as the cube, at least, by the parabolic one.
  const auto error = [](WorkIntegral::Rule rule, const LoadCase& load, int steps) {
    Membrane membrane(make_lattice_body(sheet(10, 9, 0.1, all_edges())), unit_laws()[1].material(),
                      kStabilisation);
    Constraints constraints = constrain(membrane, edges(load.path, all_edges(), load.rollers));
    WorkIntegral integral(rule);
    double work = 0;
    for (int n = 0; n <= steps; ++n) {
      const double parameter = 1 + 0.5 * n / steps;
      State2 force = force_of(membrane, affine_state(membrane, load.path(parameter)));
      constraints.set_parameter(parameter);
      constraints.reduce(force);
      if (n == 0) {
        integral.begin(constraints, parameter);
      } else {
        work += integral.since_last_call(constraints, parameter);
      }
    }
    const double energy = membrane.strain_energy(affine_state(membrane, load.path(1.5)));
    return std::abs(work - energy) / energy;
  };
  using enum WorkIntegral::Rule;
  for (const LoadCase& load : {kLoads[0], kLoads[1], kLoads[4]}) {
    const double coarse = error(trapezoidal, load, 40), fine = error(trapezoidal, load, 80);
    EXPECT_LT(fine, 1e-4) << load.name;  // 2.3e-5 measured, equibiaxial
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.05) << load.name;
    const double coarse3 = error(parabolic, load, 40), fine3 = error(parabolic, load, 80);
    EXPECT_LT(fine3, 2e-6) << load.name;                           // 5e-7 measured, equibiaxial
    EXPECT_NEAR(std::log2(coarse3 / fine3), 3, 0.1) << load.name;  // 2.98
  }
  EXPECT_LT(error(trapezoidal, kLoads[3], 10), 1e-12);  // in simple shear the force is linear; 1e-14 measured
}

}  // namespace
}  // namespace riven::testing
