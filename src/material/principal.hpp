#pragma once

#include <Eigen/SVD>
#include <cmath>

#include "material/response.hpp"

namespace riven {

/// Energy of an isotropic law as a function of D principal stretches l_a: t_a = l_a dW/dl_a and
/// d_ab = l_b dt_a/dl_b (Pa).
template <int D>
struct PrincipalEnergy {
  double w = 0;
  Eigen::Matrix<double, D, 1> t;
  Eigen::Matrix<double, D, D> d;
};

/// Stress and (unless null) tangent of such an energy. In the frames of F = sum of l_a u_a v_a the stress is
/// w_a = t_a / l_a, and the tangent couples the pairs (a, b) and (b, a); rubber materials theory, eq. (7) and
/// (8), for P and F instead of S and C.
template <int D, class EnergyOfStretches>
double principal_response(const Eigen::Matrix<double, D, D>& f, const EnergyOfStretches& energy_of,
                          Eigen::Matrix<double, D, D>& stress, Eigen::Matrix<double, D * D, D * D>* tangent) {
  // Where two stretches are this near to each other their difference quotient is its limit, to 1e-10; further
  // apart rounding costs less than that.
  constexpr double kEqual = 1e-5;
  const Eigen::JacobiSVD<Eigen::Matrix<double, D, D>> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const auto& u = svd.matrixU();
  const auto& v = svd.matrixV();
  const Eigen::Matrix<double, D, 1> l = svd.singularValues();
  const PrincipalEnergy<D> e = energy_of(l);
  const Eigen::Matrix<double, D, 1> w = e.t.cwiseQuotient(l);
  stress = u * w.asDiagonal() * v.transpose();
  if (tangent == nullptr) return e.w;
  const auto dyad = [&](int a, int b) {
    return flat<D>(Eigen::Matrix<double, D, D>(u.col(a) * v.col(b).transpose()));
  };
  const auto second = [&](int a, int b) { return (e.d(a, b) - (a == b ? e.t(a) : 0)) / (l(a) * l(b)); };
  tangent->setZero();
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) {
      *tangent += second(a, b) * dyad(a, a) * dyad(b, b).transpose();
      if (a == b) continue;
      const double gap = (l(a) - l(b)) * (l(a) + l(b));
      double straight = (l(a) * w(a) - l(b) * w(b)) / gap, crossed = (l(b) * w(a) - l(a) * w(b)) / gap;
      if (std::abs(l(a) - l(b)) < kEqual * l(a)) {
        const double across = 0.5 * (second(a, a) + second(b, b)) - second(a, b),
                     mean = 0.5 * (w(a) / l(a) + w(b) / l(b));
        straight = 0.5 * (across + mean);
        crossed = 0.5 * (across - mean);
      }
      *tangent +=
          straight * dyad(a, b) * dyad(a, b).transpose() + crossed * dyad(a, b) * dyad(b, a).transpose();
    }
  return e.w;
}

}  // namespace riven
