#include "spacetime/slab_scheme.hpp"

namespace riven {

namespace {

SlabWeights values(const TemporalBasis& basis, double s) {
  return {basis.value(0, s), basis.value(1, s), basis.value(2, s)};
}

SlabWeights rates(const TemporalBasis& basis, double s) {
  return {basis.first(0, s), basis.first(1, s), basis.first(2, s)};
}

}  // namespace

Eigen::Matrix2d SlabScheme::stiffness() const {
  Eigen::Matrix2d q = Eigen::Matrix2d::Zero();
  for (const SlabStage& stage : stages)
    q += Eigen::Vector2d(stage.test[0], stage.test[1]) *
         Eigen::RowVector2d(stage.displacement[1], stage.displacement[2]);
  return q;
}

SlabScheme single_field_scheme(std::size_t gauss_points) {
  const QuadraticLagrange basis(0.5);
  const TemporalRule rule = gauss_rule(gauss_points);
  SlabScheme scheme{.inertia = temporal_matrices(basis, rule).inertia.bottomRightCorner<2, 2>(),
                    .start = {basis.first(1, 0), basis.first(2, 0)},
                    .stages = {},
                    .path = basis,
                    .end_velocity = rates(basis, 1),
                    .displacement_at_start = values(basis, 0),
                    .velocity_at_start = rates(basis, 0),
                    .stage_at_start = {}};
  for (std::size_t q = 0; q < gauss_points; ++q) {
    const double s = rule.point[q], w = rule.weight[q];
    scheme.stages.push_back(
        {s, w, values(basis, s), rates(basis, s), {w * basis.first(1, s), w * basis.first(2, s)}});
  }
  return scheme;
}

SlabScheme two_field_scheme() {
  const QuadraticLagrange path(1.0 / 3);
  const SlabWeights first = rates(path, path.node(1)), end = rates(path, 1);
  // R: velocities of the stages from the displacements since the start.
  Eigen::Matrix2d r;
  r << first[1], first[2], end[1], end[2];
  SlabScheme scheme{
      .inertia = r * r,
      .start = r.rowwise().sum(),
      .stages = {{path.node(1), 0.75, {0, 1, 0}, first, {1, 0}}, {1, 0.25, {0, 0, 1}, end, {0, 1}}},
      .path = path,
      .end_velocity = end,
      .displacement_at_start = {0, 1.5, -0.5},
      .velocity_at_start = {},
      .stage_at_start = {1.5, -0.5}};
  for (std::size_t k = 0; k < 3; ++k) scheme.velocity_at_start[k] = 1.5 * first[k] - 0.5 * end[k];
  return scheme;
}

}  // namespace riven
