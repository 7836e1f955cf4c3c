#pragma once

#include <gtest/gtest.h>

#include "support/pmb_bodies.hpp"

namespace riven::testing {

/// Holds the work of a model's force along a random change of a state to the change of its energy.
inline void expect_force_is_gradient(PointModel& model, const std::vector<double>& u, Random& random) {
  std::vector<double> force(model.dofs());
  ASSERT_FALSE(model.internal_force(u, force));
  const auto direction = random_displacements(model, random, 1);
  const double h = 1e-6;
  auto ahead = u, behind = u;
  double work = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    ahead[i] += h * direction[i];
    behind[i] -= h * direction[i];
    work -= force[i] * direction[i];
  }
  const double slope = (model.strain_energy(ahead) - model.strain_energy(behind)) / (2 * h);
  // Central differences err by h^2; the energies' rounding over h is what is left.
  EXPECT_NEAR(slope, work, 1e-12 * model.strain_energy(u) / h + 1e-7 * std::abs(work));
}

/// The same at a random state.
inline void expect_force_is_gradient(PointModel& model, Random& random) {
  expect_force_is_gradient(model, random_displacements(model, random, 0.05), random);
}

}  // namespace riven::testing
