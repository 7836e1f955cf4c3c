// Repulsion of points without a bond, against a loop over all pairs; what it conserves.

#include "load/self_contact.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include "support/contact_bodies.hpp"

namespace riven::testing {
namespace {

constexpr double kStiffness = 3e7;

/// A lattice has eight nearest neighbours in the plane and 26 in space; a point that lacks a bond to one of
/// them is exposed. In a list, any bond that is missing exposes.
bool is_exposed(const Body& body, std::size_t i) {
  const auto bonded = neighbours_of(body, i);
  if (body.on_lattice() == nullptr) return !body.complete[i] || bonded.size() < body.whole_family[i];
  int near = 0, all = 0;
  for (const std::size_t j : bonded)
    if ((place(body, j) - place(body, i)).lpNorm<Eigen::Infinity>() < 1.5 * body.spacing) ++near;
  for (const double length : body.on_lattice()->stencil.length)
    if (length < 1.8 * body.spacing) ++all;
  return near < all;
}

struct Sums {
  std::vector<double> force;
  double energy = 0;
  int contacts = 0;
};

/// All pairs, one by one.
Sums plain_contact(const Body& body, const std::vector<double>& u, double distance) {
  Sums sums{rest_of(body)};
  std::vector<std::size_t> exposed;
  for (const std::size_t i : body.points)
    if (is_exposed(body, i)) exposed.push_back(i);
  for (const std::size_t i : exposed) {
    const auto bonded = neighbours_of(body, i);
    for (const std::size_t j : exposed) {
      if (j == i) continue;
      const Eigen::Vector3d r = deformed(body, u, j) - deformed(body, u, i);
      const double reach = std::min(distance, (place(body, j) - place(body, i)).norm());
      if (r.norm() >= reach || std::find(bonded.begin(), bonded.end(), j) != bonded.end()) continue;
      const double stiffness = kStiffness * body.volume[i] * body.volume[j];
      set_vector(sums.force, body, i,
                 vector_of(sums.force, body, i) - stiffness * (reach - r.norm()) * r.normalized());
      sums.energy += 0.25 * stiffness * std::pow(reach - r.norm(), 2);
      ++sums.contacts;
    }
  }
  return sums;
}

Sums contact_of(SelfContact& contact, const Body& body, const std::vector<double>& u) {
  Sums sums{rest_of(body)};
  contact.add_force(u, sums.force);
  sums.energy = contact.energy(u);
  return sums;
}

void expect_same(const Sums& found, const Sums& plain) {
  const double largest = largest_of(plain.force);
  // Sums of a few dozen terms in another order: 2e-15 of the largest.
  for (std::size_t n = 0; n < plain.force.size(); ++n)
    ASSERT_NEAR(found.force[n], plain.force[n], 1e-13 * largest) << n;
  ASSERT_NEAR(found.energy, plain.energy, 1e-13 * plain.energy);
}

/// With a hole, perhaps a slit, and bonds that are cut at random.
Body random_contact_body(Random& random, int dimension, bool as_list) {
  const Body lattice = make_lattice_body(random_cells(random, dimension, random.chance(0.3)));
  Body body = as_list ? listed(lattice) : lattice;
  cut_bonds(body, random, random.integer(0, 300));
  return body;
}

/// Displacements of body points: waves long and short, of so many spacings.
std::vector<double> crumpled(const Body& body, Random& random, double size) {
  std::vector<double> u = rest_of(body);
  const Eigen::Matrix3d k = 4 * random_matrix(random, body.dimension);
  const Eigen::Matrix3d way = random_matrix(random, body.dimension);
  for (const std::size_t i : body.points) {
    const Eigen::Vector3d noise = random_matrix(random, body.dimension).col(0);
    const Eigen::Vector3d wave = (k * place(body, i)).array().sin();
    set_vector(u, body, i, size * body.spacing * (way * wave + 0.3 * noise));
  }
  return u;
}

TEST(SelfContact, IsTheSumOverAllPairs) {
  Random random(5);
  int contacts = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const int dimension = 1 + trial % 3;
    const Body body = random_contact_body(random, dimension, trial % 2 == 0);
    const double distance = body.spacing * random.between(0.8, std::min(1.3, body.horizon / body.spacing));
    SelfContact contact(body, {distance, kStiffness});
    const auto u = crumpled(body, random, random.between(0.3, 4));
    const Sums plain = plain_contact(body, u, distance);
    contacts += plain.contacts;
    expect_same(contact_of(contact, body, u), plain);
  }
  EXPECT_GT(contacts, 1000);
}

TEST(SelfContact, FollowsPointsAndBondsWithOneList) {
  Random random(6);
  for (int trial = 0; trial < 4; ++trial) {
    Body body = random_contact_body(random, 2 + trial % 2, trial % 3 == 0);
    SelfContact contact(body, {body.spacing, kStiffness});
    const auto from = rest_of(body), to = crumpled(body, random, 3);
    auto u = from;
    constexpr int kSteps = 120;
    for (int step = 0; step <= kSteps; ++step) {
      for (std::size_t n = 0; n < u.size(); ++n) u[n] = to[n] * step / kSteps;
      if (step % 40 == 10) cut_bonds(body, random, 30);
      expect_same(contact_of(contact, body, u), plain_contact(body, u, body.spacing));
    }
    // A point moves by some four spacings, and lists are made anew after 0.15.
    EXPECT_LT(contact.pairs().lists(), 60);
    EXPECT_GT(contact.pairs().lists(), 10);
  }
}

TEST(SelfContact, DoesNotPushAtRest) {
  Random random(7);
  for (int trial = 0; trial < 12; ++trial) {
    const Body body = random_contact_body(random, 1 + trial % 3, trial % 2 == 0);
    SelfContact contact(body, {body.horizon, kStiffness});
    const Sums sums = contact_of(contact, body, rest_of(body));
    EXPECT_EQ(largest_of(sums.force), 0);
    EXPECT_EQ(sums.energy, 0);
  }
}

TEST(SelfContact, ConservesMomentaAndEnergy) {
  Random random(8);
  for (int trial = 0; trial < 12; ++trial) {
    const Body body = random_contact_body(random, 1 + trial % 3, trial % 2 == 0);
    SelfContact contact(body, {body.spacing, kStiffness});
    const auto u = crumpled(body, random, 2), way = crumpled(body, random, 1);
    const auto force = contact_of(contact, body, u).force;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), moment = sum;
    double scale = 0, work = 0;
    for (const std::size_t i : body.points) {
      const Eigen::Vector3d f = vector_of(force, body, i);
      sum += f;
      moment += deformed(body, u, i).cross(f);
      scale += f.norm();
      work -= f.dot(vector_of(way, body, i));
    }
    // Rounding of each force and place.
    EXPECT_LT(sum.norm(), 1e-14 * scale);
    EXPECT_LT(moment.norm(), 1e-13 * scale);
    const double h = 1e-6;
    auto ahead = u, behind = u;
    for (std::size_t n = 0; n < u.size(); ++n) {
      ahead[n] += h * way[n];
      behind[n] -= h * way[n];
    }
    // Pairs that come into reach within h have a kink in their force: h of the stiffness.
    const double slope = (contact.energy(ahead) - contact.energy(behind)) / (2 * h);
    EXPECT_NEAR(slope, work, 1e-6 * scale * body.spacing);
  }
}

TEST(SelfContact, BoundsItsStiffness) {
  // v.dF <= sum of bound v^2 for any v, and equal for two points that meet head on.
  Random random(9);
  double worst = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Body body = random_contact_body(random, 1 + trial % 3, trial % 2 == 0);
    SelfContact contact(body, {body.spacing, kStiffness});
    const auto u = crumpled(body, random, 2);
    auto bound = rest_of(body);
    contact.add_bound(u, bound);
    for (int direction = 0; direction < 5; ++direction) {
      auto v = crumpled(body, random, 1);
      auto there = u;
      constexpr double h = 1e-9;
      for (std::size_t n = 0; n < u.size(); ++n) there[n] += h * v[n];
      const auto f = contact_of(contact, body, u).force, g = contact_of(contact, body, there).force;
      double rayleigh = 0, most = 0;
      for (std::size_t n = 0; n < u.size(); ++n) {
        rayleigh -= v[n] * (g[n] - f[n]) / h;
        most += bound[n] * v[n] * v[n];
      }
      worst = std::max(worst, rayleigh / most);
    }
  }
  EXPECT_LT(worst, 1);
  LatticeBodyInput two = cells_of({2}, 1);
  Body body = make_lattice_body(two);
  const std::size_t a = body.points[0], b = body.points[1];
  cut_bond(body, a, b);
  SelfContact contact(body, {body.spacing, kStiffness});
  auto u = rest_of(body), v = u, bound = u, f = u, g = u;
  u[a] = 0.01;
  v = u;
  v[a] += 1e-3;
  v[b] -= 1e-3;
  contact.add_bound(u, bound);
  contact.add_force(u, f);
  contact.add_force(v, g);
  const double stiffness = ((f[a] - g[a]) + (g[b] - f[b])) / 1e-3;
  EXPECT_NEAR(stiffness, bound[a] + bound[b], 1e-9 * stiffness);
  EXPECT_NEAR(f[a], -kStiffness * body.volume[a] * body.volume[b] * 0.01, 1e-12 * kStiffness);
}

TEST(SelfContact, HasTheSameBitsOnAnyNumberOfThreads) {
  const int before = omp_get_max_threads();
  std::vector<std::vector<double>> results;
  for (const int threads : {1, 2, 3, 7}) {
    omp_set_num_threads(threads);
    Random random(10);
    const Body body = random_contact_body(random, 3, false);
    SelfContact contact(body, {body.spacing, kStiffness});
    const auto u = crumpled(body, random, 2);
    auto& result = results.emplace_back(contact_of(contact, body, u).force);
    result.push_back(contact.energy(u));
  }
  omp_set_num_threads(before);
  for (const auto& result : results) EXPECT_EQ(result, results.front());
  EXPECT_GT(largest_of(results.front()), 0);
}

}  // namespace
}  // namespace riven::testing
