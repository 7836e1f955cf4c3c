#include "body/stencil.hpp"

#include <cmath>

namespace riven {

double horizon_limit(double horizon) {
  return horizon * (1 + 1e-6);
}

int stencil_reach(double horizon, double spacing) {
  return static_cast<int>(std::floor(horizon_limit(horizon) / spacing));
}

Stencil make_stencil(const Lattice& lattice, double horizon) {
  const double limit = horizon_limit(horizon);
  const int reach = stencil_reach(horizon, lattice.spacing());
  const auto along = [&](int axis) { return axis < lattice.dimension() ? reach : 0; };
  Stencil stencil;
  for (int k = -along(2); k <= along(2); ++k)
    for (int j = -along(1); j <= along(1); ++j)
      for (int i = -along(0); i <= along(0); ++i) {
        const double length = lattice.spacing() * std::sqrt(static_cast<double>(i * i + j * j + k * k));
        if ((i == 0 && j == 0 && k == 0) || length > limit) continue;
        stencil.offset.push_back({i, j, k});
        stencil.shift.push_back(lattice.shift({i, j, k}));
        stencil.bond.push_back({i * lattice.spacing(), j * lattice.spacing(), k * lattice.spacing()});
        stencil.length.push_back(length);
      }
  // The loops run over a box that is symmetric about the origin: reversing the order reverses the sign.
  for (std::size_t k = 0; k < stencil.size(); ++k) stencil.opposite.push_back(stencil.size() - 1 - k);
  return stencil;
}

}  // namespace riven
