#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <vector>

#include "model/model.hpp"
#include "support/differences.hpp"

namespace riven::testing {

/// The sum of blocks, of states of so many entries.
inline Eigen::MatrixXd sum_of(const TangentBlocks& blocks, std::size_t entries) {
  const auto size = static_cast<Eigen::Index>(entries);
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(size, size);
  std::size_t at = 0;
  for (std::size_t b = 0; b + 1 < blocks.begin.size(); ++b)
    for (std::size_t r = blocks.begin[b]; r < blocks.begin[b + 1]; ++r)
      for (std::size_t c = blocks.begin[b]; c < blocks.begin[b + 1]; ++c)
        k(static_cast<Eigen::Index>(blocks.dofs[r]), static_cast<Eigen::Index>(blocks.dofs[c])) +=
            blocks.values[at++];
  EXPECT_EQ(at, blocks.values.size());
  return k;
}

/// The tangent of a model, those of each half of its parts apart.
inline Eigen::MatrixXd assembled(const Model& model, const std::vector<double>& u) {
  TangentBlocks blocks;
  const std::size_t half = model.tangent_parts() / 2;
  model.tangent(u, 0, half, blocks);
  model.tangent(u, half, model.tangent_parts(), blocks);
  return sum_of(blocks, model.dofs());
}

/// Holds the tangent of a state to the change of the force along a direction, and to its symmetry. `step`: of
/// the differences, over the length of the direction's entries.
inline void expect_tangent_of_force(Model& model, const std::vector<double>& u,
                                    const std::vector<double>& direction, double step) {
  const auto force = [&](double t) {
    std::vector<double> moved = u;
    for (std::size_t i = 0; i < u.size(); ++i) moved[i] += t * direction[i];
    Eigen::VectorXd f = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(u.size()));
    EXPECT_FALSE(model.internal_force(moved, {f.data(), u.size()}));
    return f;
  };
  const Eigen::VectorXd change = derivative(force, 0, step);
  force(0);  // the tangent is asked for in the state of the last force
  const Eigen::MatrixXd k = assembled(model, u);
  // Products in another order.
  EXPECT_LT((k - k.transpose()).norm(), 1e-14 * k.norm());
  const Eigen::VectorXd product = k * Eigen::Map<const Eigen::VectorXd>(direction.data(), k.cols());
  // Rounding of forces of a strain's size over the step, 1e-16 / 1e-4, and of sums of hundreds of them.
  EXPECT_LT((change + product).cwiseAbs().maxCoeff(), 1e-9 * product.cwiseAbs().maxCoeff());
}

}  // namespace riven::testing
