// What models whose bonds break have in common: limits by pairs of materials, the energy that goes, and what
// is left.

#include <gtest/gtest.h>
#include <omp.h>

#include <functional>
#include <map>
#include <memory>
#include <set>

#include "base/error.hpp"
#include "body/listed_body.hpp"
#include "peridynamics/bond_membrane.hpp"
#include "peridynamics/correspondence.hpp"
#include "peridynamics/lps.hpp"
#include "peridynamics/membrane.hpp"
#include "peridynamics/pmb.hpp"
#include "support/bodies.hpp"
#include "support/energy_gradient.hpp"
#include "support/laws.hpp"
#include "support/point_states.hpp"

namespace riven::testing {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

struct Kind {
  const char* name;
  std::function<std::unique_ptr<BreakingModel>(Body, double)> make;  // with one or two materials
  bool two_materials = true;
  bool conservative = true;
};

/// The second material is `ratio` times as stiff.
const std::vector<Kind> kKinds = {
    {"pmb",
     [](Body body, double ratio) {
       return std::make_unique<Pmb>(std::move(body),
                                    std::vector{PmbSettings{.youngs_modulus = 3, .density = 1},
                                                {.youngs_modulus = 3 * ratio, .density = 2}});
     }},
    {"lps",
     [](Body body, double ratio) {
       return std::make_unique<Lps>(
           std::move(body),
           std::vector{LpsSettings{.youngs_modulus = 3, .poissons_ratio = 0.25, .density = 1},
                       LpsSettings{.youngs_modulus = 3 * ratio, .poissons_ratio = 0.25, .density = 2}});
     }},
    {"correspondence",
     [](Body body, double ratio) {
       Material second = unit_laws()[0].material();
       second.law = NeoHookean{std::get<NeoHookean>(second.law).c10 * ratio};
       return std::make_unique<Correspondence>(
           std::move(body),
           CorrespondenceSettings{.material = unit_laws()[0].material(), .further = {second}});
     }},
    {"membrane",
     [](Body body, double /*ratio*/) {
       return std::make_unique<Membrane>(std::move(body), unit_laws()[0].material(), 4);
     },
     false},
    {"membrane-bond",
     [](Body body, double /*ratio*/) {
       return std::make_unique<BondMembrane>(std::move(body), unit_laws()[0].material(),
                                             BondMembraneSettings{.zero_residual = true});
     },
     false, false}};

Body sheet_of(bool as_list, int nx = 16, int ny = 12) {
  const Body lattice = make_lattice_body(sheet(nx, ny, 0.1));
  return as_list ? listed(lattice) : lattice;
}

/// Points above y = 0 have the second material.
Body of_two(Body body) {
  std::vector<std::size_t> upper;
  for (std::size_t n = 0; n < body.points.size(); ++n)
    if (body.position(body.points[n])[1] > 0) upper.push_back(n);
  body.mark(body.material, upper, 1);
  return body;
}

std::vector<double> stretched(const PointModel& model, double stretch) {
  std::vector<double> u(model.dofs(), 0.0);
  const Body& body = model.body();
  for (const std::size_t i : body.points)
    for (std::size_t d = 0; d < 2; ++d) u[d * body.size() + i] = stretch * body.position(i)[d];
  return u;
}

std::vector<double> lose_bonds(BreakingModel& model, const std::vector<double>& u) {
  std::vector<double> force(model.dofs());
  EXPECT_FALSE(model.internal_force(u, force));
  EXPECT_FALSE(model.advance(u, force).breakdown);
  return force;
}

/// Calls visit(point, end, exists) for all bonds of a whole body.
template <class Visit>
void for_each_pair(const Body& whole, const Body& broken, const Visit& visit) {
  for (const std::size_t i : whole.points) {
    std::vector<std::size_t> left;
    broken.for_each_neighbour(i, [&](std::size_t j) { left.push_back(j); });
    whole.for_each_neighbour(
        i, [&](std::size_t j) { visit(i, j, std::find(left.begin(), left.end(), j) != left.end()); });
  }
}

void for_each_model(const std::function<void(const Kind&, bool)>& visit) {
  for (const Kind& kind : kKinds)
    for (const bool as_list : {false, true}) {
      SCOPED_TRACE(std::string(kind.name) + (as_list ? ", listed" : ", lattice"));
      visit(kind, as_list);
    }
}

// The second material is five times as stiff: so is the energy of its points away from the interface.
TEST(BondFailure, PointsHaveTheEnergyOfTheirMaterial) {
  for_each_model([](const Kind& kind, bool as_list) {
    if (!kind.two_materials) return;
    const Body body = of_two(sheet_of(as_list));
    auto model = kind.make(body, 5);
    const auto u = stretched(*model, 0.02);
    double upper = 0, lower = 0;  // of the outer rows, which see no end of the other material
    for (const std::size_t i : body.points)
      if (std::abs(body.position(i)[1]) > 0.3)
        (body.position(i)[1] > 0 ? upper : lower) += model->family_energy(i, u);
    EXPECT_GT(lower, 0);
    EXPECT_NEAR(upper / lower, 5, 1e-10);
  });
}

TEST(BondFailure, AnInterfaceBreaksAtItsOwnLimitAndNowhereElse) {
  for_each_model([](const Kind& kind, bool as_list) {
    const Body whole = of_two(sheet_of(as_list));
    for (const auto& [interface, sides] : {std::pair(0.01, 0.03), std::pair(0.03, 0.01)}) {
      auto model = kind.make(whole, 5);
      model->set_limits({{sides, interface, interface, sides}, {}});
      lose_bonds(*model, stretched(*model, 0.02));
      int broken = 0;
      for_each_pair(whole, model->body(), [&](std::size_t i, std::size_t j, bool exists) {
        const bool across = whole.material_of(i) != whole.material_of(j);
        EXPECT_EQ(exists, (across ? interface : sides) > 0.02);
        broken += exists ? 0 : 1;
      });
      EXPECT_GT(broken, 0);
    }
  });
}

TEST(BondFailure, ProtectedPointsKeepAllTheirBonds) {
  for_each_model([](const Kind& kind, bool as_list) {
    Body whole = sheet_of(as_list);
    whole.mark(whole.unbreakable, std::vector<std::size_t>{3, 40, 41, 100}, 1);
    auto model = kind.make(whole, 1);
    model->set_limits(FailureLimits::uniform(0.01));
    lose_bonds(*model, stretched(*model, 0.02));
    for_each_pair(whole, model->body(), [&](std::size_t i, std::size_t j, bool exists) {
      EXPECT_EQ(exists, whole.is_unbreakable(i) || whole.is_unbreakable(j));
    });
  });
}

TEST(BondFailure, APointThatHasLostTooManyBondsLosesTheRest) {
  for_each_model([](const Kind& kind, bool as_list) {
    const Body whole = of_two(sheet_of(as_list));
    auto model = kind.make(whole, 1);
    // Across the interface a row of points loses 9, 5 and 2 of its 28 bonds.
    model->set_limits({{kNever, 0.01, 0.01, 0.5}, {kNever, 0.3}});
    lose_bonds(*model, stretched(*model, 0.02));
    const Body& body = model->body();
    for (const std::size_t i : body.points) {
      const Point x = whole.position(i);
      if (std::abs(x[0]) > 0.4) continue;  // whole families
      const bool upper_row = x[1] > 0 && x[1] < 0.1;
      EXPECT_EQ(body.family_size(i) == 0, upper_row) << x[1];
    }
  });
}

// The load grows along x; no bond has a limit of stretch.
TEST(BondFailure, APointWithTooMuchEnergyLosesAllItsBonds) {
  for_each_model([](const Kind& kind, bool as_list) {
    Body whole = sheet_of(as_list);
    whole.mark(whole.unbreakable, std::vector<std::size_t>{14, 15}, 1);
    auto model = kind.make(whole, 1);
    std::vector<double> u = stretched(*model, 0.02);
    Random random(21);
    for (const std::size_t i : whole.points)
      u[i] = u[i] * (1.5 + whole.position(i)[0]) + 1e-3 * random.between(-1, 1);
    std::vector<double> density;
    std::vector<bool> loaded(whole.size(), false);
    for (const std::size_t i : whole.points) density.push_back(model->family_energy(i, u) / whole.volume[i]);
    std::vector<double> sorted = density;
    std::sort(sorted.begin(), sorted.end());
    const double limit = 0.5 * (sorted[150] + sorted[151]);
    for (std::size_t n = 0; n < density.size(); ++n) loaded[whole.points[n]] = density[n] > limit;
    FailureLimits limits = FailureLimits::uniform(kNever);
    limits.energy_density = {limit};
    model->set_limits(limits);
    double highest = 0;
    for (std::size_t n = 0; n < density.size(); ++n)
      if (!whole.is_unbreakable(whole.points[n])) highest = std::max(highest, density[n]);
    EXPECT_NEAR(model->overload(u), std::sqrt(highest / limit), 1e-12);
    lose_bonds(*model, u);
    for_each_pair(whole, model->body(), [&](std::size_t i, std::size_t j, bool exists) {
      const bool held = whole.is_unbreakable(i) || whole.is_unbreakable(j);
      EXPECT_EQ(exists, held || (!loaded[i] && !loaded[j]));
    });
    EXPECT_GT(model->dissipated_energy(), 0);
  });
}

TEST(BondFailure, TakesTheEnergyOfTheBondsAlongAndLeavesAGradient) {
  Random random(8);
  for_each_model([&](const Kind& kind, bool as_list) {
    for (int n = 0; n < 3; ++n) {
      auto model = kind.make(of_two(sheet_of(as_list, 9, 8)), 3);
      model->set_limits({{0.03, 0.05, 0.05, 0.04}, {}});
      std::vector<double> u = stretched(*model, 0.02);
      for (double& value : u) value += 0.002 * random.between(-1, 1);
      const double before = model->strain_energy(u);
      const std::vector<double> force = lose_bonds(*model, u);
      EXPECT_EQ(force, force_of(*model, u));  // what broke pulls no more
      EXPECT_GT(model->dissipated_energy(), 1e-3 * before);
      EXPECT_NEAR(model->dissipated_energy(), before - model->strain_energy(u), 1e-12 * before);
      if (kind.conservative) expect_force_is_gradient(*model, u, random);
    }
  });
}

// In a homogeneous state the energy of a family is its share; the stabilisation, s tr K in a whole one, keeps
// the same.
TEST(BondFailure, LeavesTheStabilisationItsShare) {
  for (const bool as_list : {false, true}) {
    Correspondence model(of_two(sheet_of(as_list)),
                         {.material = unit_laws()[0].material(), .further = {unit_laws()[0].material()}});
    const auto u = stretched(model, 0.02);
    const auto stabilisation = [&](std::size_t i) {
      double trace = 0;
      model.body().for_each_neighbour(i, [&](std::size_t j) {
        const double length = (place(model.body(), j) - place(model.body(), i)).norm();
        trace += length;  // influence 1/L, cells of one volume
      });
      return model.spring(i) * trace;
    };
    const std::vector<std::size_t>& points = model.body().points;
    std::vector<double> energy, stiffness;
    for (const std::size_t i : points) {
      energy.push_back(model.family_energy(i, u));
      stiffness.push_back(stabilisation(i));
    }
    model.set_limits({{kNever, 0.01, 0.01, kNever}, {}});
    lose_bonds(model, u);
    double least = 1;
    for (std::size_t n = 0; n < points.size(); ++n) {
      const double share = model.family_energy(points[n], u) / energy[n];
      EXPECT_NEAR(stabilisation(points[n]) / stiffness[n], share, 1e-9);
      least = std::min(least, share);
    }
    EXPECT_LT(least, 0.8);
  }
}

// Bonds along x break in all families, which are then turned inside out: all lengths stay. A membrane's
// family goes over to its deformation gradient first.
TEST(BondFailure, CrushedFamiliesAreDebrisForGood) {
  for_each_model([](const Kind& kind, bool as_list) {
    if (kind.name != std::string("correspondence") && kind.name != std::string("membrane")) return;
    auto model = kind.make(sheet_of(as_list), 1), other = kind.make(sheet_of(as_list), 1);
    for (auto* one : {&model, &other}) (*one)->set_limits(FailureLimits::uniform(0.028));
    const Body& body = model->body();
    const auto along_x = [&](double stretch) {
      std::vector<double> u(model->dofs(), 0.0);
      for (const std::size_t i : body.points) u[i] = stretch * body.position(i)[0];
      return u;
    };
    lose_bonds(*model, along_x(0.03));
    const double dissipated = model->dissipated_energy();
    EXPECT_GT(dissipated, 0);
    EXPECT_GT(model->strain_energy(along_x(0.01)), 0);
    for (int times = 0; times < 2; ++times) lose_bonds(*model, along_x(-2));
    EXPECT_NEAR(model->dissipated_energy(), dissipated, 1e-9);  // nothing was stretched
    Snapshot snapshot;
    model->save(snapshot);
    other->restore(snapshot);
    for (auto* one : {&model, &other}) EXPECT_EQ((*one)->strain_energy(along_x(0.01)), 0);
  });
}

// An estimate of frequencies tries large motions.
TEST(BondFailure, AskingForTheStableStepBreaksNothing) {
  for_each_model([](const Kind& kind, bool as_list) {
    auto model = kind.make(sheet_of(as_list), 1);
    model->set_limits(FailureLimits::uniform(0.028));
    std::vector<double> u = stretched(*model, 0.02);
    for (const std::size_t i : model->body().points) u[i] *= 1.5 + model->body().position(i)[0];
    lose_bonds(*model, u);
    const double dissipated = model->dissipated_energy(), energy = model->strain_energy(u);
    EXPECT_GT(dissipated, 0);
    std::vector<double> force(model->dofs()), bound(model->dofs());
    for (int times = 0; times < 25; ++times) {
      EXPECT_FALSE(model->internal_force(u, force));
      model->stiffness_bound(u, bound);
      EXPECT_EQ(model->advance(u, force).broken, 0u);
    }
    EXPECT_EQ(model->dissipated_energy(), dissipated);
    EXPECT_EQ(model->strain_energy(u), energy);
  });
}

// Where families are compressed so far that their averages are unstable, they change to their deformation
// gradients, which give the same energy in a homogeneous state.
TEST(BondFailure, AMembraneKeepsItsEnergyWhenItsFamiliesChange) {
  for (const bool as_list : {false, true}) {
    Membrane model(sheet_of(as_list), unit_laws()[0].material(), 4);
    model.set_limits(FailureLimits::uniform(2));
    std::vector<double> u(model.dofs(), 0.0);
    for (const std::size_t i : model.body().points) u[i] = -0.45 * model.body().position(i)[0];
    const double before = model.strain_energy(u);
    EXPECT_EQ(model.points_by_gradient(), 4u);  // the corners
    lose_bonds(model, u);
    EXPECT_EQ(model.points_by_gradient(), model.body().points.size());
    EXPECT_NEAR(model.strain_energy(u), before, 1e-9 * before);
    EXPECT_NEAR(model.dissipated_energy(), 0, 1e-9 * before);
  }
}

// One bond in the middle of a wide sheet, most of whose families are whole.
TEST(BondFailure, AMembraneTakesFamiliesAtACrackByTheirGradients) {
  Random random(31);
  for (const bool as_list : {false, true}) {
    const Body whole = sheet_of(as_list, 48, 20);
    Membrane model(whole, unit_laws()[0].material(), 4);
    model.set_limits(FailureLimits::uniform(0.04));
    std::vector<double> u = stretched(model, 0.01);
    for (double& value : u) value += 2e-4 * random.between(-1, 1);
    const std::size_t middle = whole.points[whole.points.size() / 2 + 24];
    u[middle] += 0.004;
    lose_bonds(model, u);
    std::set<std::size_t> cut, at_crack;
    for_each_pair(whole, model.body(), [&](std::size_t i, std::size_t, bool exists) {
      if (!exists) cut.insert(i);
    });
    at_crack = cut;
    for (const std::size_t i : cut) whole.for_each_neighbour(i, [&](std::size_t j) { at_crack.insert(j); });
    EXPECT_GT(cut.size(), 0u);
    EXPECT_LT(cut.size(), 10u);
    EXPECT_EQ(model.points_by_gradient(), at_crack.size() + 4);  // and the corners
    expect_force_is_gradient(model, u, random);
  }
}

// The load opens the middle of the sheet, a little more each time.
TEST(BondFailure, IsAsSymmetricAsItsLoad) {
  for_each_model([](const Kind& kind, bool as_list) {
    const Body whole = sheet_of(as_list);
    auto model = kind.make(whole, 1);
    model->set_limits(FailureLimits::uniform(0.02));
    std::size_t broken = 0;
    for (const double load : {0.02, 0.025, 0.03, 0.035}) {
      std::vector<double> u(model->dofs(), 0.0);
      for (const std::size_t i : whole.points) {
        const Point x = whole.position(i);
        u[i] = -0.3 * load * x[0];
        u[whole.size() + i] = load * x[1] * (0.4 + std::cos(2 * x[0])) / (0.3 + std::abs(x[1]));
      }
      const std::vector<double> force = lose_bonds(*model, u);
      for (const auto& [mx, my] : {std::pair(-1, 1), std::pair(1, -1)}) {
        std::map<std::pair<long, long>, std::size_t> at;
        for (const std::size_t i : whole.points) {
          const Point x = whole.position(i);
          at[{std::lround(x[0] / 0.05), std::lround(x[1] / 0.05)}] = i;
        }
        const auto mirror = [&, mx = mx, my = my](std::size_t i) {
          const Point x = whole.position(i);
          return at.at({mx * std::lround(x[0] / 0.05), my * std::lround(x[1] / 0.05)});
        };
        std::set<std::pair<std::size_t, std::size_t>> gone;
        for_each_pair(whole, model->body(), [&](std::size_t i, std::size_t j, bool exists) {
          if (!exists) gone.insert({i, j});
        });
        for (const auto& [i, j] : gone) EXPECT_TRUE(gone.contains({mirror(i), mirror(j)}));
        for (const std::size_t i : whole.points) EXPECT_NEAR(force[i], mx * force[mirror(i)], 1e-12);
        broken = gone.size();
      }
    }
    EXPECT_GT(broken, 100u);
    EXPECT_LT(broken, 16u * 12u * 20u);
  });
}

TEST(BondFailure, LeavesNoForceInARotatedBody) {
  Random random(12);
  for_each_model([&](const Kind& kind, bool as_list) {
    auto model = kind.make(sheet_of(as_list), 1);
    model->set_limits(FailureLimits::uniform(0.02));
    std::vector<double> u = stretched(*model, 0.015);
    for (double& value : u) value += 0.002 * random.between(-1, 1);
    lose_bonds(*model, u);
    EXPECT_GT(model->dissipated_energy(), 0);
    const Body& body = model->body();
    const double angle = 1.2, c = std::cos(angle), s = std::sin(angle);
    for (const std::size_t i : body.points) {
      const Point x = body.position(i);
      u[i] = c * x[0] - s * x[1] - x[0];
      u[body.size() + i] = s * x[0] + c * x[1] - x[1];
    }
    std::vector<double> force(model->dofs());
    EXPECT_FALSE(model->internal_force(u, force));
    for (const double value : force) EXPECT_NEAR(value, 0, 1e-12);  // moduli of 1, cells of 0.1
  });
}

TEST(BondFailure, HasTheSameBitsOnAnyNumberOfThreadsAndAfterARestore) {
  const int before = omp_get_max_threads();
  for_each_model([&](const Kind& kind, bool as_list) {
    std::vector<std::vector<double>> results;
    for (const int threads : {1, 2, 3, 7}) {
      omp_set_num_threads(threads);
      Random random(77);
      auto model = kind.make(of_two(sheet_of(as_list)), 3), other = kind.make(of_two(sheet_of(as_list)), 3);
      for (auto* one : {&model, &other}) (*one)->set_limits({{0.02, 0.03, 0.03, 0.025}, {}});
      std::vector<double> u = stretched(*model, 0.015);
      for (double& value : u) value += 0.002 * random.between(-1, 1);
      results.push_back(lose_bonds(*model, u));
      results.back().push_back(model->dissipated_energy());
      Snapshot snapshot;
      model->save(snapshot);
      other->restore(snapshot);
      for (double& value : u) value += 0.001 * random.between(-1, 1);
      const std::vector<double> first = lose_bonds(*model, u), second = lose_bonds(*other, u);
      EXPECT_EQ(first, second);
      EXPECT_EQ(model->dissipated_energy(), other->dissipated_energy());
      EXPECT_EQ(model->strain_energy(u), other->strain_energy(u));
    }
    for (const auto& result : results) EXPECT_EQ(result, results.front());
  });
  omp_set_num_threads(before);
}

/// Energy per area that the bonds across y = 0 take with them, the body stretched equally by `stretch`: from
/// two lengths of it, so that the ends do not count.
double released(const Kind& kind, double stretch) {
  double energy[2];
  for (const int n : {0, 1}) {
    auto model = kind.make(of_two(sheet_of(false, 16 + 8 * n, 14)), 1);
    model->set_limits({{kNever, 0.5 * stretch, 0.5 * stretch, kNever}, {}});
    lose_bonds(*model, stretched(*model, stretch));
    energy[n] = model->dissipated_energy();
  }
  return (energy[1] - energy[0]) / (8 * 0.1 * 0.7);
}

TEST(BondFailure, ACrackReleasesTheCriticalEnergy) {
  for (const Kind& kind : kKinds) {
    auto model = kind.make(sheet_of(false), 1);
    const double stretch = model->critical_stretch(1e-4, 0, 0);
    EXPECT_NEAR(released(kind, stretch) / 1e-4, 1, 1e-9) << kind.name;
  }
}

// 9 E s^2 delta / (4 pi) for linear bonds in the plane, and C1 (2 l^2 + l^-4 - 3) delta / pi for a
// neo-Hookean membrane at the stretch l (theory, section 6), within what a sum over some hundred bonds errs
// by.
TEST(BondFailure, HasTheCriticalStretchOfTheContinuumForLongHorizons) {
  LatticeBodyInput in = sheet(30, 30, 0.1);
  in.horizon = 1.2;
  const Pmb model(make_lattice_body(in), PmbSettings{.youngs_modulus = 3, .density = 1});
  const double s = model.critical_stretch(1e-3, 0, 0);
  EXPECT_NEAR(9 * 3 * s * s * 1.2 / (4 * std::numbers::pi) / 1e-3, 1, 0.06);

  const Material rubber = unit_laws()[0].material();
  const Membrane membrane(make_lattice_body(in), rubber, 4);
  const double l = 1 + membrane.critical_stretch(1, 0, 0), c1 = std::get<NeoHookean>(rubber.law).c10;
  EXPECT_NEAR(c1 * (2 * l * l + std::pow(l, -4) - 3) * 1.2 / std::numbers::pi, 1, 0.06);
}

TEST(BondFailure, RefusesLimitsThatAreNone) {
  auto model = kKinds[0].make(of_two(sheet_of(false)), 1);
  EXPECT_THROW(model->set_limits(FailureLimits::uniform(0.1)), InputError);  // two materials
  EXPECT_THROW(model->set_limits(FailureLimits::uniform(-0.1, 2)), InputError);
  EXPECT_THROW(model->set_limits(FailureLimits::uniform(std::nan(""), 2)), InputError);
  Correspondence bonds(sheet_of(false),
                       CorrespondenceSettings{.material = unit_laws()[0].material(),
                                              .stabilisation = Stabilisation::bond_associated});
  EXPECT_THROW(bonds.set_limits(FailureLimits::uniform(0.1)), InputError);
}

TEST(BondFailure, TellsHowNearItIs) {
  for_each_model([](const Kind& kind, bool as_list) {
    auto model = kind.make(sheet_of(as_list), 1);
    const auto u = stretched(*model, 0.02);
    EXPECT_EQ(model->overload(u), 0);
    model->set_limits(FailureLimits::uniform(0.05));
    EXPECT_NEAR(model->overload(u), 0.4, 1e-12);
  });
}

}  // namespace
}  // namespace riven::testing
