#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "material/material.hpp"

namespace riven::testing {

/// A law with its energy and shear modulus written out once more. Every test of laws runs over this table.
struct LawCase {
  std::string name;
  InvariantLaw law;
  std::function<double(double, double)> energy;  // W(I1, I2)
  double shear_modulus;

  [[nodiscard]] InvariantEnergy at(double i1, double i2) const {
    return std::visit([&](const auto& w) { return w(i1, i2); }, law);
  }
  [[nodiscard]] Material material(double density = 1) const { return {name, law, density}; }
};

inline std::string law_name(const ::testing::TestParamInfo<LawCase>& info) {
  return info.param.name;
}
inline void PrintTo(const LawCase& c, std::ostream* out) {
  *out << c.name;
}

inline const std::vector<LawCase>& law_cases() {
  static const std::vector<LawCase> cases = {
      {"neo_hookean", NeoHookean{0.5}, [](double i1, double) { return 0.5 * (i1 - 3); }, 1.0},
      {"neo_hookean_stiff", NeoHookean{1.8e7}, [](double i1, double) { return 1.8e7 * (i1 - 3); }, 3.6e7},
      {"mooney_rivlin", MooneyRivlin{0.4, 0.1},
       [](double i1, double i2) { return 0.4 * (i1 - 3) + 0.1 * (i2 - 3); }, 1.0},
      {"mooney_rivlin_i2_only", MooneyRivlin{0, 0.3}, [](double, double i2) { return 0.3 * (i2 - 3); }, 0.6},
      {"yeoh", Yeoh{0.1996e6, 0.017e6, 0},
       [](double i1, double) { return 0.1996e6 * (i1 - 3) + 0.017e6 * std::pow(i1 - 3, 2); }, 0.3992e6},
      {"yeoh_cubic", Yeoh{0.5, -0.02, 0.003},
       [](double i1, double) {
         return 0.5 * (i1 - 3) - 0.02 * std::pow(i1 - 3, 2) + 0.003 * std::pow(i1 - 3, 3);
       },
       1.0},
  };
  return cases;
}

/// One law of each kind, with a shear modulus of 1: for tests of bodies.
inline std::vector<LawCase> unit_laws() {
  return {law_cases()[0], law_cases()[2], law_cases()[5]};
}

}  // namespace riven::testing
