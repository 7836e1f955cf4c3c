#include "material/curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace riven {

namespace {

using Matrix3 = Eigen::Matrix3d;

/// F = fixed + at * loaded + q * free, where the free stretch q of an incompressible material is at^-power.
struct Directions {
  Matrix3 fixed, loaded, free;
  double power = 0;
};

Directions directions(Deformation deformation) {
  const auto unit = [](int i, int j) {
    return Matrix3(Eigen::Vector3d::Unit(i) * Eigen::Vector3d::Unit(j).transpose());
  };
  const Matrix3 none = Matrix3::Zero();
  switch (deformation) {
    case Deformation::uniaxial:
      return {none, unit(0, 0), unit(1, 1) + unit(2, 2), 0.5};
    case Deformation::planar:
      return {unit(1, 1), unit(0, 0), unit(2, 2), 1};
    case Deformation::equibiaxial:
      return {none, unit(0, 0) + unit(1, 1), unit(2, 2), 2};
    default:
      return {Matrix3::Identity(), unit(0, 1), none, 0};
  }
}

/// Stress and slope from the response in D dimensions; `free_slope`: derivative of the free stretch.
template <int D>
HomogeneousState state_of(const ResponseIn<D>& response, const Directions& way, HomogeneousState state,
                          double free_slope) {
  using Part = Eigen::Matrix<double, D, D>;
  const auto loaded = flat<D>(Part(way.loaded.topLeftCorner<D, D>())),
             free = flat<D>(Part(way.free.topLeftCorner<D, D>()));
  state.gradient = way.fixed + state.at * way.loaded + state.free * way.free;
  state.stress = loaded.dot(flat<D>(response.stress)) / loaded.squaredNorm();
  state.slope = loaded.dot(response.tangent * (loaded + free_slope * free)) / loaded.squaredNorm();
  return state;
}

/// Theory note, end of section 2: nothing presses on the sheet, whose volume gives the free stretch.
std::optional<HomogeneousState> incompressible(const Material& material, const Directions& way, double at) {
  const double free = std::pow(at, -way.power);
  const Matrix3 f = way.fixed + at * way.loaded + free * way.free;
  const PlaneResponse response = material.plane_stress(f.topLeftCorner<2, 2>());
  if (!std::isfinite(response.energy)) return std::nullopt;
  return state_of<2>(response, way, {.at = at, .free = free}, way.power == 0 ? 0 : -way.power * free / at);
}

/// Newton's method for the free stretch, on the second Piola-Kirchhoff stress of its directions: the first
/// one vanishes where a body collapses.
std::optional<HomogeneousState> relieved(const Material& material, const Directions& way, double at,
                                         double guess) {
  constexpr int kMost = 50;
  constexpr double kConverged = 1e-14, kAccepted = 1e-10;  // of the longitudinal modulus
  const double modulus = material.small_strain().longitudinal();
  const auto loaded = flat<3>(way.loaded), free = flat<3>(way.free);
  double last = 0;
  for (int n = 0; n < kMost; ++n) {
    const Response response = material.solid(way.fixed + at * way.loaded + guess * way.free);
    if (!std::isfinite(response.energy)) return std::nullopt;
    const double second = free.dot(flat<3>(response.stress)) / guess,
                 stiffness = free.dot(response.tangent * free);
    const bool is_last = std::abs(second) <= kConverged * modulus || guess == last || n + 1 == kMost;
    if (is_last && std::abs(second) > kAccepted * modulus) return std::nullopt;
    if (is_last) {
      const double coupled = free.dot(response.tangent * loaded);
      return state_of<3>(response, way, {.at = at, .free = guess}, coupled == 0 ? 0 : -coupled / stiffness);
    }
    last = guess;
    guess *= std::min(std::max(1 - second / (stiffness - second), 0.5), 2.0);
  }
  return std::nullopt;
}

std::optional<HomogeneousState> compressed(const Material& material, double j) {
  const double l = std::cbrt(j);
  const Matrix3 f = l * Matrix3::Identity();
  const Response response = material.solid(f);
  if (!std::isfinite(response.energy)) return std::nullopt;
  const double p = response.stress(0, 0),
               slope = response.tangent(0, 0) + response.tangent(0, 4) + response.tangent(0, 8);
  return HomogeneousState{j, l, f, -p / (l * l), (2 * p / l - slope) / (3 * j * l)};
}

std::optional<HomogeneousState> next(const Material& material, Deformation deformation, double at,
                                     double guess) {
  if (deformation == Deformation::volumetric) return compressed(material, at);
  const Directions way = directions(deformation);
  return material.incompressible() ? incompressible(material, way, at) : relieved(material, way, at, guess);
}

constexpr double kStep = 0.01;

/// The next place on the way.
double step_towards(double from, double to) {
  return std::abs(to - from) <= kStep ? to : from + std::copysign(kStep, to - from);
}

}  // namespace

std::string_view name(Deformation deformation) {
  constexpr std::array<std::string_view, 5> names = {"uniaxial", "planar", "equibiaxial", "simple_shear",
                                                     "volumetric"};
  return names[static_cast<std::size_t>(deformation)];
}

HomogeneousState rest(const Material& material, Deformation deformation) {
  return next(material, deformation, deformation == Deformation::simple_shear ? 0 : 1, 1).value();
}

std::optional<HomogeneousState> follow(const Material& material, Deformation deformation,
                                       const HomogeneousState& from, double at) {
  std::optional<HomogeneousState> state = from;
  while (state && state->at != at)
    state = next(material, deformation, step_towards(state->at, at), state->free);
  return state;
}

std::optional<double> first_failure(const Material& material, Deformation deformation, double to,
                                    const std::function<bool(const HomogeneousState&)>& holds) {
  constexpr double kDigits = 1e-9;
  HomogeneousState good = rest(material, deformation);
  const auto go_on = [&](double at) {
    const auto state = follow(material, deformation, good, at);
    if (!state || !holds(*state)) return false;
    good = *state;
    return true;
  };
  double bad = good.at;
  do {
    if (good.at == to) return std::nullopt;
    bad = step_towards(good.at, to);
  } while (go_on(bad));
  while (std::abs(bad - good.at) > kDigits * std::abs(bad)) {
    const double middle = 0.5 * (good.at + bad);
    if (!go_on(middle)) bad = middle;
  }
  return bad;
}

Curve curve(const Material& material, Deformation deformation, const std::vector<double>& at) {
  Curve curve{deformation, at, std::vector<double>(at.size(), std::numeric_limits<double>::quiet_NaN()), {}};
  const HomogeneousState start = rest(material, deformation);
  const auto first_above = static_cast<std::size_t>(std::lower_bound(at.begin(), at.end(), start.at) -
                                                    at.begin());  // of the places
  const auto go = [&](std::size_t count, const auto& place) {
    std::optional<HomogeneousState> state = start;
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t i = place(n);
      state = follow(material, deformation, *state, at[i]);
      if (!state) {
        curve.ends.push_back(first_failure(material, deformation, at[i], [](const HomogeneousState&) {
                               return true;
                             }).value_or(at[i]));
        return;
      }
      curve.stress[i] = state->stress;
    }
  };
  go(first_above, [&](std::size_t n) { return first_above - 1 - n; });
  go(at.size() - first_above, [&](std::size_t n) { return first_above + n; });
  return curve;
}

}  // namespace riven
