#pragma once

namespace riven {

/// How an element's change of volume enters its energy.
enum class Dilatation {
  full,       // at every quadrature point: locks if nearly incompressible, except in plane stress
  mean,       // its mean over the element: W(F) without U, and V U(mean of J), eq. (15) of the theory
  linear,     // of eight-node quadrilaterals: a linear fit of it, and the integral of U of that
  selective,  // of its mean gradient, of `q4` that at the centre: selective reduced integration
};

}  // namespace riven
