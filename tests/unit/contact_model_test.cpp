// Bodies and impactors that meet: what goes on from one to the other, and what is kept.

#include "load/contact_model.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include "solver/velocity_verlet.hpp"
#include "support/contact_bodies.hpp"
#include "support/model_properties.hpp"
#include "support/stopped_run.hpp"

namespace riven::testing {
namespace {

constexpr double kModulus = 1e6, kDensity = 1000;
constexpr PmbSettings kRubbery{.youngs_modulus = kModulus, .density = kDensity};

/// A model of the body with contact of the default stiffness; impactors get theirs from it.
std::unique_ptr<ContactModel> with_contact(Body from, bool self, std::vector<Impactor> impactors,
                                           std::optional<double> critical_stretch = {}) {
  auto model = std::make_unique<Pmb>(std::move(from), kRubbery);
  if (critical_stretch) model->set_limits(FailureLimits::uniform(*critical_stretch));
  const Body& body = model->body();
  const ContactStiffness stiffness = contact_stiffness(*model, body);
  std::optional<SelfContactSettings> contact;
  if (self) contact = SelfContactSettings{body.spacing, stiffness.per_pair};
  for (Impactor& impactor : impactors) impactor.stiffness = stiffness.per_volume;
  return std::make_unique<ContactModel>(std::move(model), body, contact, std::move(impactors));
}

struct Watch : Observer {
  void reached(const State& state, const Constraints&, bool) override {
    states.push_back(state);
    worst_balance = std::max(worst_balance, std::abs(state.energy.error()));
  }
  std::vector<State> states;
  double worst_balance = 0;
};

/// Momentum (kg m/s) along the axes of a state's entries from `first`, planes of `size` entries.
Eigen::Vector3d momentum(const std::vector<double>& mass, const State& state, std::size_t first,
                         std::size_t size, int dimension) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int d = 0; d < dimension; ++d)
    for (std::size_t n = 0; n < size; ++n) {
      const std::size_t e = first + static_cast<std::size_t>(d) * size + n;
      sum[d] += mass[e] * state.v[e];
    }
  return sum;
}

/// A bar of two halves of n points each, without a bond between them.
Body two_bars(int n) {
  Body body = make_lattice_body(cells_of({2 * n}, 2));
  for (const std::size_t i : body.points)
    for (const std::size_t j : neighbours_of(body, i))
      if (body.position(i)[0] < 0 && body.position(j)[0] > 0) cut_bond(body, i, j);
  return body;
}

TEST(ContactModel, EqualBarsExchangeTheirVelocities) {
  // The wave of the impact runs to the free ends and back in 2 L / c: then the bars part, the one at rest,
  // the other with the whole velocity. What a lattice's dispersion and a contact softer than the bar keep in
  // vibrations falls as the bars get finer.
  constexpr double kSpeed = 1;  // c = sqrt(E / rho) = 31.6 m/s
  const auto left_over = [&](int n) {
    auto model = with_contact(two_bars(n), true, {});
    Constraints none(model->dofs(), 7);
    const double transit = 2 * 0.1 * n / std::sqrt(kModulus / kDensity);
    VelocityVerletSettings settings{.until = 1.5 * transit, .every = transit, .history_every = transit / 50};
    settings.initial_v.assign(model->dofs(), 0.0);
    const auto place = model->positions();
    std::vector<double> mass(model->dofs());
    model->mass(mass);
    double half = 0;
    std::size_t entry = 0;
    for (const Point& at : place) {
      while (mass[entry] == 0) ++entry;
      if (at[0] < 0) {
        settings.initial_v[entry] = kSpeed;
        half += mass[entry];
      }
      ++entry;
    }
    Watch watch;
    const State end = march(*model, none, settings, watch);
    double left = 0, right = 0;
    for (std::size_t e = 0; e < mass.size(); ++e)
      (model->place(e)[0] < 0 ? left : right) += mass[e] * end.v[e];
    EXPECT_NEAR(left + right, half * kSpeed, 1e-12 * half);
    EXPECT_LT(watch.worst_balance, 0.01);
    return left / half;
  };
  const double coarse = left_over(20), fine = left_over(80), finest = left_over(320);
  EXPECT_LT(std::abs(coarse), 0.02);  // 0.0100, then 0.0047 and 0.0019 measured
  EXPECT_LT(std::abs(fine), 0.6 * std::abs(coarse));
  EXPECT_LT(std::abs(finest), 0.6 * std::abs(fine));
}

struct Collision {
  double balance = 0, gap = 1e300;
  Eigen::Vector3d lower_before, lower_after, sum_before, sum_after;
  double moment_change = 0, moment_scale = 0;
};

/// The two halves of a sheet run into each other, one faster, and askew.
Collision collide(std::optional<double> step, bool self, double speed) {
  auto model = with_contact(halved_sheet(), self, {});
  const Body body = halved_sheet();
  Constraints none(model->dofs(), 7);
  VelocityVerletSettings settings{.until = 0.12, .every = 0.12, .history_every = 0.002, .step = step};
  settings.initial_v.assign(model->dofs(), 0.0);
  std::vector<double> mass(model->dofs());
  model->mass(mass);
  for (const std::size_t i : body.points)
    set_vector(settings.initial_v, body, i,
               place(body, i)[1] < 0.01 ? Eigen::Vector3d(0.2 * speed, speed, 0)
                                        : Eigen::Vector3d(0, -0.5 * speed, 0));
  Watch watch;
  march(*model, none, settings, watch);
  Collision result;
  const auto sums = [&](const State& state, Eigen::Vector3d& lower, Eigen::Vector3d& all, double& moment) {
    lower = all = Eigen::Vector3d::Zero();
    moment = 0;
    for (const std::size_t i : body.points) {
      const Eigen::Vector3d p = mass[i] * vector_of(state.v, body, i);
      all += p;
      if (place(body, i)[1] < 0.01) lower += p;
      moment += deformed(body, state.u, i).cross(p)[2];
      result.moment_scale += deformed(body, state.u, i).norm() * p.norm();
    }
  };
  double before = 0, after = 0;
  sums(watch.states.front(), result.lower_before, result.sum_before, before);
  sums(watch.states.back(), result.lower_after, result.sum_after, after);
  result.moment_change = after - before;
  result.balance = watch.worst_balance;
  for (const State& state : watch.states)
    for (const std::size_t i : body.points)
      for (const std::size_t j : body.points)
        if (place(body, i)[1] < 0.01 && place(body, j)[1] > 0.01 &&
            std::abs(deformed(body, state.u, i)[0] - deformed(body, state.u, j)[0]) < 0.05)
          result.gap = std::min(result.gap, deformed(body, state.u, j)[1] - deformed(body, state.u, i)[1]);
  return result;
}

TEST(ContactModel, HalvesOfASheetBounceAndKeepWhatIsConserved) {
  // A tenth of the waves' speed, 33 m/s.
  const Collision coarse = collide(1e-3, true, 3), fine = collide(5e-4, true, 3);
  for (const Collision& c : {coarse, fine}) {
    EXPECT_GT(c.gap, 0.05);  // of 0.1, the spacing; 0.071 measured
    EXPECT_GT(c.lower_before[1], 0);
    EXPECT_LT(c.lower_after[1], 0);
    EXPECT_LT((c.sum_after - c.sum_before).norm(), 1e-13 * c.lower_before.norm());
    EXPECT_LT(std::abs(c.moment_change), 1e-12 * c.moment_scale);
  }
  // 2.6e-3 and 6.4e-4 measured.
  EXPECT_NEAR(std::log2(coarse.balance / fine.balance), 2, 0.5);
  // Without contact they do not notice each other.
  const Collision through = collide(1e-3, false, 3);
  EXPECT_LT(through.gap, -0.2);
  EXPECT_LT((through.lower_after - through.lower_before).norm(), 1e-12 * through.lower_before.norm());
}

TEST(ContactModel, ASphereBouncesOffAPointAsPointsOfMassDo) {
  // Along a line, until they part: v' = (m - M) / (m + M) v and so on, with an error of the step squared.
  const Body one = make_lattice_body(cells_of({1}, 1));
  const double m = kDensity * one.volume[one.points[0]], big = 0.7 * m, speed = 2, stiffness = 1e7;
  const auto error = [&](double step) {
    auto inner = std::make_unique<Pmb>(one, kRubbery);
    const Body& body = inner->body();
    ContactModel model(
        std::move(inner), body, std::nullopt,
        {{.name = "ball", .shape = RigidSphere{{-0.3, 0, 0}, 0.2}, .mass = big, .stiffness = stiffness}});
    Constraints none(model.dofs(), 7);
    VelocityVerletSettings settings{.until = 0.2, .every = 0.2, .history_every = 0.2, .step = step};
    settings.initial_v.assign(model.dofs(), 0.0);
    settings.initial_v[model.impactor_entry(0)] = speed;
    Watch watch;
    const State end = march(model, none, settings, watch);
    const double ball = end.v[model.impactor_entry(0)], point = end.v[body.points[0]];
    EXPECT_NEAR(big * ball + m * point, big * speed, 1e-13 * big * speed);
    EXPECT_EQ(model.force_on_impactor(0, end.u)[0], 0);
    return std::abs(ball - (big - m) / (m + big) * speed) / speed;
  };
  const double period = 2 * M_PI * std::sqrt(m * big / (m + big) / (stiffness * one.volume[one.points[0]]));
  // The error swings with where in a step the contact begins and ends: its largest over a few steps.
  const auto worst = [&](double part) {
    double most = 0;
    for (int n = 0; n < 16; ++n) most = std::max(most, error(part * period * (1 - 0.02 * n)));
    return most;
  };
  const double coarse = worst(0.04), fine = worst(0.00125);  // 2.6e-3 and 2.3e-6 measured
  EXPECT_NEAR(std::log2(coarse / fine) / 5, 2, 0.25);
}

TEST(ContactModel, ASphereBouncesOffAFreePlate) {
  const Body plate = make_lattice_body(cells_of({12, 12, 4}, 2));
  const auto impact = [&](std::optional<double> step) {
    auto model = with_contact(plate, false,
                              {{.name = "ball", .shape = RigidSphere{{0.02, -0.03, 0.5}, 0.3}, .mass = 200}});
    Constraints none(model->dofs(), 7);
    VelocityVerletSettings settings{.until = 0.08, .every = 0.08, .history_every = 0.002, .step = step};
    settings.initial_v.assign(model->dofs(), 0.0);
    const std::size_t ball = model->impactor_entry(0);
    settings.initial_v[ball + 2] = -3;
    std::vector<double> mass(model->dofs());
    model->mass(mass);
    Watch watch;
    const State end = march(*model, none, settings, watch);
    const Eigen::Vector3d of_plate = momentum(mass, end, 0, plate.size(), 3),
                          of_ball = momentum(mass, end, ball, 1, 3);
    EXPECT_LT((of_plate + of_ball - Eigen::Vector3d(0, 0, -600)).norm(), 1e-11 * 600);
    EXPECT_LT(of_plate[2], -100);
    EXPECT_GT(of_ball[2], -500);
    return watch.worst_balance;
  };
  const double coarse = impact(1e-3), fine = impact(1.25e-4);
  // 4.5e-4 and 3.5e-6 measured: contacts begin somewhere in a step, so that the order is one of many octaves.
  EXPECT_LT(impact({}), 0.005);  // 1.2e-3 measured
  EXPECT_NEAR(std::log2(coarse / fine) / 3, 2, 0.5);
}

TEST(ContactModel, APlaneThatIsPushedDoesWork) {
  // A wall comes with constant velocity from the left: its work is what the sheet gets, and its force changes
  // the momentum of the sheet.
  const Body sheet = make_lattice_body(cells_of({10, 6}));
  auto model = with_contact(sheet, false, {{.name = "wall", .shape = RigidPlane{{-0.5, 0, 0}, {1, 0, 0}}}});
  Constraints constraints(model->dofs(), 7);
  const std::size_t wall = model->impactor_entry(0);
  constraints.add({.slave = wall, .terms = {{[](const Point&, double t) { return 2 * t; }, {}, 0, 1, 6}}});
  constraints.add({.slave = wall + 1, .terms = {{[](const Point&, double) { return 0.0; }, {}, 1, 1, 6}}});
  Watch watch;
  const State end =
      march(*model, constraints, {.until = 0.05, .every = 0.05, .history_every = 5e-4, .step = 5e-4}, watch);
  EXPECT_EQ(end.u[wall], 0.1);
  EXPECT_GT(end.energy.kinetic, 0.1 * end.energy.external_work);
  EXPECT_GT(end.energy.external_work, 0);
  EXPECT_LT(watch.worst_balance, 0.01);  // 2.4e-3 measured
  double impulse = 0, momentum_x = 0;
  std::vector<double> mass(model->dofs());
  model->mass(mass);
  for (std::size_t s = 0; s < watch.states.size(); ++s)
    impulse -= (s == 0 || s + 1 == watch.states.size() ? 0.5 : 1) * 5e-4 *
               model->force_on_impactor(0, watch.states[s].u)[0];
  for (const std::size_t i : sheet.points) momentum_x += mass[i] * end.v[i];
  EXPECT_NEAR(impulse, momentum_x, 1e-12 * momentum_x);
}

using Stop = StopsAt<Watch>;

TEST(ContactModel, GoesOnFromASnapshotWithTheSameBitsOnAnyNumberOfThreads) {
  // Halves of a sheet that meet and break, with a disc and a wall.
  const auto make = [] {
    auto model = with_contact(halved_sheet(), true,
                              {{.name = "disc", .shape = RigidSphere{{0.1, 0.9, 0}, 0.3}, .mass = 3},
                               {.name = "wall", .shape = RigidPlane{{0, -0.6, 0}, {0, 1, 0}}}},
                              0.02);
    Constraints constraints(model->dofs(), 7);
    for (int axis = 0; axis < 2; ++axis)
      constraints.add({.slave = model->impactor_entry(1) + static_cast<std::size_t>(axis),
                       .terms = {{[axis](const Point&, double t) { return axis * t; }, {}, axis, 1, 6}}});
    return std::pair(std::move(model), std::move(constraints));
  };
  const auto run = [&](Observer& observer, const Snapshot* from) {
    auto [model, constraints] = make();
    VelocityVerletSettings settings{.until = 0.15, .every = 0.05, .history_every = 0.013};
    settings.initial_v.assign(model->dofs(), 0.0);
    settings.initial_v[model->impactor_entry(0) + 1] = -4;
    return march(*model, constraints, settings, observer, from);
  };
  Stop whole;
  const State expected = run(whole, nullptr);
  EXPECT_GT(expected.energy.dissipated, 0);
  EXPECT_GT(expected.v[expected.v.size() - 3], -3);  // the disc was pushed back
  const int threads_before = omp_get_max_threads();
  Random random(4);
  for (int trial = 0; trial < 4; ++trial) {
    omp_set_num_threads(trial + 1);
    Stop parts;
    State state;
    std::optional<Snapshot> from;
    for (long stop = random.integer(1, static_cast<int>(whole.points) - 1);; stop += random.integer(1, 40)) {
      parts.stop_at = stop;
      try {
        state = run(parts, from ? &*from : nullptr);
        break;
      } catch (const Stopped&) {
        from = parts.snapshot;
      }
    }
    EXPECT_EQ(parts.points, whole.points);
    EXPECT_EQ(state.u, expected.u);
    EXPECT_EQ(state.v, expected.v);
    EXPECT_EQ(state.energy.external_work, expected.energy.external_work);
    EXPECT_EQ(state.energy.strain, expected.energy.strain);
  }
  omp_set_num_threads(threads_before);
}

TEST(ContactModel, HardlyShortensTheStep) {
  // Halves that are pressed together: a contact adds half of a whole family's bound to a point on a face,
  // which has more than half of that by its bonds, those along the face being whole.
  auto alone = with_contact(halved_sheet(), false, {}), touching = with_contact(halved_sheet(), true, {});
  const Body body = halved_sheet();
  Constraints none(alone->dofs(), 7);
  std::vector<double> pressed(alone->dofs(), 0.0);
  for (const std::size_t i : body.points) pressed[body.size() + i] = -0.05 * body.position(i)[1];
  const double share = stable_step(*touching, none, pressed) / stable_step(*alone, none, pressed);
  EXPECT_GT(share, 0.9);  // 0.912 measured
  EXPECT_LT(share, 1);
}

}  // namespace
}  // namespace riven::testing
