#pragma once

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "load/mirror.hpp"
#include "support/point_states.hpp"

namespace riven::testing {

/// All loaded edges follow u = G X; a face is a load of its own.
inline Constraints follow(const PointModel& model, const Eigen::Matrix3d& gradient) {
  const Body& body = model.body();
  std::array<std::optional<FaceLoad>, 6> loads;
  for (std::size_t face = 0; face < 2 * static_cast<std::size_t>(body.dimension); ++face) {
    loads[face] = FaceLoad{.displacement = {}, .load = face};
    for (int d = 0; d < body.dimension; ++d)
      loads[face]->displacement[static_cast<std::size_t>(d)] = [gradient, d](const Point& x, double) {
        return gradient.row(d).dot(Eigen::Vector3d(x.data()));
      };
  }
  Constraints constraints(model.dofs(), 7);
  add_mirror_constraints(body, loads, model.conservative(), constraints);
  constraints.set_parameter(1);
  return constraints;
}

/// Holds a free body in a state to its balance of momentum and angular momentum, and to what a random
/// rotation does to it: the energy stays, forces turn with the body, and rotation alone has none. `rounding`:
/// of forces and energies that do not see the rotation, over the largest force; of those of the rotation
/// alone.
inline void expect_momentum_and_objectivity(PointModel& model, const std::vector<double>& u, Random& random,
                                            double rounding, double rounding_of_rigid) {
  const Body& body = model.body();
  const auto force = force_of(model, u);
  const double largest = largest_of(force);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), moment = sum;
  for (const std::size_t i : body.points) {
    const Eigen::Vector3d f = vector_of(force, body, i);
    sum += f;
    moment += (place(body, i) + vector_of(u, body, i)).cross(f);
  }
  EXPECT_LT(sum.norm(), 1e-12 * largest);
  EXPECT_LT(moment.norm(), 1e-12 * largest);  // levers of about 1 m

  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (body.dimension == 2) turn.topLeftCorner<2, 2>() = random.rotation();
  if (body.dimension == 3)
    turn = Eigen::AngleAxisd(random.between(0, 3), Eigen::Vector3d(1, 2, -2).normalized()).toRotationMatrix();
  auto turned = u;
  for (const std::size_t i : body.points) {
    const Eigen::Vector3d x = place(body, i);
    set_vector(turned, body, i, turn * (x + vector_of(u, body, i)) - x);
  }
  EXPECT_NEAR(model.strain_energy(turned), model.strain_energy(u), rounding * model.strain_energy(u));
  const auto turned_force = force_of(model, turned);
  for (const std::size_t i : body.points)
    EXPECT_LT((vector_of(turned_force, body, i) - turn * vector_of(force, body, i)).norm(),
              rounding * largest);
  const auto rigid = force_of(model, homogeneous(model, turn - Eigen::Matrix3d::Identity()));
  EXPECT_LT(largest_of(rigid), rounding_of_rigid * largest);
}

/// Largest difference of a model's forces in a random state from those of plain loops, over the largest
/// force: on a lattice and in a list, by every instruction set.
template <class Model, class Settings>
double difference_from_plain_loops(const Body& lattice, const Settings& settings, double size,
                                   unsigned seed) {
  double worst = 0;
  for (const InstructionSet set : supported_sets()) {
    const UseSet use(set);
    for (const bool lists : {false, true}) {
      Model model(lists ? listed(lattice) : lattice, settings);
      Random states(seed);
      const auto u = random_displacements(model, states, size);
      const auto force = force_of(model, u), plain = plain_force(model, settings, u);
      for (std::size_t i = 0; i < force.size(); ++i)
        worst = std::max(worst, std::abs(force[i] - plain[i]) / largest_of(plain));
    }
  }
  return worst;
}

/// A sheet with a crack through all of it, at y = 0.
inline Body halved_sheet() {
  LatticeBodyInput in = cells_of({14, 12});
  in.defects.cracks.push_back({{-2, 0.01, 0}, {2, 0.01, 0}});
  return make_lattice_body(in);
}

/// What the upper half of such a sheet does, the lower one does not feel.
inline void expect_cut_bonds_to_carry_nothing(PointModel& model, Random& random) {
  const Body& body = model.body();
  const auto u = random_displacements(model, random, 0.05);
  auto moved = u;
  const Eigen::Vector3d away(random.between(-1, 1), 5, 0);
  for (const std::size_t i : body.points)
    if (body.position(i)[1] > 0.01)
      set_vector(moved, body, i, vector_of(u, body, i) + 0.1 * place(body, i) + away);
  const auto force = force_of(model, u), other = force_of(model, moved);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::size_t i : body.points) {
    if (body.position(i)[1] > 0.01) continue;
    EXPECT_EQ(vector_of(force, body, i), vector_of(other, body, i));
    sum += vector_of(force, body, i);
  }
  EXPECT_LT(sum.norm(), 1e-12 * largest_of(force));
  const auto fields = model.fields(u);
  EXPECT_EQ(fields[0].name, "damage");
  EXPECT_GT(largest_of(fields[0].values), 0.4);
}

/// Force, energy and bound of the stiffness have the same bits on any number of threads.
inline void expect_same_bits_on_threads(const std::function<std::unique_ptr<PointModel>()>& make) {
  const int before = omp_get_max_threads();
  std::vector<std::vector<double>> results;
  for (const int threads : {1, 2, 3, 7}) {
    omp_set_num_threads(threads);
    const auto model = make();
    Random states(12);
    const auto u = random_displacements(*model, states, 0.05);
    auto& result = results.emplace_back(force_of(*model, u));
    result.push_back(model->strain_energy(u));
    std::vector<double> bound(model->dofs());
    model->stiffness_bound(u, bound);
    result.insert(result.end(), bound.begin(), bound.end());
  }
  omp_set_num_threads(before);
  for (const auto& result : results) EXPECT_EQ(result, results.front());
}

}  // namespace riven::testing
