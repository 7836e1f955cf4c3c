#include "material/viscoelastic.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>

#include "material/volume_energy.hpp"

namespace riven {

namespace {

using Matrix2 = Eigen::Matrix2d;
using Matrix3 = Eigen::Matrix3d;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr int kInPlane[4] = {0, 1, 3, 4};  // components of the plane in a tensor of space
constexpr int kAcross = 8;

Matrix3 symmetric(const double* c) {
  Matrix3 t;
  t << c[0], c[3], c[4], c[3], c[1], c[5], c[4], c[5], c[2];
  return t;
}

void keep(const Matrix3& t, double* c) {
  c[0] = t(0, 0);
  c[1] = t(1, 1);
  c[2] = t(2, 2);
  c[3] = t(0, 1);
  c[4] = t(0, 2);
  c[5] = t(1, 2);
}

double decay(double x) {
  return std::exp(-x);
}

double mean_decay(double x) {
  return x > 0 ? -std::expm1(-x) / x : 1;
}

Matrix3 in_space(const Matrix2& f, double thickness) {
  Matrix3 whole = Matrix3::Identity();
  whole.topLeftCorner<2, 2>() = f;
  whole(2, 2) = thickness;
  return whole;
}

/// Adds X : Cbar / 2 and its derivatives with respect to F.
void add_frozen(const Matrix3& x, const Matrix3& f, Response& to) {
  const double j = f.determinant(), a = std::pow(j, -2.0 / 3);
  const Matrix3 g = f.inverse().transpose(), fx = f * x;
  const double xc = (fx.array() * f.array()).sum();
  to.energy += 0.5 * a * xc;
  to.stress += a * (fx - xc / 3 * g);
  const auto G = flat<3>(g), FX = flat<3>(fx);
  for (Eigen::Index i = 0; i < 3; ++i) to.tangent.block<3, 3>(3 * i, 3 * i) += a * x;
  to.tangent += a * (2.0 / 9 * xc * G * G.transpose() - 2.0 / 3 * (FX * G.transpose() + G * FX.transpose()) -
                     xc / 3 * derivative_of_inverse_transpose<3>(g));
}

/// The same in an incompressible sheet, whose thickness stretch is 1 / det F.
void add_frozen(const Matrix3& x, const Matrix2& f, PlaneResponse& to) {
  const double j2 = std::pow(f.determinant(), 2), across = x(2, 2) / j2;
  const Matrix2 g = f.inverse().transpose(), in_plane = x.topLeftCorner<2, 2>(), fx = f * in_plane;
  to.energy += 0.5 * ((fx.array() * f.array()).sum() + across);
  to.stress += fx - across * g;
  const auto G = flat<2>(g);
  for (Eigen::Index i = 0; i < 2; ++i) to.tangent.block<2, 2>(2 * i, 2 * i) += in_plane;
  to.tangent += across * (2 * G * G.transpose() - derivative_of_inverse_transpose<2>(g));
}

}  // namespace

bool has_isochoric_part(const Material& material) {
  return std::visit([](const auto& law) { return !OfGradient<std::decay_t<decltype(law)>>; }, material.law);
}

Viscoelastic::Viscoelastic(Material material) : material_(std::move(material)), isochoric_(material_) {
  isochoric_.volumetric = Volumetric{};
}

void Viscoelastic::forget(double* memory) const {
  std::fill_n(memory, this->memory(), 0.0);
  keep(Matrix3::Identity(), memory + kTensor);
}

Viscoelastic::Step Viscoelastic::step(const double* memory, double dt) const {
  Step step;
  const Matrix3 d = symmetric(memory);
  const double* h = memory + kOwn;
  for (const Relaxation& branch : material_.relaxation) {
    const double x = dt / branch.time, beta = mean_decay(x);
    step.scale -= branch.share * (1 - beta);
    step.frozen += branch.share * (decay(x) * symmetric(h) - beta * d);
    h += kTensor;
  }
  return step;
}

Response Viscoelastic::solid(const Matrix3& f, const Step& step) const {
  Response r = isochoric_.solid(f);
  if (!std::isfinite(r.energy)) return r;
  r.energy *= step.scale;
  r.stress *= step.scale;
  r.tangent *= step.scale;
  const double j = f.determinant();
  double first = 0, second = 0;
  r.energy += volume_energy(*material_.volumetric, j, first, second);
  const Matrix3 g = f.inverse().transpose();
  r.stress += first * j * g;
  const auto G = flat<3>(g);
  r.tangent +=
      (second * j * j + first * j) * G * G.transpose() + first * j * derivative_of_inverse_transpose<3>(g);
  add_frozen(step.frozen, f, r);
  return r;
}

PlaneResponse Viscoelastic::plane_strain(const Matrix2& f, const Step& step) const {
  const Response whole = solid(in_space(f, 1), step);
  PlaneResponse r;
  r.energy = whole.energy;
  r.stress = whole.stress.topLeftCorner<2, 2>();
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) r.tangent(a, b) = whole.tangent(kInPlane[a], kInPlane[b]);
  return r;
}

PlaneResponse Viscoelastic::plane_stress(const Matrix2& f, const Step& step) const {
  if (material_.incompressible()) {
    PlaneResponse r = material_.plane_stress(f);
    if (!std::isfinite(r.energy)) return r;
    r.energy *= step.scale;
    r.stress *= step.scale;
    r.tangent *= step.scale;
    add_frozen(step.frozen, f, r);
    return r;
  }
  const Response whole = solid(in_space(f, thickness_stretch(f, step)), step);
  PlaneResponse r;
  r.energy = whole.energy;
  r.stress = whole.stress.topLeftCorner<2, 2>();
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b)
      r.tangent(a, b) = whole.tangent(kInPlane[a], kInPlane[b]) - whole.tangent(kInPlane[a], kAcross) *
                                                                      whole.tangent(kAcross, kInPlane[b]) /
                                                                      whole.tangent(kAcross, kAcross);
  return r;
}

/// Newton's method on the first Piola-Kirchhoff stress across, nearly linear in the thickness where the law
/// is nearly incompressible.
double Viscoelastic::thickness_stretch(const Matrix2& f, const Step& step) const {
  constexpr int kMost = 50;
  constexpr double kConverged = 1e-8;  // the next step would be its square
  const double area = f.determinant();
  if (material_.incompressible()) return 1 / area;
  if (!(area > 0)) return kNotANumber;
  const double nu = material_.small_strain().poissons_ratio();
  double thickness = std::pow(area, -nu / (1 - nu));
  for (int n = 0; n < kMost; ++n) {
    const Response r = solid(in_space(f, thickness), step);
    const double part = r.stress(2, 2) / (r.tangent(kAcross, kAcross) * thickness);
    thickness *= std::min(std::max(1 - part, 0.5), 2.0);
    if (std::abs(part) < kConverged) return thickness;
  }
  return kNotANumber;
}

double Viscoelastic::isochoric(const Matrix3& f, Matrix3& stress) const {
  std::array<const double*, 9> from{};
  std::array<double*, 9> to{};
  for (int c = 0; c < 9; ++c) {
    from[static_cast<std::size_t>(c)] = &f(c / 3, c % 3);
    to[static_cast<std::size_t>(c)] = &stress(c / 3, c % 3);
  }
  double energy = 0;
  isochoric_.stress(Kinematics::solid, 1, from.data(), to.data(), &energy);
  return energy;
}

Matrix3 Viscoelastic::stress(const Matrix3& f, const Step& step) const {
  Matrix3 p;
  isochoric(f, p);
  const double j = f.determinant(), a = std::pow(j, -2.0 / 3);
  double first = 0, second = 0;
  volume_energy(*material_.volumetric, j, first, second);
  const Matrix3 g = f.inverse().transpose(), fx = f * step.frozen;
  return step.scale * p + first * j * g + a * (fx - (fx.array() * f.array()).sum() / 3 * g);
}

double Viscoelastic::remember(const double* before, double dt, const Matrix3& f, double* after) const {
  Matrix3 p;
  const double energy = isochoric(f, p);
  const double j = f.determinant(), a = std::pow(j, -2.0 / 3);
  const Matrix3 d = f.inverse() * p / a, c = a * f.transpose() * f;
  const Matrix3 d_before = symmetric(before), change = c - symmetric(before + kTensor);
  double spared = before[2 * kTensor];
  keep(d, after);
  keep(c, after + kTensor);
  for (std::size_t n = 0; n < material_.relaxation.size(); ++n) {
    const Relaxation& branch = material_.relaxation[n];
    const double x = dt / branch.time;
    const std::size_t at = kOwn + n * kTensor;
    const Matrix3 h_before = symmetric(before + at), h = decay(x) * h_before + mean_decay(x) * (d - d_before);
    keep(h, after + at);
    const Matrix3 missing = (d_before - h_before) + (d - h);  // twice what the branch has relaxed
    spared += 0.25 * branch.share * (missing.array() * change.array()).sum();
  }
  after[2 * kTensor] = spared;
  double first = 0, second = 0;
  const double volume = material_.volumetric ? volume_energy(*material_.volumetric, j, first, second) : 0;
  return energy + volume - spared;
}

}  // namespace riven
