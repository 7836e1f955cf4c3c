#pragma once

#include <Eigen/Core>
#include <string>

#include "material/invariant_law.hpp"

namespace riven {

/// What a law answers to a plane deformation gradient.
struct PlaneResponse {
  double energy = 0;        // strain energy density (J/m^3)
  Eigen::Matrix2d stress;   // first Piola-Kirchhoff stress P_iJ (Pa)
  Eigen::Matrix4d tangent;  // dP_iJ/dF_kL (Pa), rows and columns numbered 2 i + J
};

/// A constitutive law with its density; knows nothing of bodies and solvers.
struct Material {
  std::string name;
  InvariantLaw law;
  double density = 0;  // kg/m^3

  /// Incompressible sheet in plane stress: the thickness stretch is 1/det F. `f` is the 2x2 deformation
  /// gradient of the plane with det > 0. Rubber materials theory, eq. (9)-(11).
  [[nodiscard]] PlaneResponse plane_stress(const Eigen::Matrix2d& f) const;
};

}  // namespace riven
