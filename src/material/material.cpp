#include "material/material.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "material/principal.hpp"
#include "material/sheet_tangent.hpp"
#include "material/volume_energy.hpp"

namespace riven {

namespace {

using Matrix2 = Eigen::Matrix2d;
using Matrix3 = Eigen::Matrix3d;
using Tangent2 = PlaneResponse::Tangent;
using Tangent3 = Response::Tangent;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

// ---- three dimensions ----

/// W(J^(-2/3) I1, J^(-4/3) I2): the derivatives of eq. (3) to (6) with respect to F.
template <OfInvariants L>
double isochoric(const L& law, const Matrix3& f, double j, const Matrix3& g, Matrix3& stress,
                 Tangent3* tangent) {
  const Matrix3 c = f.transpose() * f, fc = f * c;
  const double i1 = c.trace(), i2 = 0.5 * (i1 * i1 - c.squaredNorm());
  const double a = std::pow(j, -2.0 / 3), b = a * a;
  const InvariantEnergy e = law(a * i1, b * i2);
  const Matrix3 d1 = 2 * a * (f - i1 / 3 * g), d2 = 2 * b * (i1 * f - fc - 2.0 / 3 * i2 * g);
  stress = e.w1 * d1 + e.w2 * d2;
  if (tangent == nullptr) return e.w;

  const auto F = flat<3>(f), G = flat<3>(g), D1 = flat<3>(d1), D2 = flat<3>(d2);
  const auto I2 = flat<3>(Matrix3(2 * (i1 * f - fc)));  // dI2/dF
  const Tangent3 B = derivative_of_inverse_transpose<3>(g), unit = Tangent3::Identity(),
                 GG = G * G.transpose();
  const Matrix3 left = f * f.transpose();
  Tangent3 dfc;  // derivative of F C
  for (int i = 0; i < 3; ++i)
    for (int J = 0; J < 3; ++J)
      for (int k = 0; k < 3; ++k)
        for (int K = 0; K < 3; ++K)
          dfc(3 * i + J, 3 * k + K) = (i == k ? c(K, J) : 0) + f(i, K) * f(k, J) + (J == K ? left(i, k) : 0);
  const auto both = [](const auto& x, const auto& y) {
    return Tangent3(x * y.transpose() + y * x.transpose());
  };
  const Tangent3 dd1 = a * (2 * unit - 4.0 / 3 * both(G, F) + i1 * (4.0 / 9 * GG - 2.0 / 3 * B));
  const Tangent3 dd2 = b * (2 * (2 * F * F.transpose() + i1 * unit - dfc) - 4.0 / 3 * both(G, I2) +
                            i2 * (16.0 / 9 * GG - 4.0 / 3 * B));
  *tangent = e.w1 * dd1 + e.w2 * dd2 + e.w11 * D1 * D1.transpose() + e.w12 * both(D1, D2) +
             e.w22 * D2 * D2.transpose();
  return e.w;
}

/// The energy of `scale` = J^(-1/3) times the principal stretches, eq. (7).
template <OfStretches L>
PrincipalEnergy<3> isochoric_energy(const L& law, double scale, const Eigen::Vector3d& l) {
  PrincipalEnergy<3> e;
  Eigen::Vector3d t, d;
  for (int a = 0; a < 3; ++a) {
    const StretchEnergy one = law(scale * l(a));
    e.w += one.f;
    t(a) = one.t;
    d(a) = one.d;
  }
  e.t = t.array() - t.mean();
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) e.d(a, b) = (a == b ? d(a) : 0) - (d(a) + d(b)) / 3 + d.sum() / 9;
  return e;
}

template <OfStretches L>
double isochoric(const L& law, const Matrix3& f, double j, const Matrix3& /*g*/, Matrix3& stress,
                 Tangent3* tangent) {
  const double scale = 1 / std::cbrt(j);
  return principal_response<3>(
      f, [&](const Eigen::Vector3d& l) { return isochoric_energy(law, scale, l); }, stress, tangent);
}

template <class L>
double evaluate(const L& law, const std::optional<Volumetric>& volumetric, const Matrix3& f, Matrix3& stress,
                Tangent3* tangent) {
  const double j = f.determinant();
  if constexpr (OfGradient<L>) {
    if (L::objective && !(j > 0)) return kNotANumber;
    return law(f, stress, tangent);
  } else {
    if (!volumetric || !(j > 0)) return kNotANumber;
    const Matrix3 g = f.inverse().transpose();
    const double w = isochoric(law, f, j, g, stress, tangent);
    double first = 0, second = 0;
    const double u = volume_energy(*volumetric, j, first, second);
    stress += first * j * g;
    if (tangent != nullptr) {
      const auto G = flat<3>(g);
      *tangent += (second * j * j + first * j) * G * G.transpose() +
                  first * j * derivative_of_inverse_transpose<3>(g);
    }
    return w + u;
  }
}

// ---- in the plane ----

Matrix3 in_space(const Matrix2& f, double thickness) {
  Matrix3 whole = Matrix3::Identity();
  whole.topLeftCorner<2, 2>() = f;
  whole(2, 2) = thickness;
  return whole;
}

constexpr int kInPlane[4] = {0, 1, 3, 4};  // components of the plane in a tensor of space
constexpr int kAcross = 8;

template <class L>
double plane_strain_response(const L& law, const std::optional<Volumetric>& volumetric, const Matrix2& f,
                             Matrix2& stress, Tangent2* tangent) {
  Matrix3 whole;
  Tangent3 whole_tangent;
  const double w =
      evaluate(law, volumetric, in_space(f, 1), whole, tangent != nullptr ? &whole_tangent : nullptr);
  stress = whole.topLeftCorner<2, 2>();
  for (int r = 0; tangent != nullptr && r < 4; ++r)
    for (int c = 0; c < 4; ++c) (*tangent)(r, c) = whole_tangent(kInPlane[r], kInPlane[c]);
  return w;
}

/// A compressible sheet at some thickness, given by the cube root of its J: then no root is to be taken.
struct Sheet {
  Matrix2 f;
  double c = 1;                                        // J^(1/3)
  double t = f.squaredNorm(), area = f.determinant();  // F:F and det F in the plane
  [[nodiscard]] double j() const { return c * c * c; }
  [[nodiscard]] double thickness() const { return j() / area; }
};

/// h dW/dh of the thickness stretch h, and its derivative with respect to ln h.
struct Across {
  double force = 0, slope = 0;
};

/// What W(I1, I2) says of a sheet, with I1 = F:F + h^2 and I2 = det F^2 + F:F h^2 of the F in the plane.
template <OfInvariants L>
struct SheetEnergy {
  double z, i1, i2, a, b;
  double first = 0, second = 0, u;  // U'(J), U''(J), U
  InvariantEnergy e;

  SheetEnergy(const L& law, const Volumetric& volumetric, const Sheet& sheet)
      : z(sheet.thickness() * sheet.thickness()),
        i1(sheet.t + z),
        i2(sheet.area * sheet.area + sheet.t * z),
        a(1 / (sheet.c * sheet.c)),
        b(a * a),
        u(volume_energy(volumetric, sheet.j(), first, second)),
        e(law(a * i1, b * i2)) {}
};

template <OfInvariants L>
Across across(const L& law, const std::optional<Volumetric>& volumetric, const Sheet& sheet) {
  const SheetEnergy<L> w(law, *volumetric, sheet);
  const double j = sheet.j(), tz = sheet.t * w.z;
  const double d1 = w.a * (2 * w.z - 2.0 / 3 * w.i1), d2 = w.b * (2 * tz - 4.0 / 3 * w.i2),
               dd1 = w.a * (4.0 / 3 * w.z + 4.0 / 9 * w.i1), dd2 = w.b * (16.0 / 9 * w.i2 - 4.0 / 3 * tz);
  return {w.e.w1 * d1 + w.e.w2 * d2 + w.first * j, w.e.w1 * dd1 + w.e.w2 * dd2 + w.e.w11 * d1 * d1 +
                                                       2 * w.e.w12 * d1 * d2 + w.e.w22 * d2 * d2 +
                                                       (w.second * j + w.first) * j};
}

/// Energy and stress in the plane, the derivatives of the same.
template <OfInvariants L>
double in_plane(const L& law, const std::optional<Volumetric>& volumetric, const Sheet& sheet,
                Matrix2& stress) {
  const SheetEnergy<L> w(law, *volumetric, sheet);
  const double along_g = w.first * sheet.j() - 2.0 / 3 * w.e.w1 * w.a * w.i1 +
                         w.e.w2 * w.b * (2 * sheet.area * sheet.area - 4.0 / 3 * w.i2);
  stress = 2 * (w.e.w1 * w.a + w.e.w2 * w.b * w.z) * sheet.f + along_g * sheet.f.inverse().transpose();
  return w.e.w + w.u;
}

/// Principal stretches of F in the plane: their sum and difference follow from F:F and det F.
template <OfStretches L>
Across across(const L& law, const std::optional<Volumetric>& volumetric, const Sheet& sheet) {
  const double larger =
      0.5 * (std::sqrt(sheet.t + 2 * sheet.area) + std::sqrt(std::max(sheet.t - 2 * sheet.area, 0.0)));
  const PrincipalEnergy<3> e =
      isochoric_energy(law, 1 / sheet.c, {larger, sheet.area / larger, sheet.thickness()});
  const double j = sheet.j();
  double first = 0, second = 0;
  volume_energy(*volumetric, j, first, second);
  return {e.t(2) + first * j, e.d(2, 2) + (second * j + first) * j};
}

template <OfStretches L>
double in_plane(const L& law, const std::optional<Volumetric>& volumetric, const Sheet& sheet,
                Matrix2& stress) {
  const double j = sheet.j();
  double first = 0, second = 0;
  const double u = volume_energy(*volumetric, j, first, second);
  const auto energy = [&](const Eigen::Vector2d& l) {
    const PrincipalEnergy<3> e = isochoric_energy(law, 1 / sheet.c, {l(0), l(1), sheet.thickness()});
    return PrincipalEnergy<2>{e.w + u, e.t.head<2>().array() + first * j,
                              e.d.topLeftCorner<2, 2>().array() + (second * j + first) * j};
  };
  return principal_response<2>(sheet.f, energy, stress, nullptr);
}

template <OfGradient L>
double in_plane(const L& law, const std::optional<Volumetric>& volumetric, const Sheet& sheet,
                Matrix2& stress) {
  Matrix3 whole;
  const double w = evaluate(law, volumetric, in_space(sheet.f, sheet.thickness()), whole, nullptr);
  stress = whole.topLeftCorner<2, 2>();
  return w;
}

/// Finds the thickness without stress across the plane, if there is one. The first guess is exact for small
/// strain. Of nearly incompressible laws by Newton's method on the first Piola-Kirchhoff stress, which is
/// nearly linear in J.
template <class L>
bool relieve(const L& law, const std::optional<Volumetric>& volumetric, const SmallStrain& moduli,
             Sheet& sheet) {
  constexpr int kMost = 50;
  constexpr double kConverged = 1e-8;  // of J^(1/3): the next step would be its square
  const double nu = moduli.poissons_ratio();
  if (!(sheet.area > 0)) return false;
  sheet.c = std::pow(sheet.area, (1 - 2 * nu) / (3 - 3 * nu));
  for (int n = 0; n < kMost; ++n) {
    const Across found = across(law, volumetric, sheet);
    const double step = found.force / (found.slope - found.force) / 3;
    sheet.c *= std::min(std::max(1 - step, 0.8), 1.25);
    if (std::abs(step) < kConverged) return true;
  }
  return false;
}

/// Of others by the secant method, which spares their tangents, on the second Piola-Kirchhoff stress, which
/// does not vanish because a sheet collapses.
template <OfGradient L>
bool relieve(const L& law, const std::optional<Volumetric>& volumetric, const SmallStrain& moduli,
             Sheet& sheet) {
  constexpr int kMost = 50;
  constexpr double kConverged = 1e-14, kAccepted = 1e-10;  // of the longitudinal modulus
  const double nu = moduli.poissons_ratio(), modulus = moduli.longitudinal();
  if (!(sheet.area > 0)) return false;
  const auto second = [&](double thickness) {
    Matrix3 stress;
    evaluate(law, volumetric, in_space(sheet.f, thickness), stress, nullptr);
    return stress(2, 2) / (thickness * modulus);
  };
  double last = std::pow(sheet.area, -nu / (1 - nu)), last_stress = second(last),
         next = last * (1 - last_stress);
  for (int n = 0; n < kMost && std::abs(last_stress) > kConverged && next != last; ++n) {
    next = std::min(std::max(next, 0.5 * last), 2 * last);
    const double stress = second(next), slope = (stress - last_stress) / (next - last);
    last = next;
    last_stress = stress;
    next = last - stress / slope;
    if (!std::isfinite(next)) break;
  }
  sheet.c = std::cbrt(sheet.area * last);
  return std::abs(last_stress) < kAccepted;
}

/// Compressible sheet at that thickness; the tangent of a law that is none of the invariants is that of
/// space, condensed.
template <class L>
double free_sheet(const L& law, const std::optional<Volumetric>& volumetric, const SmallStrain& moduli,
                  const Matrix2& f, Matrix2& stress, Tangent2* tangent) {
  Sheet sheet{f};
  if (!relieve(law, volumetric, moduli, sheet)) return kNotANumber;
  if constexpr (OfInvariants<L>) {
    if (tangent != nullptr) *tangent = sheet_tangent(law, *volumetric, f, sheet.thickness());
  } else if (tangent != nullptr) {
    Matrix3 whole;
    Tangent3 a;
    evaluate(law, volumetric, in_space(f, sheet.thickness()), whole, &a);
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c)
        (*tangent)(r, c) = a(kInPlane[r], kInPlane[c]) -
                           a(kInPlane[r], kAcross) * a(kAcross, kInPlane[c]) / a(kAcross, kAcross);
  }
  return in_plane(law, volumetric, sheet, stress);
}

/// Incompressible sheet in closed form, eq. (9) to (11).
template <OfInvariants L>
double incompressible_sheet(const L& law, const Matrix2& f, Matrix2& stress, Tangent2* tangent) {
  const double j2 = f.determinant() * f.determinant(), t = f.squaredNorm();
  const InvariantEnergy w = law(t + 1 / j2, j2 + t / j2);
  const Matrix2 g = f.inverse().transpose();
  const Matrix2 d1 = 2 * (f - g / j2), d2 = 2 * (j2 * g + f / j2 - t / j2 * g);
  stress = w.w1 * d1 + w.w2 * d2;
  if (tangent == nullptr) return w.w;
  const auto F = flat<2>(f), G = flat<2>(g), D1 = flat<2>(d1), D2 = flat<2>(d2);
  const Tangent2 unit = Tangent2::Identity(), B = derivative_of_inverse_transpose<2>(g);
  const Tangent2 GG = G * G.transpose(), FG = F * G.transpose();
  const Tangent2 dd1 = 2 * (unit + 2 / j2 * GG - 1 / j2 * B);
  const Tangent2 dd2 =
      2 * (2 * j2 * GG + j2 * B + unit / j2 - 2 / j2 * (FG + FG.transpose()) + 2 * t / j2 * GG - t / j2 * B);
  *tangent = w.w1 * dd1 + w.w2 * dd2 + w.w11 * D1 * D1.transpose() +
             w.w12 * (D1 * D2.transpose() + D2 * D1.transpose()) + w.w22 * D2 * D2.transpose();
  return w.w;
}

/// The same with the third stretch 1 / (l1 l2).
template <OfStretches L>
double incompressible_sheet(const L& law, const Matrix2& f, Matrix2& stress, Tangent2* tangent) {
  const auto energy = [&](const Eigen::Vector2d& l) {
    const StretchEnergy one = law(l(0)), two = law(l(1)), across = law(1 / (l(0) * l(1)));
    PrincipalEnergy<2> e;
    e.w = one.f + two.f + across.f;
    e.t << one.t - across.t, two.t - across.t;
    e.d << one.d + across.d, across.d, across.d, two.d + across.d;
    return e;
  };
  return principal_response<2>(f, energy, stress, tangent);
}

template <class L>
double plane_stress_response(const L& law, const std::optional<Volumetric>& volumetric,
                             const SmallStrain& moduli, const Matrix2& f, Matrix2& stress,
                             Tangent2* tangent) {
  if constexpr (!OfGradient<L>) {
    if (!volumetric) return incompressible_sheet(law, f, stress, tangent);
  }
  return free_sheet(law, volumetric, moduli, f, stress, tangent);
}

/// Where energies are no finite numbers the rest is none either.
template <int D>
ResponseIn<D> checked(ResponseIn<D> response) {
  if (!std::isfinite(response.energy)) {
    response.stress.setConstant(kNotANumber);
    response.tangent.setConstant(kNotANumber);
  }
  return response;
}

/// Calls answer(F, P) for n gradients.
template <int D, class Answer>
std::size_t for_each_gradient(std::size_t n, const double* const* f, double* const* p, double* energy,
                              const Answer& answer) {
  std::size_t unanswered = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Eigen::Matrix<double, D, D> gradient, stress;
    for (int c = 0; c < D * D; ++c) gradient(c / D, c % D) = f[c][i];
    energy[i] = answer(gradient, stress);
    if (!std::isfinite(energy[i])) {
      ++unanswered;
      energy[i] = kNotANumber;
      stress.setConstant(kNotANumber);
    }
    for (int c = 0; c < D * D; ++c) p[c][i] = stress(c / D, c % D);
  }
  return unanswered;
}

/// Roots of the eigenvalues of an acoustic tensor over the density, with their signs.
template <int D>
Eigen::Matrix<double, D, 1> speeds(const Eigen::Matrix<double, D * D, D * D>& a, double density,
                                   const Eigen::Matrix<double, D, 1>& n) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, D, D>> solver(acoustic_tensor<D>(a, n),
                                                                          Eigen::EigenvaluesOnly);
  return solver.eigenvalues().unaryExpr(
      [&](double value) { return std::copysign(std::sqrt(std::abs(value) / density), value); });
}

}  // namespace

double SmallStrain::youngs_modulus() const {
  return std::isinf(bulk) ? 3 * shear : 9 * bulk * shear / (3 * bulk + shear);
}

double SmallStrain::poissons_ratio() const {
  return std::isinf(bulk) ? 0.5 : (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear);
}

bool Material::incompressible() const {
  return std::visit([&](const auto& l) { return !OfGradient<std::decay_t<decltype(l)>> && !volumetric; },
                    law);
}

bool Material::objective() const {
  return !std::holds_alternative<LinearElastic>(law);
}

SmallStrain Material::small_strain() const {
  const double bulk = volumetric ? volumetric->bulk_modulus : std::numeric_limits<double>::infinity();
  return std::visit(
      [&](const auto& l) -> SmallStrain {
        using L = std::decay_t<decltype(l)>;
        if constexpr (OfInvariants<L>) {
          const InvariantEnergy rest = l(3.0, 3.0);
          return {2 * (rest.w1 + rest.w2), bulk};
        } else if constexpr (OfStretches<L>) {
          return {0.5 * l(1.0).d, bulk};
        } else {
          return {l.shear(), l.lame() + 2.0 / 3 * l.shear()};
        }
      },
      law);
}

Response Material::solid(const Matrix3& f) const {
  Response r;
  r.energy = std::visit([&](const auto& l) { return evaluate(l, volumetric, f, r.stress, &r.tangent); }, law);
  return checked(r);
}

PlaneResponse Material::plane_strain(const Matrix2& f) const {
  PlaneResponse r;
  r.energy = std::visit(
      [&](const auto& l) { return plane_strain_response(l, volumetric, f, r.stress, &r.tangent); }, law);
  return checked(r);
}

PlaneResponse Material::plane_stress(const Matrix2& f) const {
  PlaneResponse r;
  const SmallStrain moduli = small_strain();
  r.energy = std::visit(
      [&](const auto& l) { return plane_stress_response(l, volumetric, moduli, f, r.stress, &r.tangent); },
      law);
  return checked(r);
}

double Material::thickness_stretch(const Matrix2& f) const {
  if (incompressible()) return 1 / f.determinant();
  const SmallStrain moduli = small_strain();
  Sheet sheet{f};
  const bool found = std::visit([&](const auto& l) { return relieve(l, volumetric, moduli, sheet); }, law);
  return found ? sheet.thickness() : kNotANumber;
}

std::size_t Material::stress(Kinematics kinematics, std::size_t n, const double* const* f, double* const* p,
                             double* energy) const {
  const SmallStrain moduli = small_strain();
  return std::visit(
      [&](const auto& l) {
        switch (kinematics) {
          case Kinematics::solid:
            return for_each_gradient<3>(n, f, p, energy, [&](const Matrix3& gradient, Matrix3& stress) {
              return evaluate(l, volumetric, gradient, stress, nullptr);
            });
          case Kinematics::plane_strain:
            return for_each_gradient<2>(n, f, p, energy, [&](const Matrix2& gradient, Matrix2& stress) {
              return plane_strain_response(l, volumetric, gradient, stress, nullptr);
            });
          default:
            return for_each_gradient<2>(n, f, p, energy, [&](const Matrix2& gradient, Matrix2& stress) {
              return plane_stress_response(l, volumetric, moduli, gradient, stress, nullptr);
            });
        }
      },
      law);
}

Eigen::Vector3d wave_speeds(const Material& material, const Matrix3& f, const Eigen::Vector3d& n) {
  return speeds<3>(material.solid(f).tangent, material.density, n);
}

Eigen::Vector2d wave_speeds(const PlaneResponse& response, double density, const Eigen::Vector2d& n) {
  return speeds<2>(response.tangent, density, n);
}

}  // namespace riven
