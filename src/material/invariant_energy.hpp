#pragma once

namespace riven {

/// Strain energy density W(I1, I2) and its derivatives (J/m^3); W = 0 in the undeformed state, I1 = I2 = 3.
struct InvariantEnergy {
  double w = 0;
  double w1 = 0, w2 = 0;             // dW/dI1, dW/dI2
  double w11 = 0, w12 = 0, w22 = 0;  // second derivatives
};

}  // namespace riven
