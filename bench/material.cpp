// Rates of constitutive laws: stresses of gradients with stretches of 0.8 to 1.4, on one core.

#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <random>

#include "material/material.hpp"

namespace {

using namespace riven;

constexpr std::size_t kPoints = 1024;

Material material_of(std::int64_t number) {
  const Material materials[] = {
      {"neo-Hookean", NeoHookean{0.5}, 1},
      {"Mooney-Rivlin", MooneyRivlin{0.4, 0.1}, 1},
      {"polynomial", Polynomial{0.3, 0.2, -0.01, 0.004, 0.002, 0.0008, 0.0003, 0.0002, 0.0001}, 1},
      {"Yeoh", Yeoh{0.5, -0.02, 0.003}, 1},
      {"Arruda-Boyce", ArrudaBoyce{1, 7}, 1},
      {"Gent", Gent{1, 50}, 1},
      {"Ogden", Ogden{{0.63, 0.0012, -0.01}, {1.3, 5, -2}}, 1},
      {"linear elastic", LinearElastic{{2.5, 0.25}}, 1},
      {"St. Venant-Kirchhoff", StVenantKirchhoff{{2.5, 0.25}}, 1},
      {"compressible neo-Hookean", CompressibleNeoHookean{{2.5, 0.25}}, 1},
  };
  return materials[number];
}
constexpr std::int64_t kRubbers = 7, kMaterials = 10;

void stress(benchmark::State& state, Material material, Kinematics kinematics) {
  const int dimension = kinematics == Kinematics::solid ? 3 : 2, components = dimension * dimension;
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> stretch(0.8, 1.4), angle(-3, 3);
  std::vector<std::vector<double>> f(9, std::vector<double>(kPoints)), p = f;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const auto turn = [&] { return Eigen::AngleAxisd(angle(engine), Eigen::Vector3d::UnitZ()); };
    const Eigen::Vector3d l(stretch(engine), stretch(engine), stretch(engine));
    const Eigen::Matrix3d gradient = turn().toRotationMatrix() * l.asDiagonal() * turn().toRotationMatrix();
    for (int c = 0; c < components; ++c)
      f[static_cast<std::size_t>(c)][i] = gradient(c / dimension, c % dimension);
  }
  const double* from[9];
  double* to[9];
  for (std::size_t c = 0; c < 9; ++c) {
    from[c] = f[c].data();
    to[c] = p[c].data();
  }
  std::vector<double> energy(kPoints);
  for (auto _ : state)
    benchmark::DoNotOptimize(material.stress(kinematics, kPoints, from, to, energy.data()));
  state.SetLabel(material.name);
  state.counters["points/s"] =
      benchmark::Counter(static_cast<double>(kPoints), benchmark::Counter::kIsIterationInvariantRate);
}

void solid(benchmark::State& state) {
  Material material = material_of(state.range(0));
  if (state.range(0) < kRubbers) material.volumetric = Volumetric{30};
  stress(state, material, Kinematics::solid);
}
void compressible_sheet(benchmark::State& state) {
  Material material = material_of(state.range(0));
  if (state.range(0) < kRubbers) material.volumetric = Volumetric{30};
  stress(state, material, Kinematics::plane_stress);
}
void incompressible_sheet(benchmark::State& state) {
  stress(state, material_of(state.range(0)), Kinematics::plane_stress);
}

BENCHMARK(solid)->DenseRange(0, kMaterials - 1);
BENCHMARK(compressible_sheet)->DenseRange(0, kMaterials - 1);
BENCHMARK(incompressible_sheet)->DenseRange(0, kRubbers - 1);

}  // namespace
