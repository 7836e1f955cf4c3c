#pragma once

#include <Eigen/Core>

namespace riven {

/// What a law answers to a deformation gradient in D dimensions.
template <int D>
struct ResponseIn {
  using Tensor = Eigen::Matrix<double, D, D>;
  using Tangent = Eigen::Matrix<double, D * D, D * D>;
  double energy = 0;  // strain energy density (J/m^3)
  Tensor stress;      // first Piola-Kirchhoff stress P_iJ (Pa)
  Tangent tangent;    // dP_iJ/dF_kL (Pa), rows and columns numbered D i + J
};
using PlaneResponse = ResponseIn<2>;
using Response = ResponseIn<3>;

/// A tensor's components in the order of the tangent's rows.
template <int D>
Eigen::Matrix<double, D * D, 1> flat(const Eigen::Matrix<double, D, D>& t) {
  Eigen::Matrix<double, D * D, 1> v;
  for (int i = 0; i < D; ++i)
    for (int J = 0; J < D; ++J) v(D * i + J) = t(i, J);
  return v;
}

/// B_iJkL = -G_iL G_kJ, the derivative of G = F^-T.
template <int D>
Eigen::Matrix<double, D * D, D * D> derivative_of_inverse_transpose(const Eigen::Matrix<double, D, D>& g) {
  Eigen::Matrix<double, D * D, D * D> b;
  for (int i = 0; i < D; ++i)
    for (int J = 0; J < D; ++J)
      for (int k = 0; k < D; ++k)
        for (int L = 0; L < D; ++L) b(D * i + J, D * k + L) = -g(i, L) * g(k, J);
  return b;
}

/// The acoustic tensor A_iJkL n_J n_L (Pa), whose eigenvalues are density times squared speeds of plane waves
/// along `n`.
template <int D>
Eigen::Matrix<double, D, D> acoustic_tensor(const Eigen::Matrix<double, D * D, D * D>& a,
                                            const Eigen::Matrix<double, D, 1>& n) {
  Eigen::Matrix<double, D, D> q = Eigen::Matrix<double, D, D>::Zero();
  for (int i = 0; i < D; ++i)
    for (int k = 0; k < D; ++k)
      for (int J = 0; J < D; ++J)
        for (int L = 0; L < D; ++L) q(i, k) += a(D * i + J, D * k + L) * n(J) * n(L);
  return q;
}

}  // namespace riven
