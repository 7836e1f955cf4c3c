#include "material/stability.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace riven {

namespace {

template <int D>
Eigen::Matrix<double, D, 1> direction(double polar, double around) {
  if constexpr (D == 2) {
    return {std::cos(polar), std::sin(polar)};
  } else {
    return {std::cos(polar), std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around)};
  }
}

/// Over the directions with positive components, which are enough for symmetry: on a grid, then on finer ones
/// around the best.
template <int D>
double least_eigenvalue(const Eigen::Matrix<double, D * D, D * D>& tangent) {
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  constexpr int kCells = 12, kZooms = 14;
  double least = std::numeric_limits<double>::infinity();
  std::array<double, 2> best{};
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, D, D>> solver;
  const auto look = [&](double polar, double around) {
    // In closed form, with some eight digits: of a hundred thousand tensors at each start of the program.
    solver.computeDirect(acoustic_tensor<D>(tangent, direction<D>(polar, around)), Eigen::EigenvaluesOnly);
    if (!(solver.eigenvalues()(0) < least)) return;
    least = solver.eigenvalues()(0);
    best = {polar, around};
  };
  constexpr int kAround = D == 2 ? 0 : 1;  // in the plane one angle is enough
  for (int i = 0; i <= kCells; ++i)
    for (int j = 0; j <= kAround * kCells; ++j) look(kQuarter * i / kCells, kQuarter * j / kCells);
  double width = kQuarter / kCells;
  for (int zoom = 0; zoom < kZooms; ++zoom) {
    width *= 0.5;
    const std::array<double, 2> middle = best;
    for (int i = -2; i <= 2; ++i)
      for (int j = -2 * kAround; j <= 2 * kAround; ++j) look(middle[0] + width * i, middle[1] + width * j);
  }
  return least;
}

}  // namespace

double least_acoustic_eigenvalue(const Material& material, const Eigen::Matrix3d& f) {
  return material.incompressible()
             ? least_eigenvalue<2>(material.plane_stress(f.topLeftCorner<2, 2>()).tangent)
             : least_eigenvalue<3>(material.solid(f).tangent);
}

std::vector<Instability> instabilities(const Material& material, double low, double high) {
  constexpr double kSame = 1e-6;  // relative: where the law ends, everything does
  const auto exists = [](const HomogeneousState&) { return true; };
  const auto elliptic = [&](const HomogeneousState& state) {
    return least_acoustic_eigenvalue(material, state.gradient) > 0;
  };
  const auto rises = [](const HomogeneousState& state) { return state.slope > 0; };
  std::vector<Instability> found;
  for (const Deformation deformation : {Deformation::uniaxial, Deformation::planar, Deformation::equibiaxial})
    for (const double to : {high, low}) {
      if ((to > 1) != (to == high)) continue;  // the range does not reach to this side
      const auto end = first_failure(material, deformation, to, exists);
      const auto add = [&](Instability::Kind kind, const auto& holds) {
        const auto at = first_failure(material, deformation, end.value_or(to), holds);
        if (at && !(end && std::abs(*at - *end) <= kSame * *end)) found.push_back({deformation, kind, *at});
      };
      add(Instability::Kind::ellipticity, elliptic);
      add(Instability::Kind::stress, rises);
      if (end) found.push_back({deformation, Instability::Kind::end, *end});
    }
  return found;
}

std::string instability_text(const Instability& instability) {
  const bool tension = instability.stretch > 1;
  const std::string where = fmt::format("in {} {} from a stretch of {:.4g} {}", name(instability.deformation),
                                        tension ? "tension" : "compression", instability.stretch,
                                        tension ? "upwards" : "downwards");
  switch (instability.kind) {
    case Instability::Kind::ellipticity:
      return where + " strong ellipticity is lost: deformation may localise in bands";
    case Instability::Kind::stress:
      return fmt::format("{} the nominal stress {} as the stretch {}", where,
                         tension ? "does not rise" : "does not fall", tension ? "rises" : "falls");
    default:
      return where + " the law has no answer";
  }
}

}  // namespace riven
