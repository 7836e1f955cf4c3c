#pragma once

#include <string>
#include <vector>

#include "material/curves.hpp"

namespace riven {

/// Least eigenvalue (Pa) of the acoustic tensor A_iJkL n_J n_L over all directions n: a material is strongly
/// elliptic where it is positive, so that small waves have a speed. Of an isotropic material whose principal
/// directions are the axes; an incompressible one is a sheet in plane stress, with n in its plane.
double least_acoustic_eigenvalue(const Material& material, const Eigen::Matrix3d& f);

/// What a homogeneous deformation shows of an unstable law.
struct Instability {
  enum class Kind {
    end,          // there are no states beyond: the limit of Gent's law, a free stretch of zero
    ellipticity,  // strong ellipticity is lost: deformation localises
    stress        // the nominal stress does not increase with the stretch, as Drucker's criterion wants it
  };
  Deformation deformation{};
  Kind kind{};
  double stretch = 1;  // where it begins, coming from rest
};

/// The first instability of each kind in uniaxial, planar and equibiaxial deformation, between two stretches
/// and on each side of 1. What lasts for less than 0.01 of stretch may be missed.
std::vector<Instability> instabilities(const Material& material, double low, double high);

/// For people: "in uniaxial tension from a stretch of 1.291 on, strong ellipticity is lost: ...".
std::string instability_text(const Instability& instability);

}  // namespace riven
