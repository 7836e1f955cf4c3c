#pragma once

#include <cmath>

#include "material/material.hpp"

namespace riven {

/// U'(J) and U''(J) of the energy of a change of volume (Pa), U itself returned.
inline double volume_energy(const Volumetric& volumetric, double j, double& first, double& second) {
  const double k = volumetric.bulk_modulus;
  if (volumetric.form == Volumetric::Form::quadratic) {
    first = k * (j - 1);
    second = k;
    return 0.5 * k * (j - 1) * (j - 1);
  }
  first = 0.5 * k * (j - 1 / j);
  second = 0.5 * k * (1 + 1 / (j * j));
  return 0.25 * k * (j * j - 1 - 2 * std::log(j));
}

}  // namespace riven
