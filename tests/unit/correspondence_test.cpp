#include "peridynamics/correspondence.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "load/mirror.hpp"
#include "support/correspondence_reference.hpp"
#include "support/energy_gradient.hpp"
#include "support/model_properties.hpp"
#include "support/point_states.hpp"
#include "support/tangents.hpp"

namespace riven::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Body random_body(Random& random, int dimension, bool mirrored) {
  LatticeBodyInput in = random_cells(random, dimension, mirrored);
  in.horizon =
      std::min(in.horizon, (dimension == 3 ? 2.3 : 3.3) * in.spacing);  // plain loops take their time
  return make_lattice_body(in);
}

/// 1 + H with a small random H.
Matrix3d random_gradient(Random& random, int dimension, double size) {
  return Matrix3d::Identity() + size * random_matrix(random, dimension);
}

Matrix3d field_at(const ModelField& field, std::size_t n) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(field.values.data() + 9 * n);
}

// Every kernel gives the forces of the theory's sums, for every law, stabilisation and kinematics.
TEST(Correspondence, KernelsAgreeWithPlainLoops) {
  Random random(2017);
  double worst = 0;
  for (int n = 0; n < 24; ++n) {
    const int dimension = 2 + n % 2;
    const Body lattice = random_body(random, dimension, n % 4 < 2);
    const CorrespondenceSettings settings = random_correspondence(random, dimension, false);
    worst = std::max(worst, difference_from_plain_loops<Correspondence>(
                                lattice, settings, 0.05, static_cast<unsigned>(random.integer(0, 1 << 30))));
  }
  // The sheet's thickness is found to 1e-14 of the longitudinal modulus; stresses are a tenth of that.
  EXPECT_LT(worst, 1e-12);
}

// Any homogeneous deformation has its own gradient and the law's stress and energy in every family, cut ones
// too, and pulls at no point that sees no free surface.
TEST(Correspondence, HasTheLawsStressInHomogeneousDeformation) {
  Random random(14);
  for (int n = 0; n < 48; ++n) {
    const int dimension = 2 + n % 2;
    const CorrespondenceSettings settings = random_correspondence(random, dimension, false);
    const double horizon = random.between(1.5, dimension == 3 ? 2.3 : 3.9);
    const Body lattice =
        make_lattice_body(dimension == 2 ? cells_of({17, 16}, horizon) : cells_of({10, 9, 9}, horizon));
    Correspondence model(n % 4 < 2 ? lattice : listed(lattice), settings);
    const Matrix3d f = random_gradient(random, dimension, 0.25);
    const auto u = homogeneous(model, f - Matrix3d::Identity());
    const auto fields = model.fields(u);
    const Eigen::MatrixXd stress = stress_of(settings, f.topLeftCorner(dimension, dimension));
    for (std::size_t p = 0; p < model.points(); ++p) {
      const Matrix3d own = field_at(fields[2], p);
      ASSERT_LT((own.topLeftCorner(dimension, dimension) - stress).norm(), 1e-11 * stress.norm()) << n;
      ASSERT_LT((field_at(fields[3], p) - f).topLeftCorner(dimension, dimension).norm(), 1e-13);
    }
    const auto force = force_of(model, u);
    const auto inner = inner_points(model.body());
    EXPECT_FALSE(inner.empty());
    for (const std::size_t i : inner)
      EXPECT_LT(vector_of(force, model.body(), i).norm(), 1e-12 * largest_of(force));
  }
}

// Across a plane: no stress in plane stress, no strain in plane strain.
TEST(Correspondence, KnowsWhatGoesOnAcrossThePlane) {
  Random random(4);
  for (const Plane plane : {Plane::stress, Plane::strain}) {
    const CorrespondenceSettings settings{.material = law_case("compressible_neo_hookean").material(),
                                          .plane = plane};
    Correspondence model(make_lattice_body(cells_of({9, 9})), settings);
    const Matrix3d f = random_gradient(random, 2, 0.2);
    const auto fields = model.fields(homogeneous(model, f - Matrix3d::Identity()));
    const Matrix3d whole = field_at(fields[3], 3), stress = settings.material.solid(whole).stress;
    EXPECT_LT((field_at(fields[2], 3) - stress).norm(), 1e-12);
    if (plane == Plane::stress) {
      EXPECT_NEAR(stress(2, 2), 0, 1e-13);
    } else {
      EXPECT_EQ(whole(2, 2), 1);
    }
  }
}

// Edges with mirror layers that follow a homogeneous deformation: no free force anywhere, and the reaction is
// stress times area.
TEST(Correspondence, PassesThePatchTestWithLoadedEdges) {
  Random random(16);
  for (int n = 0; n < 16; ++n) {
    const int dimension = 2 + n % 2;
    const CorrespondenceSettings settings = random_correspondence(random, dimension, false);
    const Body lattice = make_lattice_body(dimension == 2 ? cells_of({12, 9}, 3, Faces(0b1111))
                                                          : cells_of({6, 5, 7}, 2, Faces(0b111111)));
    Correspondence model(n % 4 < 2 ? lattice : listed(lattice), settings);
    const Body& body = model.body();
    const Matrix3d g = 0.2 * random_matrix(random, dimension);
    Constraints constraints = follow(model, g);
    auto u = homogeneous(model, g);
    constraints.apply(u);
    auto force = force_of(model, u);
    const double scale = largest_of(force);
    constraints.reduce(force);
    EXPECT_LT(largest_of(force), 1e-12 * scale) << n;
    const Eigen::MatrixXd stress =
        stress_of(settings, (Matrix3d::Identity() + g).topLeftCorner(dimension, dimension));
    for (std::size_t face = 0; face < 2 * static_cast<std::size_t>(dimension); ++face) {
      const auto axis = static_cast<Eigen::Index>(face / 2);
      const double sign = face % 2 == 0 ? -1 : 1, area = body.face_area(face);
      EXPECT_NEAR(constraints.reaction(face)[face / 2], sign * stress(axis, axis) * area,
                  1e-11 * stress.norm() * area);
    }
  }
}

TEST(Correspondence, ForceIsMinusTheGradientOfTheEnergy) {
  Random random(31);
  for (int n = 0; n < 24; ++n) {
    const int dimension = 2 + n % 2;
    const Body lattice = random_body(random, dimension, true);
    Correspondence model(n % 4 < 2 ? lattice : listed(lattice),
                         random_correspondence(random, dimension, false));
    SCOPED_TRACE(n);
    expect_force_is_gradient(model, random);
  }
}

// Momentum and angular momentum of random states with holes and cracks; a rotated body has rotated forces,
// and rotation alone none.
TEST(Correspondence, KeepsMomentumAndDoesNotSeeRotations) {
  Random random(17);
  for (int n = 0; n < 16; ++n) {
    const int dimension = 2 + n % 2;
    const Body lattice = random_body(random, dimension, false);
    Correspondence model(n % 4 < 2 ? lattice : listed(lattice), random_correspondence(random, dimension));
    const auto u = random_displacements(model, random, 0.05);
    // Stresses of laws round by more than lengths do: by that of principal stretches and logarithms.
    expect_momentum_and_objectivity(model, u, random, 1e-11, 1e-12);
  }
}

// A crack through the whole sheet: what one half does, the other does not feel.
TEST(Correspondence, CutBondsCarryNothing) {
  Random random(18);
  const Body lattice = halved_sheet();
  for (const Stabilisation stabilisation : kStabilisations)
    for (const bool lists : {false, true}) {
      CorrespondenceSettings settings = random_correspondence(random, 2);
      settings.stabilisation = stabilisation;
      Correspondence model(lists ? listed(lattice) : lattice, settings);
      expect_cut_bonds_to_carry_nothing(model, random);
    }
}

/// Largest eigenvalue of the tangent over masses, with ghosts as slaves of their masters.
double exact_eigenvalue(const Correspondence& model, const Constraints& loads, const std::vector<double>& u) {
  std::vector<double> mass(model.dofs()), zero(model.dofs(), 0.0);
  model.mass(mass);
  loads.apply(zero);
  std::vector<std::size_t> entries;
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (mass[i] > 0) entries.push_back(i);
  Eigen::MatrixXd shapes(static_cast<Eigen::Index>(mass.size()), static_cast<Eigen::Index>(entries.size()));
  for (Eigen::Index c = 0; c < shapes.cols(); ++c) {
    std::vector<double> unit(model.dofs(), 0.0);
    const std::size_t entry = entries[static_cast<std::size_t>(c)];
    unit[entry] = 1 / std::sqrt(mass[entry]);
    loads.apply(unit);
    for (Eigen::Index r = 0; r < shapes.rows(); ++r)
      shapes(r, c) = unit[static_cast<std::size_t>(r)] - zero[static_cast<std::size_t>(r)];
  }
  const Eigen::MatrixXd scaled = shapes.transpose() * assembled(model, u) * shapes;
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

double bound_of(Correspondence& model, const Constraints& loads, const std::vector<double>& u) {
  std::vector<double> bound(model.dofs()), mass(model.dofs());
  model.stiffness_bound(u, bound);
  loads.fold(bound);
  model.mass(mass);
  double most = 0;
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (mass[i] > 0) most = std::max(most, bound[i] / mass[i]);
  return most;
}

/// Edges that hold their normal component, or all.
Constraints held(const Correspondence& model, const Faces& faces, bool all) {
  std::array<std::optional<FaceLoad>, 6> loads;
  for (std::size_t face = 0; face < 6; ++face) {
    if (!faces.test(face)) continue;
    loads[face] = FaceLoad{.displacement = {}, .load = face};
    for (std::size_t d = 0; d < static_cast<std::size_t>(model.body().dimension); ++d)
      if (all || d == face / 2) loads[face]->displacement[d] = [](const Point&, double) { return 0.0; };
  }
  Constraints constraints(model.dofs(), 7);
  add_mirror_constraints(model.body(), loads, true, constraints);
  constraints.set_parameter(1);
  return constraints;
}

TEST(Correspondence, BoundsTheStiffnessTightly) {
  Random random(8);
  double at_rest = 1, anywhere = 1;
  for (int n = 0; n < 24; ++n) {
    const int dimension = n % 4 == 3 ? 3 : 2;
    LatticeBodyInput in = dimension == 2 ? cells_of({random.integer(8, 12), random.integer(7, 11)})
                                         : cells_of({6, random.integer(4, 6), 5}, 2);
    if (dimension == 2 && random.chance(0.5)) in.defects.holes.emplace_back(Disc{{0.03, 0, 0}, 0.21});
    if (dimension == 2 && random.chance(0.5)) in.defects.cracks.push_back({{-0.6, 0.02, 0}, {-0.1, 0.03, 0}});
    for (std::size_t face = 0; face < 2 * static_cast<std::size_t>(dimension); ++face)
      in.mirrored.set(face, random.chance(0.3));
    const Body lattice = make_lattice_body(in);
    CorrespondenceSettings settings = random_correspondence(random, dimension);
    if (settings.stabilisation == Stabilisation::energy && random.chance(0.7)) settings.factor = 1;
    Correspondence model(n % 8 < 4 ? lattice : listed(lattice), settings);
    const Constraints loads = held(model, in.mirrored, random.chance(0.5));
    auto u = n % 3 == 0 ? std::vector<double>(model.dofs(), 0.0) : random_displacements(model, random, 0.03);
    loads.apply(u);
    const double share = exact_eigenvalue(model, loads, u) / bound_of(model, loads, u);
    EXPECT_LE(share, 1) << n;
    anywhere = std::min(anywhere, share);
    if (n % 3 == 0) at_rest = std::min(at_rest, share);
  }
  // The stable step is the root of these shares of its limit. Measured: 0.91 at rest (with the energy's
  // factor at 1 also there), 0.62 where noise has strained bonds by a tenth: there one point's stiffness
  // counts for all.
  EXPECT_GT(at_rest, 0.81);
  EXPECT_GT(anywhere, 0.36);
}

TEST(Correspondence, HasTheSameBitsOnAnyNumberOfThreads) {
  const Body body = make_lattice_body(cells_of({6, 6, 5}, 2));
  for (const Stabilisation stabilisation : kStabilisations)
    for (const bool lists : {false, true})
      expect_same_bits_on_threads([&] {
        return std::make_unique<Correspondence>(
            lists ? listed(body) : body,
            CorrespondenceSettings{.material = law_case("neo_hookean").compressible(),
                                   .stabilisation = stabilisation});
      });
}

// Bonds along one line do not tell a deformation gradient: such points have no stress, and are counted.
TEST(Correspondence, LeavesOutFamiliesInTooFewDirections) {
  LatticeBodyInput in = cells_of({12, 9});
  in.defects.cracks.push_back({{-2, 0.351, 0}, {2, 0.351, 0}});  // the uppermost row is a line
  for (const Stabilisation stabilisation : kStabilisations) {
    Correspondence model(make_lattice_body(in),
                         {.material = law_case("neo_hookean").material(), .stabilisation = stabilisation});
    EXPECT_EQ(model.loose_points(), 12U);
    Random random(5);
    const auto u = random_displacements(model, random, 0.05);
    const auto force = force_of(model, u);
    for (const std::size_t i : model.body().points)
      if (model.body().position(i)[1] > 0.36) {
        EXPECT_EQ(vector_of(force, model.body(), i), Vector3d::Zero());
      }
    const std::vector<std::string> lines = model.describe();
    EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
      return line.find("12 have bonds in too few directions") != std::string::npos;
    }));
  }
}

// A state that turns a family inside out, or is beyond a law's limit, is named by its point.
TEST(Correspondence, NamesThePointThatBreaksDown) {
  for (const Stabilisation stabilisation : kStabilisations)
    for (const bool lists : {false, true}) {
      const Body lattice = make_lattice_body(cells_of({12, 9}));
      const auto made = [&](const Material& material) {
        return Correspondence(lists ? listed(lattice) : lattice,
                              {.material = material, .stabilisation = stabilisation, .factor = 0.01});
      };
      Correspondence rubber = made(law_case("neo_hookean").material());
      std::vector<double> force(rubber.dofs());
      auto u = homogeneous(rubber, Matrix3d::Zero());
      EXPECT_FALSE(rubber.internal_force(u, force));
      for (const std::size_t i : rubber.body().points)  // the right end is folded over
        if (const double x = rubber.body().position(i)[0]; x > 0.1) u[i] = 2 * (0.1 - x);
      const auto fault = rubber.internal_force(u, force);
      ASSERT_TRUE(fault);
      EXPECT_NEAR(fault->position[0], 0.2, 0.16);
      EXPECT_NE(fault->what.find("determinant"), std::string::npos);

      Correspondence gent = made(Material{"gent", Gent{1, 2}, 1});  // ends at a stretch of about 2.1
      const auto stretched = homogeneous(gent, Vector3d(2, 0, 0).asDiagonal());
      const auto limit = gent.internal_force(stretched, force);
      ASSERT_TRUE(limit);
      EXPECT_NE(limit->what.find("law has no stress"), std::string::npos);
    }
}

TEST(Correspondence, RefusesWhatItCannotBe) {
  const CorrespondenceSettings fine{.material = law_case("neo_hookean").material()};
  LatticeBodyInput in = cells_of({20, 20});
  in.defects.inclusions.emplace_back(Disc{{}, 0.3});
  EXPECT_THROW(Correspondence(make_lattice_body(in), fine), InputError);
  EXPECT_THROW(Correspondence(make_lattice_body(cells_of({20})), fine), InputError);
  EXPECT_THROW(Correspondence(make_lattice_body(cells_of({5, 5, 5})), fine), InputError);
  CorrespondenceSettings walls = fine;
  walls.plane = Plane::strain;
  EXPECT_THROW(Correspondence(make_lattice_body(cells_of({20, 20})), walls), InputError);
}

// The published factor is one for the metre: in a body a thousand times as large it is a thousandth of what
// the same numbers mean in millimetres, squared.
TEST(Correspondence, ShowsThatThePublishedStabilisationDependsOnTheUnit) {
  std::array<double, 2> share{};
  for (std::size_t n = 0; n < 2; ++n) {
    LatticeBodyInput in = cells_of({9, 9});
    const double scale = n == 0 ? 1 : 1000;
    in.spacing *= scale;
    in.horizon *= scale;
    in.thickness *= scale;
    in.shape = Box{{}, {0.45 * scale, 0.45 * scale, 1e9}};
    CorrespondenceSettings settings{.material = law_case("neo_hookean").material()};
    const auto spring = [&](Stabilisation stabilisation) {
      settings.stabilisation = stabilisation;
      Correspondence model(make_lattice_body(in), settings);
      return model.spring(middle_point(model.body()));
    };
    share[n] = spring(Stabilisation::published) / spring(Stabilisation::energy);
  }
  EXPECT_NEAR(share[0] / share[1], 1e6, 1e-3);
}

}  // namespace
}  // namespace riven::testing
