// Waves and long motions of the correspondence model: frequencies against sums over bonds, zero-energy modes,
// what the stabilisation's factor is chosen by, and the energy that Verlet's method keeps.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "solver/velocity_verlet.hpp"
#include "support/correspondence_reference.hpp"
#include "support/energy_errors.hpp"
#include "support/point_states.hpp"
#include "support/tangents.hpp"

namespace riven::testing {
namespace {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kSpacing = 0.1;  // m, of `cells_of`

VectorXd first_of(const Eigen::Vector3d& v, int dimension) {
  VectorXd head(dimension);
  for (int d = 0; d < dimension; ++d) head[d] = v[d];
  return head;
}

/// The family of a point of the endless lattice; `s` is the spring of its stabilisation over the volume.
struct Lattice {
  std::vector<VectorXd> xi;
  std::vector<double> weight;  // omega
  double moment = 0, whole = 0;
  MatrixXd inverse_shape;

  Lattice(int dimension, double horizon, Influence kind) {
    MatrixXd shape = MatrixXd::Zero(dimension, dimension);
    const int reach = static_cast<int>(horizon), across = dimension == 3 ? reach : 0;
    for (int a = -reach; a <= reach; ++a)
      for (int b = -reach; b <= reach; ++b)
        for (int c = -across; c <= across; ++c) {
          const double cells = std::sqrt(a * a + b * b + c * c);
          if (cells == 0 || cells > horizon) continue;
          const VectorXd x = kSpacing * first_of(Eigen::Vector3d(a, b, c), dimension);
          xi.push_back(x);
          weight.push_back(kind == Influence::inverse ? horizon / cells : 1);
          shape += weight.back() * x * x.transpose();
          moment += weight.back() * x.squaredNorm();
          whole += weight.back();
        }
    inverse_shape = shape.inverse();
  }
};

/// rho omega^2 of plane waves exp(i k x) (Pa/m^2), as the matrix of their polarisations, for a material with
/// Lame's constants and a spring s times the volume of a point (Pa/m^2).
MatrixXd stabilised(const Lattice& on, double lame, double shear, double spring, const VectorXd& k) {
  const auto dimension = k.size();
  VectorXd kappa = VectorXd::Zero(dimension);  // F's gradient of the wave, over i
  for (std::size_t n = 0; n < on.xi.size(); ++n) kappa += on.weight[n] * std::sin(k.dot(on.xi[n])) * on.xi[n];
  kappa = (on.inverse_shape * kappa).eval();
  double unexplained = 0;
  for (std::size_t n = 0; n < on.xi.size(); ++n) {
    const double phase = k.dot(on.xi[n]);
    unexplained += on.weight[n] *
                   (std::pow(1 - std::cos(phase), 2) + std::pow(std::sin(phase) - kappa.dot(on.xi[n]), 2));
  }
  return (lame + shear) * kappa * kappa.transpose() +
         (shear * kappa.squaredNorm() + spring * unexplained) * MatrixXd::Identity(dimension, dimension);
}

/// The same of the bond-associated variant: each bond replaces the part of the gradient along itself.
MatrixXd bond_associated(const Lattice& on, double lame, double shear, const VectorXd& k) {
  using Complex = std::complex<double>;
  const auto dimension = k.size();
  VectorXcd kappa = VectorXcd::Zero(dimension);
  for (std::size_t n = 0; n < on.xi.size(); ++n)
    kappa += Complex(0, on.weight[n] * std::sin(k.dot(on.xi[n]))) * on.xi[n];
  kappa = (on.inverse_shape * kappa).eval();
  MatrixXcd sum = MatrixXcd::Zero(dimension, dimension);
  for (std::size_t n = 0; n < on.xi.size(); ++n) {
    const double length = on.xi[n].norm();
    const VectorXd along = on.xi[n] / length;
    const Complex own = (std::exp(Complex(0, k.dot(on.xi[n]))) - 1.0) / length;
    const VectorXcd q = kappa + along * (own - (along.transpose() * kappa)(0));
    sum += on.weight[n] / on.whole *
           (lame * q.conjugate() * q.transpose() +
            shear * (q.squaredNorm() * MatrixXcd::Identity(dimension, dimension) + q * q.adjoint()));
  }
  return sum.real();  // bonds come in opposite pairs
}

/// The same from the model's force on the middle point of a body.
MatrixXd of_force(Correspondence& model, const VectorXd& k) {
  const Body& body = model.body();
  const std::size_t middle = middle_point(body);
  const int dimension = body.dimension;
  MatrixXd matrix(dimension, dimension);
  for (int axis = 0; axis < dimension; ++axis) {
    const double amplitude = 1e-5 * kSpacing;
    const auto wave = [&](double sign) {
      std::vector<double> u(model.dofs(), 0.0);
      for (const std::size_t i : body.points)
        u[static_cast<std::size_t>(axis) * body.size() + i] =
            sign * amplitude * std::cos(k.dot(first_of(place(body, i), dimension)));
      return force_of(model, u);
    };
    const auto there = wave(1), back = wave(-1);
    for (int d = 0; d < dimension; ++d) {
      const std::size_t entry = static_cast<std::size_t>(d) * body.size() + middle;
      matrix(d, axis) = -(there[entry] - back[entry]) / (2 * amplitude * body.volume[middle]);
    }
  }
  return matrix;
}

/// Lame's first constant in the dimensions of a body.
double lame_of(const CorrespondenceSettings& s, int dimension) {
  const SmallStrain moduli = s.material.small_strain();
  const double mu = moduli.shear, nu = moduli.poissons_ratio();
  return dimension == 2 && s.plane == Plane::stress ? 2 * mu * nu / (1 - nu) : 2 * mu * nu / (1 - 2 * nu);
}

VectorXd values(const MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(matrix).eigenvalues();
}

TEST(CorrespondenceWaves, HaveTheFrequenciesOfASumOverBonds) {
  Random random(41);
  for (int n = 0; n < 24; ++n) {
    const int dimension = n % 4 == 3 ? 3 : 2;
    const Body lattice = make_lattice_body(dimension == 2 ? cells_of({15, 15}) : cells_of({9, 9, 9}, 2));
    CorrespondenceSettings settings = random_correspondence(random, dimension, false);
    settings.stabilisation = kStabilisations[n % 3];
    Correspondence model(n % 2 == 0 ? lattice : listed(lattice), settings);
    VectorXd k(dimension);
    for (double& component : k) component = std::numbers::pi / kSpacing * random.between(-1, 1);
    const Lattice family(dimension, dimension == 2 ? 3 : 2, settings.influence);
    const double lame = lame_of(settings, dimension), shear = settings.material.small_strain().shear;
    const std::size_t middle = middle_point(model.body());
    const MatrixXd expected =
        settings.stabilisation == Stabilisation::bond_associated
            ? bond_associated(family, lame, shear, k)
            : stabilised(family, lame, shear, model.spring(middle) * model.body().volume[middle], k);
    // Central differences at strains of 1e-5 err by 1e-10 and by the 1e-14 of a stress in plane stress over
    // the strain.
    EXPECT_LT((of_force(model, k) - expected).norm(), 1e-8 * expected.norm()) << n;
  }
}

/// What waves of a lattice are like: smallest rho omega^2 / k^2 of any wave (Pa), largest stable step times
/// the speed of long pressure waves over the spacing.
struct Spectrum {
  double softest = 1e300, step = 0;
};

template <class Matrix>
Spectrum spectrum(const Matrix& matrix, double longitudinal) {
  constexpr int fineness = 48;
  Spectrum found;
  double fastest = 0;
  for (int a = 0; a <= fineness; ++a)
    for (int b = 0; b <= a; ++b) {
      if (a == 0) continue;
      const VectorXd k = std::numbers::pi / kSpacing / fineness * Eigen::Vector2d(a, b);
      const VectorXd squares = values(matrix(k));
      found.softest = std::min(found.softest, squares[0] / k.squaredNorm());
      fastest = std::max(fastest, squares[1]);
    }
  found.step = 2 / std::sqrt(fastest) * std::sqrt(longitudinal) / kSpacing;
  return found;
}

// The table of the theory, section 12: incompressible plane stress, 28 bonds of equal influence, the factor G
// of eq. (6), C1 = mu / 2.
TEST(CorrespondenceWaves, HaveTheSpectrumOfTheTheory) {
  const double shear = 2, lame = 2 * shear, bulk = lame + shear;  // of the plane, in C1
  const Lattice family(2, 3.015, Influence::constant);
  struct Row {
    double factor, softest, step;
  };
  for (const Row& row :
       {Row{0, 0, 4.26}, {0.1, 0.120, 3.47}, {0.25, 0.300, 2.30}, {0.5, 0.600, 1.62}, {1, 1.199, 1.15}}) {
    const double horizon = 3.015 * kSpacing;
    const double spring =
        row.factor * 16 * bulk / (std::numbers::pi * std::pow(horizon, 4)) * kSpacing * kSpacing;
    const Spectrum found = spectrum(
        [&](const VectorXd& k) { return stabilised(family, lame, shear, spring, k); }, lame + 2 * shear);
    EXPECT_NEAR(found.softest, row.softest, 1e-3);
    EXPECT_NEAR(found.step, row.step, 0.005 * row.step);
  }
  for (const bool inverse : {false, true}) {
    const Lattice on(2, 3.015, inverse ? Influence::inverse : Influence::constant);
    const Spectrum found =
        spectrum([&](const VectorXd& k) { return bond_associated(on, lame, shear, k); }, lame + 2 * shear);
    EXPECT_NEAR(found.softest, inverse ? 0.325 : 0.219, 1e-3);
    EXPECT_NEAR(found.step, inverse ? 2.20 : 2.67, 0.005 * found.step);
  }
}

// With the factor 1, which is the default, the error of shear waves is of fourth order in the wave number
// along the lattice's axes and diagonals, in any material; that of pressure waves stays of second order, and
// soft. A larger factor would make long shear waves faster than the material's.
TEST(CorrespondenceWaves, RunAtTheMaterialsShearSpeedWithTheDefaultFactor) {
  Random random(6);
  for (int n = 0; n < 12; ++n) {
    const int dimension = n % 3 == 2 ? 3 : 2;
    CorrespondenceSettings settings = random_correspondence(random, dimension, false);
    settings.stabilisation = Stabilisation::energy;
    settings.factor = 1;
    const double horizon = dimension == 2 ? 3 : 2;
    Correspondence model(make_lattice_body(dimension == 2 ? cells_of({9, 9}) : cells_of({6, 6, 6}, 2)),
                         settings);
    std::size_t whole = 0;
    while (!model.body().complete[whole]) ++whole;
    const Lattice family(dimension, horizon, settings.influence);
    const double lame = lame_of(settings, dimension), shear = settings.material.small_strain().shear;
    const double spring = model.spring(whole) * model.body().volume[whole];
    for (const bool diagonal : {false, true}) {
      VectorXd direction = VectorXd::Zero(dimension);
      direction[0] = 1;
      if (diagonal) direction = VectorXd::Ones(dimension).normalized();
      const auto errors = [&](double wavelength, double share) {  // of shear and pressure waves
        const double k = 2 * std::numbers::pi / (wavelength * kSpacing);
        const VectorXd squares =
            values(stabilised(family, lame, shear, share * spring, k * direction)) / (k * k);
        return Eigen::Vector2d(squares[0] / shear - 1, squares[dimension - 1] / (lame + 2 * shear) - 1);
      };
      const Eigen::Vector2d coarse = errors(48, 1), fine = errors(96, 1);
      EXPECT_NEAR(std::log2(coarse[0] / fine[0]), 4, 0.05);
      EXPECT_NEAR(std::log2(coarse[1] / fine[1]), 2, 0.05);
      EXPECT_LT(fine[1], 0);
      EXPECT_LT(std::abs(errors(24, 1)[0]), 2e-3);
      EXPECT_GT(errors(24, 1.5)[0], 0.01);
      EXPECT_LT(errors(24, 0.5)[0], -0.01);
    }
  }
}

/// Motions of a free block that take no energy.
int free_motions(const Correspondence& model) {
  const MatrixXd k = assembled(model, std::vector<double>(model.dofs(), 0.0));
  std::vector<Eigen::Index> entries;
  for (int d = 0; d < model.body().dimension; ++d)
    for (const std::size_t i : model.body().points)
      entries.push_back(static_cast<Eigen::Index>(static_cast<std::size_t>(d) * model.body().size() + i));
  const VectorXd eigenvalues = values(MatrixXd(k(entries, entries)));
  return static_cast<int>((eigenvalues.array() < 1e-9 * eigenvalues.maxCoeff()).count());
}

// Every variant has the rigid motions and no other motion without energy.
TEST(CorrespondenceWaves, HaveNoZeroEnergyModes) {
  for (const int dimension : {2, 3}) {
    LatticeBodyInput in = dimension == 2 ? cells_of({9, 8}) : cells_of({5, 4, 4}, 2);
    if (dimension == 2) in.defects.cracks.push_back({{-0.6, 0.01, 0}, {-0.2, 0.01, 0}});
    const Body body = make_lattice_body(in);
    for (const Stabilisation stabilisation : kStabilisations) {
      const CorrespondenceSettings settings{.material = law_case("neo_hookean").compressible(),
                                            .stabilisation = stabilisation,
                                            .factor = stabilisation == Stabilisation::published ? 0.01 : 1};
      EXPECT_EQ(free_motions(Correspondence(body, settings)), dimension == 2 ? 3 : 6);
    }
  }
}

// Rows that move to and fro by turns, which no deformation gradient sees, have forces in every variant, and
// none without stabilisation.
TEST(CorrespondenceWaves, OpposeRowsThatMoveByTurns) {
  for (const int dimension : {2, 3}) {
    const Body body = make_lattice_body(dimension == 2 ? cells_of({15, 15}) : cells_of({9, 9, 9}, 2));
    const double shear = law_case("neo_hookean").shear_modulus;
    const auto stiffness = [&](Stabilisation stabilisation, double factor) {
      Correspondence model(body, {.material = law_case("neo_hookean").compressible(),
                                  .stabilisation = stabilisation,
                                  .factor = factor});
      const VectorXd k = VectorXd::Constant(dimension, std::numbers::pi / kSpacing);
      return values(of_force(model, k))[0] / (shear * k.squaredNorm());
    };
    EXPECT_LT(stiffness(Stabilisation::energy, 0), 1e-9);
    EXPECT_GT(stiffness(Stabilisation::energy, 1), 0.05);
    EXPECT_GT(stiffness(Stabilisation::bond_associated, 0), 0.05);
  }
}

std::vector<double> energy_errors_of_rubber(double part_of_limit, long steps, int times) {
  Correspondence model(slit_plate(), {.material = law_case("neo_hookean").material()});
  return energy_errors(model, 1e-3, part_of_limit, steps, times);
}

// The same motion, looked at at the same times.
TEST(CorrespondenceWaves, KeepTheirEnergyToTheSquareOfTheStep) {
  const double coarse = root_mean_square(energy_errors_of_rubber(0.2, 4000, 1000)),
               fine = root_mean_square(energy_errors_of_rubber(0.1, 8000, 1000));
  EXPECT_NEAR(coarse / fine, 4, 0.02);  // measured 3.996, and 3.999 with half the steps
}

TEST(CorrespondenceWaves, DoNotLoseEnergyInManySteps) {
  // Measured 3.2e-6 of the energy, of errors of 4e-3 that come and go.
  EXPECT_NEAR(drift(energy_errors_of_rubber(0.2, 100000, 10000)), 0, 1e-5);
}

}  // namespace
}  // namespace riven::testing
