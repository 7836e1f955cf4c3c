#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "material/law.hpp"
#include "material/response.hpp"

namespace riven {

/// What a deformation gradient is part of: a solid, a plane between rigid walls, or a sheet that nothing
/// presses on from the sides.
enum class Kinematics { solid, plane_strain, plane_stress };

/// Energy of a change of volume, added to the isochoric energy W(F / J^(1/3)) of a nearly incompressible
/// material: k/2 (J - 1)^2, or k/4 (J^2 - 1 - 2 ln J), which resists collapse.
struct Volumetric {
  enum class Form { quadratic, logarithmic };
  double bulk_modulus = 0;  // Pa
  Form form = Form::quadratic;
};

/// Constants of a material at small strain; bulk modulus infinite if it is incompressible.
struct SmallStrain {
  double shear = 0, bulk = 0;  // Pa

  [[nodiscard]] double youngs_modulus() const;
  [[nodiscard]] double poissons_ratio() const;
  /// Modulus of uniaxial strain, k + 4/3 mu (Pa).
  [[nodiscard]] double longitudinal() const { return bulk + 4.0 / 3 * shear; }
};

/// A branch of a Prony series: the share of the isochoric stress that relaxes, and its time.
struct Relaxation {
  double share = 0;
  double time = 0;  // s
};

/// A constitutive law with its density; knows nothing of bodies and solvers. Rubber materials theory,
/// sections 2 and 3.
struct Material {
  std::string name;
  Law law;
  double density = 0;                      // kg/m^3
  std::optional<Volumetric> volumetric{};  // of a law of invariants or stretches; without, incompressible
  /// Of a law of invariants or stretches; empty: elastic. What follows below is its instantaneous response;
  /// `Viscoelastic` has the rest.
  std::vector<Relaxation> relaxation{};

  [[nodiscard]] bool incompressible() const;
  /// Whether a rotation of the body only rotates its stress.
  [[nodiscard]] bool objective() const;
  [[nodiscard]] SmallStrain small_strain() const;

  /// Three dimensions; not of an incompressible material, whose pressure does not follow from F. Where the
  /// law says nothing (det F <= 0, the limit of Gent's law), numbers are not finite.
  [[nodiscard]] Response solid(const Eigen::Matrix3d& f) const;
  /// The part in the plane of the response to `f` and no strain across it.
  [[nodiscard]] PlaneResponse plane_strain(const Eigen::Matrix2d& f) const;
  /// The response at the thickness that leaves no stress across the plane, eq. (9) to (11) if incompressible.
  [[nodiscard]] PlaneResponse plane_stress(const Eigen::Matrix2d& f) const;
  /// Thickness stretch in plane stress.
  [[nodiscard]] double thickness_stretch(const Eigen::Matrix2d& f) const;

  /// Energies and stresses of n deformation gradients, for loops over points: f and p have a row of n numbers
  /// per component, row by row of the tensor. Returns how many gradients the law says nothing of.
  std::size_t stress(Kinematics kinematics, std::size_t n, const double* const* f, double* const* p,
                     double* energy) const;
};

/// Speeds (m/s) of the plane waves along the unit vector `n` of the undeformed body in a deformed material,
/// in ascending order, from the acoustic tensor n_J A_iJkL n_L / density; negative squares as negative
/// speeds.
Eigen::Vector3d wave_speeds(const Material& material, const Eigen::Matrix3d& f, const Eigen::Vector3d& n);
/// The same in the plane.
Eigen::Vector2d wave_speeds(const PlaneResponse& response, double density, const Eigen::Vector2d& n);

}  // namespace riven
