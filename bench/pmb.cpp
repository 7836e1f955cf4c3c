// Rates of the PMB model: a cube of 40^3 points with free surfaces, horizon 3 spacings, 7 153 608 directed
// bonds, in small vibrations that break nothing. One iteration is a whole step of Verlet's method with the
// failure test. Rates are per CPU second of all threads; bytes are those of body, model and the solver's
// vectors.

#include <benchmark/benchmark.h>
#include <omp.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/instruction_set.hpp"
#include "body/lattice_body.hpp"
#include "body/listed_body.hpp"
#include "peridynamics/pmb.hpp"
#include "solver/velocity_verlet.hpp"

namespace {

using namespace riven;

constexpr double kSpacing = 1e-3;  // m
constexpr PmbSettings kMaterial{.youngs_modulus = 72e9, .density = 2440, .critical_stretch = 0.001};

Body make_cube(int side) {
  const double half = 0.5 * side * kSpacing;
  return make_lattice_body({.dimension = 3,
                            .shape = Box{{}, {half, half, half}},
                            .spacing = kSpacing,
                            .horizon = 3 * kSpacing,
                            .defects = {},
                            .mirrored = {}});
}

/// 10 mm/s times the sine of another coordinate.
std::vector<double> velocities(const Pmb& model) {
  std::vector<double> v(model.dofs(), 0.0);
  constexpr std::array<std::size_t, 3> along = {0, 2, 1};
  for (const std::size_t i : model.body().points)
    for (std::size_t d = 0; d < 3; ++d)
      v[d * model.body().size() + i] =
          0.01 * std::sin(std::numbers::pi * model.body().position(i)[along[d]] / 0.04);
  return v;
}

constexpr double kStep = 50e-9;  // s
constexpr int kSteps = 400;      // so many that what a run does once does not count

void pmb_step(benchmark::State& state) {
  const bool lists = state.range(0) != 0;
  const auto set = static_cast<InstructionSet>(state.range(2));
  if (!supported(set)) return state.SkipWithError("this processor lacks the instruction set");
  use_instruction_set(set);
  omp_set_num_threads(static_cast<int>(state.range(1)));
  const Body cube = make_cube(static_cast<int>(state.range(3)));
  Pmb model(lists ? listed(cube) : cube, kMaterial);
  Constraints constraints(model.dofs(), 1);
  constexpr double end = kSteps * kStep;
  VelocityVerletSettings settings{.until = end, .every = end, .history_every = end, .step = kStep};
  settings.initial_v = velocities(model);
  Observer nobody;
  for (auto _ : state) benchmark::DoNotOptimize(march(model, constraints, settings, nobody).u.data());
  const auto bonds = static_cast<double>(model.bonds());
  state.counters["bonds"] = bonds;
  state.counters["bonds/cpu_s"] = benchmark::Counter(kSteps * bonds * static_cast<double>(state.iterations()),
                                                     benchmark::Counter::kIsRate);
  const auto vectors = static_cast<double>(4 * model.dofs() * sizeof(double));  // u, v, force, mass
  state.counters["bytes/bond"] = (static_cast<double>(model.bytes()) + vectors) / bonds;
}

BENCHMARK(pmb_step)
    ->ArgNames({"listed", "threads", "isa", "side"})
    ->ArgsProduct({{0, 1}, {1, 2}, {0, 1, 2}, {40}})
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
