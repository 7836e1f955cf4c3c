#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "spacetime/temporal_basis.hpp"

namespace riven {

/// Weights of a slab's three vectors: the displacement u that it starts from, then its two unknowns.
using SlabWeights = std::array<double, 3>;

/// A place in a slab where forces are asked for.
struct SlabStage {
  double s = 0;       // slab time
  double weight = 0;  // of the quadrature over the slab, which work is summed by
  SlabWeights displacement{};
  SlabWeights velocity{};  // over h
  std::array<double, 2> test{};
};

/// A scheme of time-discontinuous elements as numbers. A slab of length h starts from u and v; its two
/// unknown vectors x obey, for a = 1, 2,
///
///   R_a = sum_b P_ab M (x_b - u) / h^2 - p_a M v / h + sum over stages of test_a (f - f_ext) = 0
///
/// and the second one is the displacement at its end. Space-time theory (11), (10a).
struct SlabScheme {
  Eigen::Matrix2d inertia;              // P
  Eigen::Vector2d start;                // p
  std::vector<SlabStage> stages;        // in the order of time
  QuadraticLagrange path;               // nodes where u and the unknowns are on the slab's parabola
  SlabWeights end_velocity{};           // over h
  SlabWeights displacement_at_start{};  // at 0+
  SlabWeights velocity_at_start{};      // at 0+, over h
  /// Weights of the stages' values in the value at 0+; none where displacements are continuous.
  std::vector<double> stage_at_start;

  /// Q, the factor of K in a linear slab: sum over stages of test times displacement.
  [[nodiscard]] Eigen::Matrix2d stiffness() const;
};

/// Displacements continuous and quadratic in time, velocities jump; rows 2 and 3 of the published system.
SlabScheme single_field_scheme(std::size_t gauss_points);
/// Displacements and velocities linear in time, both jump: Radau's collocation at 1/3 and 1.
SlabScheme two_field_scheme();

}  // namespace riven
