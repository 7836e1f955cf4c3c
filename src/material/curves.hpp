#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "material/material.hpp"

namespace riven {

/// Homogeneous deformations in which materials are tested, by a stretch: along one direction, with the others
/// free of stress (uniaxial), or one held and one free (planar, "pure shear"); along two directions, with the
/// third free. And simple shear by its amount F_12, and a change of volume by J = det F.
enum class Deformation { uniaxial, planar, equibiaxial, simple_shear, volumetric };

/// "uniaxial", ...
std::string_view name(Deformation deformation);

/// What a material answers there.
struct HomogeneousState {
  double at = 1;    // stretch, amount of shear, or J
  double free = 1;  // stretch of the directions that are free of stress
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
  double stress = 0;  // nominal (Pa), along the stretch; the shear stress P_12; the pressure -tr(sigma) / 3
  double slope = 0;   // its derivative with respect to `at` (Pa), the free stretch following
};

/// The undeformed state.
HomogeneousState rest(const Material& material, Deformation deformation);

/// The state at another stretch, shear or J that goes on from one: stretches of free directions are in closed
/// form if incompressible, else Newton's method follows them from their value there. Nothing where the law
/// says nothing (Gent's limit) or no free stretch relieves the stress. Volumetric: of compressible materials
/// only.
std::optional<HomogeneousState> follow(const Material& material, Deformation deformation,
                                       const HomogeneousState& from, double at);

/// The first place on the way from rest to `to` where there is no state or `holds` of it is false, if any:
/// steps of 0.01, then bisection to nine digits. What ceases to hold for less than a step may be missed.
std::optional<double> first_failure(const Material& material, Deformation deformation, double to,
                                    const std::function<bool(const HomogeneousState&)>& holds);

/// Stresses at some places; NaN beyond where the states end.
struct Curve {
  Deformation deformation{};
  std::vector<double> at, stress;
  std::vector<double> ends;  // where states end within these places, at most one on each side of rest
};

/// `at` in ascending order.
Curve curve(const Material& material, Deformation deformation, const std::vector<double>& at);

}  // namespace riven
