#include "simulation/materials.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>

#include "input/material_format.hpp"
#include "material/stability.hpp"

namespace riven {

namespace {

/// Speeds across and along, at rest.
std::string waves_text(const Material& material) {
  if (material.incompressible()) {
    const Eigen::Vector2d speeds = wave_speeds(material.plane_stress(Eigen::Matrix2d::Identity()),
                                               material.density, Eigen::Vector2d::UnitX());
    return fmt::format("waves in a sheet {:.5g} m/s along, {:.5g} m/s across", speeds(1), speeds(0));
  }
  const Eigen::Vector3d speeds = wave_speeds(material, Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitX());
  return fmt::format("waves {:.5g} m/s along, {:.5g} m/s across", speeds(2), speeds(0));
}

/// The stretches that are looked at, and why these.
struct Stretches {
  double low = 0.5, high = 2;
  std::string why = "0.5 to 2, since a motion names none";
};

Stretches asked_for(const Case& input) {
  if (input.solver.in_time()) return {};
  if (input.solver.control == "arc-length") return {.why = "0.5 to 2, since that of a path is no stretch"};
  const auto [low, high] = std::minmax_element(input.solver.stretch.begin(), input.solver.stretch.end());
  Stretches stretches{std::min(*low, 1.0), std::max(*high, 1.0), {}};
  stretches.why = fmt::format("{:g} to {:g} by solver.stretch", stretches.low, stretches.high);
  return stretches;
}

}  // namespace

bool is_complete(const MaterialInput& in) {
  return in.law != LinearElastic::name || in.number("poissons_ratio").has_value();
}

std::string moduli_text(const Material& material) {
  const SmallStrain moduli = material.small_strain();
  const std::string volume = material.incompressible() ? std::string("incompressible")
                                                       : fmt::format("bulk modulus {:.6g} Pa", moduli.bulk);
  const std::string waves = material.density > 0 ? "; " + waves_text(material) : std::string();
  return fmt::format("Young's modulus {:.6g} Pa, Poisson's ratio {:.6g}, shear modulus {:.6g} Pa, {}{}",
                     moduli.youngs_modulus(), moduli.poissons_ratio(), moduli.shear, volume, waves);
}

std::vector<std::string> stability_warnings(const Case& input) {
  std::vector<std::string> lines;
  const Stretches stretches = asked_for(input);
  for (const MaterialInput& in : input.materials) {
    if (!is_complete(in)) continue;
    for (const Instability& instability : instabilities(make_material(in), stretches.low, stretches.high))
      lines.push_back(fmt::format("material {}: {} (looked at: {})", in.name, instability_text(instability),
                                  stretches.why));
  }
  return lines;
}

std::optional<std::string> rotation_warning(const Case& input, const ModelField& gradient) {
  constexpr double kNoticeable = 0.01;
  if (input.materials.front().law != LinearElastic::name) return std::nullopt;
  double largest = 0;
  for (std::size_t at = 0; at < gradient.values.size(); at += 9) {
    const Eigen::Map<const Eigen::Matrix3d> f(gradient.values.data() + at);  // the transpose turns as far
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double trace = (svd.matrixU() * svd.matrixV().transpose()).trace();
    largest = std::max(largest, std::acos(std::clamp(0.5 * (trace - 1), -1.0, 1.0)));
  }
  if (largest <= kNoticeable) return std::nullopt;
  return fmt::format(
      "points have turned by up to {:.2g} rad, which the law \"linear-elastic\" takes for strain: above 0.01 "
      "its "
      "stresses are wrong by {:.2g} of Young's modulus and more; \"compressible-neo-hookean\" has the same "
      "constants and no such limit",
      largest, 0.5 * largest * largest);
}

}  // namespace riven
