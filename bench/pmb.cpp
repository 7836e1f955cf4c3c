// Rates of the PMB model: a cube of 40^3 points with free surfaces, horizon 3 spacings, 7 153 608 directed
// bonds, in small vibrations that break nothing. One iteration is a whole step of Verlet's method with the
// failure test. Rates are per CPU second of all threads; bytes are those of body, model and the solver's
// vectors.

#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <numbers>

#include "base/instruction_set.hpp"
#include "body/lattice_body.hpp"
#include "body/listed_body.hpp"
#include "peridynamics/pmb.hpp"
#include "solver/velocity_verlet.hpp"

namespace {

using namespace riven;

constexpr double kSpacing = 1e-3;  // m
constexpr PmbSettings kMaterial{.youngs_modulus = 72e9, .density = 2440, .critical_stretch = 0.01};

Body make_cube(int side) {
  const double half = 0.5 * side * kSpacing;
  return make_lattice_body({.dimension = 3,
                            .shape = Box{{}, {half, half, half}},
                            .spacing = kSpacing,
                            .horizon = 3 * kSpacing,
                            .defects = {},
                            .mirrored = {}});
}

constexpr int kSteps = 400;  // so that what a run does once does not count

void pmb_step(benchmark::State& state) {
  const bool lists = state.range(0) != 0;
  const auto set = static_cast<InstructionSet>(state.range(2));
  if (!supported(set)) return state.SkipWithError("this processor lacks the instruction set");
  use_instruction_set(set);
  omp_set_num_threads(static_cast<int>(state.range(1)));
  const Body cube = make_cube(static_cast<int>(state.range(3)));
  Pmb model(lists ? listed(cube) : cube, kMaterial);
  Constraints constraints(model.dofs(), 1);
  const double dt = 0.5 * stable_step(model, constraints, std::vector<double>(model.dofs(), 0.0));
  const VelocityVerletSettings settings{
      .until = kSteps * dt, .every = kSteps * dt, .history_every = kSteps * dt, .step = dt};
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
