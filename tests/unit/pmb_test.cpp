#include "peridynamics/pmb.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "base/error.hpp"
#include "support/energy_gradient.hpp"
#include "support/pmb_bodies.hpp"

namespace riven::testing {
namespace {

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

std::vector<double> force_of(Pmb& model, const std::vector<double>& u) {
  std::vector<double> force(model.dofs(), 0.0);
  EXPECT_FALSE(model.internal_force(u, force));
  return force;
}

std::vector<double> plain_force_of(const Pmb& model, const std::vector<double>& u) {
  std::vector<double> force(model.dofs(), 0.0);
  model.plain_force(u, force);
  return force;
}

/// Bonds that exist, as pairs of positions in the order of the points.
std::vector<std::vector<Point>> families(const Body& body) {
  std::vector<std::vector<Point>> all;
  for (const std::size_t i : body.points) {
    auto& family = all.emplace_back();
    body.for_each_neighbour(i, [&](std::size_t j) { family.push_back(body.position(j)); });
    std::sort(family.begin(), family.end());
  }
  return all;
}

/// Takes a model through a state: forces of the state, after bonds that it overloads have broken.
void lose_bonds(Pmb& model, std::span<const double> u, std::span<double> force) {
  EXPECT_FALSE(model.internal_force(u, force));
  EXPECT_FALSE(model.advance(u, force).breakdown);
}

// Every kernel gives the plain loops' forces, on random bodies whose bonds broke at random.
TEST(Pmb, KernelsAgreeWithPlainLoops) {
  Random random(4711);
  for (int n = 0; n < 30; ++n) {
    const int dimension = 1 + n % 3;
    const Body lattice = make_lattice_body(random_cells(random, dimension, n % 2 == 0));
    const double limit = random.between(0.05, 0.3);
    const unsigned seed = static_cast<unsigned>(random.integer(0, 1 << 30));
    for (const InstructionSet set : supported_sets()) {
      const UseSet use(set);
      for (const bool lists : {false, true}) {
        Pmb model(lists ? listed(lattice) : lattice, kGlass);
        model.set_limits(FailureLimits::uniform(limit));
        Random states(seed);
        const auto breaking = random_displacements(model, states, 0.2);
        std::vector<double> ignored(model.dofs());
        lose_bonds(model, breaking, ignored);
        const auto u = random_displacements(model, states, 0.1);
        const auto force = force_of(model, u), plain = plain_force_of(model, u);
        // Sums of up to 300 terms; each loses digits as 1/L - 1/r does at strains of a tenth.
        const double tolerance = 1e-13 * largest(plain);
        for (std::size_t i = 0; i < force.size(); ++i)
          ASSERT_NEAR(force[i], plain[i], tolerance) << name(set) << (lists ? " listed " : " lattice ") << n;
      }
    }
  }
}

TEST(Pmb, BreaksTheBondsBeyondTheirLimitAtBothEnds) {
  Random random(99);
  for (int n = 0; n < 12; ++n) {
    const Body lattice = make_lattice_body(random_cells(random, 1 + n % 3, true));
    constexpr double kLimit = 0.12;
    const unsigned seed = static_cast<unsigned>(random.integer(0, 1 << 30));
    std::vector<std::vector<std::vector<Point>>> results;
    for (const InstructionSet set : supported_sets()) {
      const UseSet use(set);
      for (const bool lists : {false, true}) {
        Pmb whole(lists ? listed(lattice) : lattice, kGlass), model(whole.body(), kGlass);
        model.set_limits(FailureLimits::uniform(kLimit));
        Random states(seed);
        const auto u = random_displacements(model, states, 0.15);
        std::vector<double> force(model.dofs());
        lose_bonds(model, u, force);
        const Body& body = model.body();
        const auto exists = [&](std::size_t i, std::size_t j) {
          bool found = false;
          body.for_each_neighbour(i, [&](std::size_t k) { found = found || k == j; });
          return found;
        };
        int broken = 0;
        for (const std::size_t i : bonded_points(body))
          whole.body().for_each_neighbour(i, [&](std::size_t j) {
            double length2 = 0, r2 = 0;
            for (std::size_t d = 0; d < static_cast<std::size_t>(body.dimension); ++d) {
              const double xi = body.position(j)[d] - body.position(i)[d];
              const double y = xi + u[d * body.size() + j] - u[d * body.size() + i];
              length2 += xi * xi;
              r2 += y * y;
            }
            const double stretch = std::sqrt(r2 / length2) - 1;
            EXPECT_EQ(exists(i, j), exists(j, i));
            if (std::abs(stretch - kLimit) > 1e-12) {
              EXPECT_EQ(exists(i, j), stretch < kLimit) << stretch;
            }
            broken += exists(i, j) ? 0 : 1;
          });
        EXPECT_GT(broken, 0);
        // What breaks at a state exerts no force at that state, and takes its energy along.
        EXPECT_EQ(force, force_of(model, u));
        EXPECT_NEAR(model.dissipated_energy(), whole.strain_energy(u) - model.strain_energy(u),
                    1e-12 * whole.strain_energy(u));
        results.push_back(families(body));
        if (lists) {  // listed points keep the lattice's order
          EXPECT_EQ(results.back().size(), results.front().size());
        }
      }
    }
  }
}

TEST(Pmb, TryingAStateBreaksNothing) {
  Random random(5);
  Pmb model(make_lattice_body(cells_of({12, 9})), kGlass);
  model.set_limits(FailureLimits::uniform(0.01));
  const auto before = families(model.body());
  static_cast<void>(force_of(model, random_displacements(model, random, 0.2)));
  EXPECT_EQ(families(model.body()), before);
  EXPECT_EQ(model.dissipated_energy(), 0);
}

TEST(Pmb, ForceIsMinusTheGradientOfTheEnergy) {
  Random random(31);
  for (int n = 0; n < 12; ++n) {
    const Body lattice = make_lattice_body(random_cells(random, 1 + n % 3, true));
    Pmb model(n % 2 == 0 ? lattice : listed(lattice), kGlass);
    SCOPED_TRACE(n);
    expect_force_is_gradient(model, random);
  }
}

// A whole family has the continuum's energy under equal strain in all directions, at any horizon down to one
// spacing: that is how c is made. In one dimension the stress is exact, too.
TEST(Pmb, HasTheContinuumsEnergyUnderDilatation) {
  const double strain = 1e-6, e = kGlass.youngs_modulus;
  struct Row {
    std::vector<int> cells;
    Plane plane;
    double energy;  // density over strain^2
  };
  for (const Row& row :
       {Row{{31}, Plane::stress, e / 2}, Row{{21, 21}, Plane::stress, e / (1 - 1.0 / 3)},
        Row{{21, 21}, Plane::strain, e / (1.25 * 0.5)}, Row{{15, 15, 15}, Plane::stress, 3 * e}})
    for (const double horizon : {1.0, 1.5, 2.0, 3.0, 4.0}) {
      PmbSettings settings = kGlass;
      settings.plane = row.plane;
      const Body lattice = make_lattice_body(cells_of(row.cells, horizon));
      for (const bool lists : {false, true}) {
        Pmb model(lists ? listed(lattice) : lattice, settings);
        const Body& body = model.body();
        std::vector<double> u(model.dofs(), 0.0);
        std::size_t middle = 0;
        for (std::size_t n = 0; n < body.points.size(); ++n) {
          const Point x = body.position(body.points[n]);
          for (std::size_t d = 0; d < row.cells.size(); ++d)
            u[d * body.size() + body.points[n]] = strain * x[d];
          if (std::hypot(x[0], x[1], x[2]) < 1e-9) middle = n;
        }
        const auto fields = model.fields(u);
        // Displacements of 1e-6 are exact to 1e-16 / 1e-6 of the bonds' strain.
        EXPECT_NEAR(fields[1].values[middle], row.energy * strain * strain,
                    1e-9 * row.energy * strain * strain);
        const double dilatation_stress = 2 * row.energy / static_cast<double>(row.cells.size()) * strain;
        EXPECT_NEAR(fields[2].values[9 * middle], dilatation_stress, 1e-5 * dilatation_stress);
      }
    }
}

// Poisson's ratio comes out of the bonds: uniaxial strain gives the ratio of stresses nu / (1 - nu), as far
// as the lattice is isotropic.
TEST(Pmb, HasItsPoissonsRatio) {
  for (const int dimension : {2, 3}) {
    const Body lattice =
        make_lattice_body(dimension == 2 ? cells_of({31, 31}, 6) : cells_of({15, 15, 15}, 5));
    Pmb model(lattice, kGlass);
    const Body& body = model.body();
    std::vector<double> u(model.dofs(), 0.0);
    std::size_t middle = 0;
    for (std::size_t n = 0; n < body.points.size(); ++n) {
      const Point x = body.position(body.points[n]);
      u[body.points[n]] = 1e-7 * x[0];
      if (std::hypot(x[0], x[1], x[2]) < 1e-9) middle = n;
    }
    const auto stress = model.fields(u)[2].values;
    const double ratio = stress[9 * middle + 4] / stress[9 * middle], nu = model.poissons_ratio();
    // Plane stress: P_y / P_x = nu; 3D: nu / (1 - nu). Lattices of 5 and 6 spacings are isotropic to 8 %.
    EXPECT_NEAR(ratio, dimension == 2 ? nu : nu / (1 - nu), 0.08 * ratio);
  }
}

TEST(Pmb, KeepsMomentumAndDoesNotSeeRotations) {
  Random random(17);
  for (const int dimension : {2, 3}) {
    const Body body = make_lattice_body(dimension == 2 ? cells_of({14, 11}) : cells_of({8, 7, 9}));
    for (const bool lists : {false, true}) {
      Pmb model(lists ? listed(body) : body, kGlass);
      const std::size_t n = model.body().size();
      const auto u = random_displacements(model, random, 0.1);
      const auto force = force_of(model, u);
      for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) sum += force[d * n + i];
        EXPECT_NEAR(sum, 0, 1e-12 * largest(force));
      }
      Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
      if (dimension == 2) turn.topLeftCorner<2, 2>() = random.rotation();
      if (dimension == 3)
        turn = Eigen::AngleAxisd(random.between(0, 3), Eigen::Vector3d(1, 2, -2).normalized())
                   .toRotationMatrix();
      auto turned = u;
      const auto vector_of = [&](const std::vector<double>& from, std::size_t i) {
        Eigen::Vector3d v = Eigen::Vector3d::Zero();
        for (int d = 0; d < dimension; ++d) v[d] = from[static_cast<std::size_t>(d) * n + i];
        return v;
      };
      for (const std::size_t i : model.body().points) {
        const Point p = model.body().position(i);
        const Eigen::Vector3d x(p[0], p[1], p[2]), now = turn * (x + vector_of(u, i)) - x;
        for (int d = 0; d < dimension; ++d) turned[static_cast<std::size_t>(d) * n + i] = now[d];
      }
      EXPECT_NEAR(model.strain_energy(turned), model.strain_energy(u), 1e-12 * model.strain_energy(u));
      const auto turned_force = force_of(model, turned);
      for (const std::size_t i : model.body().points)
        EXPECT_LT((vector_of(turned_force, i) - turn * vector_of(force, i)).norm(), 1e-12 * largest(force));
    }
  }
}

TEST(Pmb, BoundsTheStiffnessTightly) {
  Random random(8);
  for (const int dimension : {1, 2, 3}) {
    const Body body = make_lattice_body(dimension == 1   ? cells_of({20})
                                        : dimension == 2 ? cells_of({9, 8})
                                                         : cells_of({5, 5, 4}));
    for (const bool lists : {false, true}) {
      Pmb model(lists ? listed(body) : body, kGlass);
      const auto u = random_displacements(model, random, 0.02);
      std::vector<double> bound(model.dofs());
      model.stiffness_bound(u, bound);
      std::vector<std::size_t> entries;
      for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
        for (const std::size_t i : model.body().points) entries.push_back(d * model.body().size() + i);
      const auto size = static_cast<Eigen::Index>(entries.size());
      Eigen::MatrixXd k(size, size);
      const double h = 1e-6 * model.body().spacing;
      for (Eigen::Index c = 0; c < size; ++c) {
        auto ahead = u, behind = u;
        ahead[entries[static_cast<std::size_t>(c)]] += h;
        behind[entries[static_cast<std::size_t>(c)]] -= h;
        const auto f = force_of(model, ahead), g = force_of(model, behind);
        for (Eigen::Index r = 0; r < size; ++r)
          k(r, c) =
              -(f[entries[static_cast<std::size_t>(r)]] - g[entries[static_cast<std::size_t>(r)]]) / (2 * h);
      }
      // All masses are the same, so the bound of the largest frequency is that of the largest eigenvalue.
      const double exact =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (k + k.transpose())).eigenvalues().maxCoeff();
      EXPECT_GE(largest(bound), exact * (1 - 1e-6));
      // Twice the own blocks would need every bond's ends to move against each other: 1.5 times the
      // eigenvalue in 2D, 1.6 in 3D, so the step is 0.78 of the limit or more.
      EXPECT_LE(largest(bound), 1.8 * exact);
    }
  }
}

TEST(Pmb, HasTheSameBitsOnAnyNumberOfThreads) {
  Random random(3);
  const int before = omp_get_max_threads();
  const Body body = make_lattice_body(cells_of({13, 12, 11}));
  for (const bool lists : {false, true}) {
    std::vector<std::vector<double>> results;
    const unsigned seed = 12;
    for (const int threads : {1, 2, 3, 7}) {
      omp_set_num_threads(threads);
      Pmb model(lists ? listed(body) : body, kGlass);
      model.set_limits(FailureLimits::uniform(0.1));
      Random states(seed);
      auto& result = results.emplace_back(model.dofs());
      const auto u = random_displacements(model, states, 0.1);
      lose_bonds(model, u, result);
      result.push_back(model.dissipated_energy());
      result.push_back(model.strain_energy(u));
    }
    for (const auto& result : results) EXPECT_EQ(result, results.front());
  }
  omp_set_num_threads(before);
}

TEST(Pmb, RefusesInclusions) {
  LatticeBodyInput in = cells_of({20, 20});
  in.defects.inclusions.emplace_back(Disc{{}, 0.3});
  EXPECT_THROW(Pmb(make_lattice_body(in), kGlass), InputError);
}

}  // namespace
}  // namespace riven::testing
