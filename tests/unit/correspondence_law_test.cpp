#include "peridynamics/correspondence_law.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "support/random.hpp"

namespace riven::testing {
namespace {

// The linear law that bounds stiffnesses: above Hooke's with the same longitudinal and shear modulus, equal
// to it in waves, and the stress is that of its tangent.
template <int D>
void check_majorant(Random& random) {
  using Tensor = Eigen::Matrix<double, D, D>;
  const double shear = 1, lame = random.between(-0.5, 10), longitudinal = lame + 2 * shear;
  const Majorant<D> law{longitudinal, 1 - 2 * shear / longitudinal};
  const auto above = [&](const Tensor& h) { return longitudinal * flat<D>(h).dot(law.unit() * flat<D>(h)); };
  const auto hooke = [&](const Tensor& h) {
    return lame * h.trace() * h.trace() + 0.5 * shear * (h + h.transpose()).squaredNorm();
  };
  const auto random_vector = [&] {
    return Eigen::Matrix<double, D, 1>(
        Eigen::Matrix<double, D, 1>::NullaryExpr([&](Eigen::Index) { return random.between(-1, 1); }));
  };
  Tensor h;
  for (double& entry : h.reshaped()) entry = random.between(-1, 1);
  EXPECT_GE(above(h), hooke(h) - 1e-12);
  const Tensor wave = random_vector() * random_vector().transpose();
  EXPECT_NEAR(above(wave), longitudinal * wave.squaredNorm(), 1e-12);
  EXPECT_LE(hooke(wave), above(wave) + 1e-12);
  EXPECT_NEAR(above(Tensor::Identity()), hooke(Tensor::Identity()), 1e-12 * longitudinal);

  double f[9], p[9], energy = 0;
  const double* gradients[9];
  double* stresses[9];
  for (int c = 0; c < D * D; ++c) {
    f[c] = h(c / D, c % D) + (c / D == c % D ? 1 : 0);
    gradients[c] = f + c;
    stresses[c] = p + c;
  }
  EXPECT_EQ(law.stress(1, gradients, stresses, &energy), 0U);
  const Eigen::Matrix<double, D * D, 1> expected = longitudinal * law.unit() * flat<D>(h);
  for (int c = 0; c < D * D; ++c) EXPECT_NEAR(p[c], expected[c], 1e-12 * longitudinal);
}

TEST(CorrespondenceLaw, HasAMajorantThatIsSharpInWaves) {
  Random random(5);
  for (int n = 0; n < 200; ++n) {
    check_majorant<2>(random);
    check_majorant<3>(random);
  }
}

}  // namespace
}  // namespace riven::testing
