#pragma once

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "material/material.hpp"

namespace riven::testing {

/// Nominal stresses of an incompressible law at a stretch (Pa), from a source or by hand.
struct NominalStresses {
  double stretch, uniaxial, equibiaxial, planar;
};

/// A law with its energy written out once more. Every test of laws runs over this table.
struct LawCase {
  std::string name;
  Law law;
  std::function<double(const Eigen::Matrix3d&)> energy;  // W(F); of rubbers at det F = 1
  double shear_modulus;
  double bulk_modulus = 0;  // of laws that have one of their own
  std::vector<NominalStresses> curves{};

  [[nodiscard]] bool is_rubber() const { return bulk_modulus == 0; }
  [[nodiscard]] InvariantEnergy at(double i1, double i2) const {
    return std::visit([&](const auto& w) { return w(i1, i2); }, invariant_law(law).value());
  }
  /// Incompressible if it is a rubber.
  [[nodiscard]] Material material(double density = 1) const { return {name, law, density}; }
  /// With a bulk modulus if it is a rubber.
  [[nodiscard]] Material compressible(double density = 1) const {
    Material material{name, law, density};
    if (is_rubber()) material.volumetric = Volumetric{30 * shear_modulus, Volumetric::Form::quadratic};
    return material;
  }
};

inline std::string law_name(const ::testing::TestParamInfo<LawCase>& info) {
  return info.param.name;
}
inline void PrintTo(const LawCase& c, std::ostream* out) {
  *out << c.name;
}

/// W(F) from W(I1, I2).
inline auto of_invariants(std::function<double(double, double)> w) {
  return [w = std::move(w)](const Eigen::Matrix3d& f) {
    const Eigen::Vector3d l = Eigen::JacobiSVD<Eigen::Matrix3d>(f).singularValues().array().square();
    return w(l.sum(), l(0) * l(1) + l(1) * l(2) + l(2) * l(0));
  };
}
/// W(F) from a sum over the principal stretches.
inline auto of_stretches(std::function<double(double)> w) {
  return [w = std::move(w)](const Eigen::Matrix3d& f) {
    const Eigen::Vector3d l = Eigen::JacobiSVD<Eigen::Matrix3d>(f).singularValues();
    return w(l(0)) + w(l(1)) + w(l(2));
  };
}

/// A new law gets its tests by a row.
inline const std::vector<LawCase>& law_cases() {
  const auto p = [](double x, double n) { return std::pow(x, n); };
  static const std::vector<LawCase> cases = {
      {"neo_hookean", NeoHookean{0.5}, of_invariants([](double i1, double) { return 0.5 * (i1 - 3); }), 1.0},
      {"neo_hookean_stiff",
       NeoHookean{1e6},
       of_invariants([](double i1, double) { return 1e6 * (i1 - 3); }),
       2e6,
       0,
       {{0.5, -7e6, -63e6, -15e6},
        {1.5, 2.11111e6, 2.73663e6, 2.40741e6},
        {3, 5.77778e6, 5.99177e6, 5.92593e6}}},
      {"mooney_rivlin", MooneyRivlin{0.4, 0.1},
       of_invariants([](double i1, double i2) { return 0.4 * (i1 - 3) + 0.1 * (i2 - 3); }), 1.0},
      {"mooney_rivlin_i2_only", MooneyRivlin{0, 0.3},
       of_invariants([](double, double i2) { return 0.3 * (i2 - 3); }), 0.6},
      {"mooney_rivlin_wada",
       MooneyRivlin{1, 0.5},
       of_invariants([](double i1, double i2) { return i1 - 3 + 0.5 * (i2 - 3); }),
       3,
       0,
       {{0.5, -14, -70.875, -22.5}, {1.5, 2.81481, 5.81533, 3.61111}, {3, 6.74074, 32.95473, 8.88889}}},
      {"polynomial", Polynomial{0.3, 0.2, -0.01, 0.004, 0.002, 0.0008, 0.0003, 0.0002, 0.0001},
       of_invariants([p](double i1, double i2) {
         const double x = i1 - 3, y = i2 - 3;
         return 0.3 * x + 0.2 * y - 0.01 * x * x + 0.004 * x * y + 0.002 * y * y + 0.0008 * p(x, 3) +
                0.0003 * x * x * y + 0.0002 * x * y * y + 0.0001 * p(y, 3);
       }),
       1.0},
      {"yeoh",
       Yeoh{0.1996, 0.017, 0},
       of_invariants([](double i1, double) { return 0.1996 * (i1 - 3) + 0.017 * std::pow(i1 - 3, 2); }),
       0.3992,
       0,
       {{0.5, -1.6947, -41.4918, -4.1415}, {1.5, 0.46325, 0.70418, 0.53736}, {3, 2.46287, 4.25427, 2.61557}}},
      {"yeoh_cubic", Yeoh{0.5, -0.02, 0.003}, of_invariants([p](double i1, double) {
         return 0.5 * (i1 - 3) - 0.02 * p(i1 - 3, 2) + 0.003 * p(i1 - 3, 3);
       }),
       1.0},
      {"arruda_boyce",
       ArrudaBoyce{1, 7},
       of_invariants([p](double i1, double) {
         return 0.5 * (i1 - 3) + (i1 * i1 - 9) / (20 * p(7, 2)) + 11 * (p(i1, 3) - 27) / (1050 * p(7, 4)) +
                19 * (p(i1, 4) - 81) / (7000 * p(7, 6)) + 519 * (p(i1, 5) - 243) / (673750 * p(7, 8));
       }),
       // Theory note, eq. (2).
       1 + 3 / (5 * 49.0) + 99 / (175 * p(7, 4)) + 513 / (875 * p(7, 6)) + 42039 / (67375 * p(7, 8)),
       0,
       {{0.5, -3.56242, -33.87518, -7.66633},
        {1.5, 1.07136, 1.39537, 1.2223},
        {3, 3.01045, 3.24524, 3.09378}}},
      {"gent",
       Gent{1, 50},
       of_invariants([](double i1, double) { return -25 * std::log(1 - (i1 - 3) / 50); }),
       1,
       0,
       {{0.5, -3.58974, -43.15068, -7.8534},
        {1.5, 1.06802, 1.4164, 1.22066},
        {3, 3.33333, 4.28135, 3.45423}}},
      {"ogden",
       Ogden{{0.63, 0.0012, -0.01}, {1.3, 5, -2}},
       of_stretches([p](double l) {
         return 0.63 / 1.3 * (p(l, 1.3) - 1) + 0.0012 / 5 * (p(l, 5) - 1) + 0.01 / 2 * (p(l, -2) - 1);
       }),
       0.5 * (0.63 * 1.3 + 0.0012 * 5 + 0.01 * 2),
       0,
       {{0.5, -1.54893, -9.66377, -2.74249},
        {1.5, 0.40162, 0.60198, 0.48156},
        {3, 0.87993, 1.2307, 0.95243}}},
      {"linear_elastic", LinearElastic{{2.5, 0.25}},
       [](const Eigen::Matrix3d& f) {
         const Eigen::Matrix3d e = 0.5 * (f + f.transpose()) - Eigen::Matrix3d::Identity();
         return 0.5 * e.trace() * e.trace() + e.squaredNorm();  // lambda = mu = 1
       },
       1, 5.0 / 3},
      {"st_venant_kirchhoff", StVenantKirchhoff{{2.5, 0.25}},
       [](const Eigen::Matrix3d& f) {
         const Eigen::Matrix3d e = 0.5 * (f.transpose() * f - Eigen::Matrix3d::Identity());
         return 0.5 * e.trace() * e.trace() + e.squaredNorm();
       },
       1, 5.0 / 3},
      {"compressible_neo_hookean", CompressibleNeoHookean{{2.5, 0.25}},
       [](const Eigen::Matrix3d& f) {
         const double log_j = std::log(f.determinant());
         return 0.5 * (f.squaredNorm() - 3 - 2 * log_j) + 0.5 * log_j * log_j;
       },
       1, 5.0 / 3},
  };
  return cases;
}

inline std::vector<LawCase> laws_that(const std::function<bool(const LawCase&)>& holds) {
  std::vector<LawCase> some;
  std::copy_if(law_cases().begin(), law_cases().end(), std::back_inserter(some), holds);
  return some;
}
/// Those W(I1, I2).
inline std::vector<LawCase> invariant_laws() {
  return laws_that([](const LawCase& c) { return invariant_law(c.law).has_value(); });
}

/// One law of each kind, with a shear modulus of 1: for tests of bodies.
inline std::vector<LawCase> unit_laws() {
  return laws_that([](const LawCase& c) {
    return c.name == "neo_hookean" || c.name == "mooney_rivlin" || c.name == "yeoh_cubic";
  });
}

}  // namespace riven::testing
