#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "load/constraints.hpp"
#include "model/model.hpp"

namespace riven {

inline double dot(std::span<const double> a, std::span<const double> b) {
  return ordered_sum_of(a.size(), [&](std::size_t i) { return a[i] * b[i]; });
}

inline double norm(std::span<const double> v) {
  return std::sqrt(dot(v, v));
}

/// Mass (kg) of the free entries; 0 elsewhere: what is prescribed carries no inertia of its own.
inline std::vector<double> free_mass(const Model& model, const Constraints& constraints) {
  std::vector<double> mass(model.dofs(), 0.0);
  model.mass(mass);
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (!constraints.is_free(i)) mass[i] = 0;
  return mass;
}

}  // namespace riven
