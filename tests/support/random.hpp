#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <random>

namespace riven::testing {

/// Random numbers with a seed that the test prints when it fails.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  bool chance(double probability) { return between(0, 1) < probability; }

  Eigen::Matrix2d rotation(double largest_angle = 3.14) {
    return Eigen::Rotation2Dd(between(-largest_angle, largest_angle)).toRotationMatrix();
  }
  /// Rotation, principal stretches in the given range, rotation: any deformation gradient with det > 0.
  Eigen::Matrix2d gradient(double low, double high) {
    const Eigen::Vector2d stretch(between(low, high), between(low, high));
    return rotation() * stretch.asDiagonal() * rotation();
  }

 private:
  std::mt19937 engine_;
};

}  // namespace riven::testing
