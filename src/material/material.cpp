#include "material/material.hpp"

#include <Eigen/LU>

namespace riven {

namespace {

using Vector4 = Eigen::Vector4d;
using Matrix4 = Eigen::Matrix4d;

Vector4 flat(const Eigen::Matrix2d& m) {
  return {m(0, 0), m(0, 1), m(1, 0), m(1, 1)};
}

/// B_iJkL = -G_iL G_kJ, the derivative of G = F^-T.
Matrix4 derivative_of_inverse_transpose(const Eigen::Matrix2d& g) {
  Matrix4 b;
  for (int i = 0; i < 2; ++i)
    for (int J = 0; J < 2; ++J)
      for (int k = 0; k < 2; ++k)
        for (int L = 0; L < 2; ++L) b(2 * i + J, 2 * k + L) = -g(i, L) * g(k, J);
  return b;
}

}  // namespace

PlaneResponse Material::plane_stress(const Eigen::Matrix2d& f) const {
  const double j2 = f.determinant() * f.determinant();
  const double t = f.squaredNorm();
  const double i1 = t + 1 / j2;
  const double i2 = j2 + t / j2;
  const InvariantEnergy w = std::visit([&](const auto& energy) { return energy(i1, i2); }, law);

  const Eigen::Matrix2d inverse_transpose = f.inverse().transpose();
  const Vector4 F = flat(f);
  const Vector4 G = flat(inverse_transpose);
  const Vector4 d1 = 2 * (F - G / j2);
  const Vector4 d2 = 2 * (j2 * G + F / j2 - t / j2 * G);
  const Vector4 p = w.w1 * d1 + w.w2 * d2;

  const Matrix4 unit = Matrix4::Identity();
  const Matrix4 B = derivative_of_inverse_transpose(inverse_transpose);
  const Matrix4 GG = G * G.transpose();
  const Matrix4 FG = F * G.transpose();
  const Matrix4 dd1 = 2 * (unit + 2 / j2 * GG - 1 / j2 * B);
  const Matrix4 dd2 =
      2 * (2 * j2 * GG + j2 * B + unit / j2 - 2 / j2 * (FG + FG.transpose()) + 2 * t / j2 * GG - t / j2 * B);

  PlaneResponse response;
  response.energy = w.w;
  response.stress << p(0), p(1), p(2), p(3);
  response.tangent = w.w1 * dd1 + w.w2 * dd2 + w.w11 * d1 * d1.transpose() +
                     w.w12 * (d1 * d2.transpose() + d2 * d1.transpose()) + w.w22 * d2 * d2.transpose();
  return response;
}

}  // namespace riven
