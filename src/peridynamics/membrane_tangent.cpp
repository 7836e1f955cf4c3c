// The tangent of the membrane, family by family.

#include <Eigen/LU>

#include "peridynamics/membrane.hpp"

namespace riven {

/// The energy is V (W(a, b) + k(a, b) z) with z = a - 2 M:M.
Membrane::SumHessian Membrane::sum_hessian(std::size_t point) const {
  const double a = planes_.mean_s2[point], b = planes_.mean_s4[point];
  const FamilyEnergy e = energy_by_averages(a, b);
  const FamilyEnergy k = stiffened_modulus(planes_.kappa[point], a, b);
  const auto m = flat<2>(gradient(point));
  const double z = a - 2 * m.squaredNorm();
  SumHessian h = SumHessian::Zero();
  h(0, 0) = e.waa + k.waa * z + 2 * k.wa;
  h(0, 1) = h(1, 0) = e.wab + k.wab * z + k.wb;
  h(1, 1) = e.wbb + k.wbb * z;
  h.block<4, 1>(2, 0) = -4 * k.wa * m;
  h.block<4, 1>(2, 1) = -4 * k.wb * m;
  h.block<2, 4>(0, 2) = h.block<4, 2>(2, 0).transpose();
  h.bottomRightCorner<4, 4>().diagonal().setConstant(-4 * k.w);
  return energy_volume_[point] * h;
}

/// The energy is V (W(F) + k (a - F:M)) with F = M S, S the inverse shape.
Membrane::SumHessian Membrane::sum_hessian(const ListedFamily& family) const {
  const std::size_t i = family.point;
  const PlaneResponse response = material_.plane_stress(2 * gradient(i));
  Eigen::Matrix4d by_m = Eigen::Matrix4d::Zero();  // dF/dM
  for (int r = 0; r < 2; ++r) by_m.block<2, 2>(2 * r, 2 * r) = family.inverse_shape;
  SumHessian h = SumHessian::Zero();
  h.bottomRightCorner<4, 4>() = by_m.transpose() * response.tangent * by_m - 2 * planes_.kappa[i] * by_m;
  return energy_volume_[i] * h;
}

/// With the gradients g_s of the six sums s by the bonds, the Hessian of the energy E is the sum of E_st g_s
/// g_t^T and, in each bond's own block, of E_a and E_b times the second derivatives of a and b.
void Membrane::tangent(std::span<const double> u, std::size_t first, std::size_t last,
                       TangentBlocks& to) const {
  for (std::size_t n = first; n < last; ++n) {
    const std::size_t i = body().points[n];
    const ListedFamily* family = listed_family(i);
    const PointForce law = point_force(i);
    const auto size = 2 * static_cast<Eigen::Index>(body().family_size(i));
    Eigen::Matrix<double, 6, Eigen::Dynamic> sums(6, size);
    Eigen::VectorXd pull(size);
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
    std::vector<End> ends;
    Eigen::Index at = 0;
    for_each_bond(i, [&](const MembraneBond& bond) {
      const Eigen::Vector2d y = deformed(i, bond, u);
      const double w = bond.weight / bond.reference.squaredNorm(),
                   s2 = y.squaredNorm() / bond.reference.squaredNorm();
      sums.block<1, 2>(0, at) = 2 * w * y.transpose();
      sums.block<1, 2>(1, at) = 4 * w * s2 * y.transpose();
      const Eigen::Vector2d m = w * bond.reference;
      sums.block<4, 2>(2, at) << m.x(), 0, m.y(), 0, 0, m.x(), 0, m.y();
      // The law has a = 2 E_a and b = 4 E_b.
      hessian.block<2, 2>(at, at) = w * ((law.a + law.b * s2) * Eigen::Matrix2d::Identity() +
                                         2 * law.b / bond.reference.squaredNorm() * y * y.transpose());
      pull.segment<2>(at) = bond_force(law, bond, y);
      ends.push_back(bond.end);
      at += 2;
    });
    if (ends.empty()) continue;  // its bonds lie on one line
    const SumHessian by_sums =
        family != nullptr && family->by_gradient ? sum_hessian(*family) : sum_hessian(i);
    hessian.noalias() += sums.transpose() * by_sums * sums;
    add_family_block(i, ends, pull, hessian, to);
  }
}

}  // namespace riven
