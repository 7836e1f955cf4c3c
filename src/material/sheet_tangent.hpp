#pragma once

#include <Eigen/LU>
#include <cmath>

#include "material/law.hpp"
#include "material/response.hpp"
#include "material/volume_energy.hpp"

namespace riven {

/// dP/dF in the plane (Pa) of a sheet of a law W(I1, I2) with an energy of its volume, at the thickness
/// stretch `h` that leaves no stress across. The energy is a function E of t = F:F, A = det F and h alone, so
/// that P = 2 E_t F + E_A A F^-T; what h gives way by is condensed.
template <OfInvariants L>
PlaneResponse::Tangent sheet_tangent(const L& law, const Volumetric& volumetric, const Eigen::Matrix2d& f,
                                     double h) {
  const double t = f.squaredNorm(), area = f.determinant(), j = area * h, z = h * h;
  const double a = std::pow(j, -2.0 / 3), b = a * a;
  double first = 0, second = 0;
  volume_energy(volumetric, j, first, second);
  const double one = a * (t + z), two = b * (area * area + t * z);  // the invariants without change of volume
  const InvariantEnergy w = law(one, two);
  // Derivatives with respect to t, A, h.
  const Eigen::Vector3d d1(a, -2.0 / 3 * one / area, a * (-2.0 / 3 * t / h + 4.0 / 3 * h)),
      d2(b * z, b * (2.0 / 3 * area - 4.0 / 3 * t * z / area),
         b * (-4.0 / 3 * area * area / h + 2.0 / 3 * t * h)),
      dj(0, h, area);
  Eigen::Matrix3d dd1, dd2, ddj;
  dd1 << 0, -2.0 / 3 * a / area, -2.0 / 3 * a / h,                 //
      0, 10.0 / 9 * one / (area * area), -2.0 / 3 * d1(2) / area,  //
      0, 0, a * (10.0 / 9 * t / z + 4.0 / 9);
  dd2 << 0, -4.0 / 3 * b * z / area, 2.0 / 3 * b * h,                                                  //
      0, b * (-2.0 / 9 + 28.0 / 9 * t * z / (area * area)), -8.0 / 9 * b * (area / h + t * h / area),  //
      0, 0, b * (28.0 / 9 * area * area / z - 2.0 / 9 * t);
  ddj << 0, 0, 0, 0, 0, 1, 0, 0, 0;
  const Eigen::Vector3d e = w.w1 * d1 + w.w2 * d2 + first * dj;
  const auto ee = [&](int x, int y) {  // x <= y
    return w.w1 * dd1(x, y) + w.w2 * dd2(x, y) + w.w11 * d1(x) * d1(y) +
           w.w12 * (d1(x) * d2(y) + d2(x) * d1(y)) + w.w22 * d2(x) * d2(y) + first * ddj(x, y) +
           second * dj(x) * dj(y);
  };
  const Eigen::Matrix2d g = f.inverse().transpose();
  const auto F = flat<2>(f), G = flat<2>(g);
  const Eigen::Vector4d across = 2 * ee(0, 2) * F + ee(1, 2) * area * G;  // dP/dh
  PlaneResponse::Tangent k =
      e(1) * area * (G * G.transpose() + derivative_of_inverse_transpose<2>(g)) +
      4 * ee(0, 0) * F * F.transpose() + 2 * ee(0, 1) * area * (F * G.transpose() + G * F.transpose()) +
      ee(1, 1) * area * area * G * G.transpose() - across * across.transpose() / ee(2, 2);
  k.diagonal().array() += 2 * e(0);
  return k;
}

}  // namespace riven
