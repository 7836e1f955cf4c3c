#include "peridynamics/lps.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "load/mirror.hpp"
#include "support/energy_gradient.hpp"
#include "support/lps_reference.hpp"
#include "support/model_properties.hpp"
#include "support/pmb_bodies.hpp"
#include "support/point_states.hpp"
#include "support/tangents.hpp"

namespace riven::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

LpsSettings random_settings(Random& random) {
  return {.youngs_modulus = 72e9,
          .poissons_ratio = random.between(-0.9, 0.48),
          .density = 2440,
          .plane = random.chance(0.5) ? Plane::stress : Plane::strain,
          .influence = random.chance(0.5) ? Influence::inverse : Influence::constant};
}

/// A body as `random_cells` makes it, with a horizon that the model takes.
Body random_body(Random& random, int dimension, bool mirrored) {
  LatticeBodyInput in = random_cells(random, dimension, mirrored);
  in.horizon = std::max(in.horizon, 1.5 * in.spacing);
  return make_lattice_body(in);
}

// Every kernel gives the plain loops' forces, on random bodies in random states.
TEST(Lps, KernelsAgreeWithPlainLoops) {
  Random random(2007);
  double worst = 0;
  for (int n = 0; n < 30; ++n) {
    const Body lattice = random_body(random, 2 + n % 2, n % 4 < 2);
    const LpsSettings settings = random_settings(random);
    worst = std::max(worst, difference_from_plain_loops<Lps>(
                                lattice, settings, 0.1, static_cast<unsigned>(random.integer(0, 1 << 30))));
  }
  // Sums of up to 130 terms of both signs. Measured: 3e-15.
  EXPECT_LT(worst, 3e-14);
}

// Any small strain in any direction has Hooke's stress in complete families; a finite one differs by its
// square.
TEST(Lps, HasHookesStress) {
  Random random(14);
  for (const int dimension : {2, 3})
    for (const bool lists : {false, true})
      for (int n = 0; n < 12; ++n) {
        const LpsSettings settings = random_settings(random);
        const double horizon = random.between(1.5, dimension == 3 ? 3.3 : 5.2);
        const Body lattice =
            make_lattice_body(dimension == 2 ? cells_of({13, 13}, horizon) : cells_of({7, 7, 7}, horizon));
        Lps model(lists ? listed(lattice) : lattice, settings);
        const std::size_t middle = middle_point(model.body());
        const Matrix3d g = random_matrix(random, dimension);
        Matrix3d hooke = elastic(settings, dimension).stress(0.5 * (g + g.transpose()));
        if (dimension == 2 && settings.plane == Plane::strain)
          hooke(2, 2) = settings.poissons_ratio * hooke.trace();
        const auto stress = [&](double h) { return stress_at(model, homogeneous(model, h * g), middle); };
        // Central differences err by h^2, rounding by 1e-16 / h: together less than 1e-9.
        const double h = 3e-6;
        const Matrix3d slope = (stress(h) - stress(-h)) / (2 * h);
        EXPECT_LT((slope - hooke).norm(), 1e-9 * hooke.norm()) << dimension << lists << n;
        const auto error = [&](double strain) { return (stress(strain) / strain - hooke).norm(); };
        EXPECT_NEAR(error(2e-3) / error(1e-3), 2, 0.05);
      }
}

// A homogeneous deformation, also a large one, pulls at no point that sees no free surface.
TEST(Lps, LeavesHomogeneousDeformationAlone) {
  Random random(15);
  for (const int dimension : {2, 3})
    for (const bool lists : {false, true}) {
      const Body lattice = make_lattice_body(dimension == 2 ? cells_of({17, 16}) : cells_of({10, 11, 11}, 2));
      Lps model(lists ? listed(lattice) : lattice, random_settings(random));
      const auto force = force_of(model, homogeneous(model, 0.3 * random_matrix(random, dimension)));
      const auto inner = inner_points(model.body());
      EXPECT_GT(inner.size(), 5U);
      for (const std::size_t i : inner)
        EXPECT_LT(vector_of(force, model.body(), i).norm(), 1e-13 * largest_of(force));
    }
}

// Edges with mirror layers that follow a homogeneous deformation: no free force anywhere, and the reaction is
// stress times area.
TEST(Lps, PassesThePatchTestWithLoadedEdges) {
  Random random(16);
  for (const int dimension : {2, 3})
    for (const bool lists : {false, true}) {
      const LpsSettings settings = random_settings(random);
      const Body lattice = make_lattice_body(dimension == 2 ? cells_of({12, 9}, 3, Faces(0b1111))
                                                            : cells_of({6, 5, 7}, 2, Faces(0b111111)));
      Lps model(lists ? listed(lattice) : lattice, settings);
      const Body& body = model.body();
      const Matrix3d g = 0.1 * random_matrix(random, dimension);
      Constraints constraints = follow(model, g);
      auto u = homogeneous(model, g);
      constraints.apply(u);
      auto force = force_of(model, u);
      const double scale = largest_of(force);
      constraints.reduce(force);
      EXPECT_LT(largest_of(force), 1e-13 * scale);
      const Matrix3d stress = stress_at(model, u, middle_point(body));
      for (std::size_t face = 0; face < 2 * static_cast<std::size_t>(dimension); ++face) {
        const auto axis = static_cast<Eigen::Index>(face / 2);
        const double sign = face % 2 == 0 ? -1 : 1,
                     expected = sign * stress(axis, axis) * body.face_area(face);
        EXPECT_NEAR(constraints.reaction(face)[face / 2], expected,
                    1e-12 * stress.norm() * body.face_area(face));
      }
    }
}

TEST(Lps, ForceIsMinusTheGradientOfTheEnergy) {
  Random random(31);
  for (int n = 0; n < 12; ++n) {
    const Body lattice = random_body(random, 2 + n % 2, true);
    Lps model(n % 4 < 2 ? lattice : listed(lattice), random_settings(random));
    SCOPED_TRACE(n);
    expect_force_is_gradient(model, random);
  }
}

// The energy is the sum of the field's densities, and the dilatation of a uniform dilation is exact in every
// family, cut or not.
TEST(Lps, HasExactDilatationInCutFamilies) {
  Random random(32);
  for (int n = 0; n < 8; ++n) {
    const int dimension = 2 + n % 2;
    const Body lattice = random_body(random, dimension, false);
    const LpsSettings settings = random_settings(random);
    Lps model(n % 4 < 2 ? lattice : listed(lattice), settings);
    const double strain = 0.01;
    const auto u = homogeneous(model, strain * Matrix3d::Identity());
    const auto fields = model.fields(u);
    const double density =
        0.5 * elastic(settings, dimension).bulk() * dimension * dimension * strain * strain;
    double energy = 0;
    for (std::size_t p = 0; p < model.points(); ++p) {
      if (model.body().family_size(model.body().points[p]) == 0) continue;
      EXPECT_NEAR(fields[3].values[p], dimension * strain, 1e-13);
      EXPECT_NEAR(fields[1].values[p], density, 1e-12 * density);
      energy += fields[1].values[p] * model.body().volume[model.body().points[p]];
    }
    EXPECT_NEAR(model.strain_energy(u), energy, 1e-12 * energy);
  }
}

// Momentum and angular momentum of random states with holes and cracks; rotations pull at nothing.
TEST(Lps, KeepsMomentumAndDoesNotSeeRotations) {
  Random random(17);
  for (int n = 0; n < 12; ++n) {
    const int dimension = 2 + n % 2;
    const Body lattice = random_body(random, dimension, false);
    Lps model(n % 4 < 2 ? lattice : listed(lattice), random_settings(random));
    const auto u = random_displacements(model, random, 0.1);
    // |Y| - L of rotated places of 1 m errs by 1e-16 m: a strain of 1e-15, and forces of that over those of
    // strains of a tenth.
    expect_momentum_and_objectivity(model, u, random, 1e-12, 1e-13);
  }
}

// A crack through the whole sheet: what one half does, the other does not feel.
TEST(Lps, CutBondsCarryNothing) {
  Random random(18);
  const Body lattice = halved_sheet();
  for (const bool lists : {false, true}) {
    Lps model(lists ? listed(lattice) : lattice, random_settings(random));
    expect_cut_bonds_to_carry_nothing(model, random);
  }
}

TEST(Lps, BoundsTheStiffnessTightly) {
  Random random(8);
  for (const double nu : {-0.3, 0.0, 0.25, 0.33, 0.45})
    for (const int dimension : {2, 3}) {
      const Body body = make_lattice_body(dimension == 2 ? cells_of({14, 13}) : cells_of({7, 6, 6}, 2));
      for (const bool lists : {false, true}) {
        const LpsSettings settings{
            .youngs_modulus = 72e9, .poissons_ratio = nu, .density = 2440, .plane = Plane::strain};
        Lps model(lists ? listed(body) : body, settings);
        const auto u = random_displacements(model, random, 0.02);
        std::vector<double> bound(model.dofs());
        model.stiffness_bound(u, bound);
        for (const InstructionSet set : supported_sets()) {
          const UseSet use(set);
          Lps other(model.body(), settings);
          std::vector<double> same(model.dofs());
          other.stiffness_bound(u, same);
          for (std::size_t i = 0; i < same.size(); ++i)
            ASSERT_NEAR(same[i], bound[i], 1e-13 * largest_of(bound)) << name(set);
        }
        const Eigen::MatrixXd k = assembled(model, u);
        // All masses are the same, so the bound of the largest frequency is that of the largest eigenvalue.
        const double exact = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k, Eigen::EigenvaluesOnly)
                                 .eigenvalues()
                                 .maxCoeff();
        EXPECT_GE(largest_of(bound), exact);
        // Twice the own blocks would need every bond's ends to move against each other: 1.4 times the
        // eigenvalue in 3D, 1.7 in 2D. The dilatation's part takes all its bonds at their worst at once: 2.1
        // at a ratio of 0.45, where the step is 0.69 of the limit.
        EXPECT_LE(largest_of(bound), (nu > 0.4 ? 2.3 : 1.8) * exact);
      }
    }
}

TEST(Lps, HasTheSameBitsOnAnyNumberOfThreads) {
  const Body body = make_lattice_body(cells_of({13, 12, 11}));
  for (const bool lists : {false, true})
    expect_same_bits_on_threads([&] {
      return std::make_unique<Lps>(
          lists ? listed(body) : body,
          LpsSettings{.youngs_modulus = 72e9, .poissons_ratio = 0.2, .density = 2440});
    });
}

TEST(Lps, RefusesWhatItCannotBe) {
  const LpsSettings fine{.youngs_modulus = 1, .poissons_ratio = 0.2, .density = 1};
  LatticeBodyInput in = cells_of({20, 20});
  in.defects.inclusions.emplace_back(Disc{{}, 0.3});
  EXPECT_THROW(Lps(make_lattice_body(in), fine), InputError);
  EXPECT_THROW(Lps(make_lattice_body(cells_of({20})), fine), InputError);
  for (const bool lists : {false, true}) {  // bonds along the axes only
    const Body narrow = make_lattice_body(cells_of({20, 20}, 1));
    EXPECT_THROW(Lps(lists ? listed(narrow) : narrow, fine), InputError);
  }
  for (const double nu : {-1.0, 0.5, 0.7})
    EXPECT_THROW(
        Lps(make_lattice_body(cells_of({20, 20})), {.youngs_modulus = 1, .poissons_ratio = nu, .density = 1}),
        InputError);
}

}  // namespace
}  // namespace riven::testing
