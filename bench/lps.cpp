// Rates of the linear peridynamic solid, horizon 3 spacings, free surfaces, in small vibrations: a cube of
// 40^3 points with 7 153 608 directed bonds, and a plate in plane stress of 506^2 points with as many to
// 0.1 %. One iteration is a run of whole steps of Verlet's method. Rates are per CPU second of all threads;
// bytes are those of body, model and the solver's vectors.

#include <benchmark/benchmark.h>
#include <omp.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/instruction_set.hpp"
#include "body/lattice_body.hpp"
#include "body/listed_body.hpp"
#include "peridynamics/lps.hpp"
#include "solver/velocity_verlet.hpp"

namespace {

using namespace riven;

constexpr double kSpacing = 1e-3;  // m
constexpr LpsSettings kMaterial{.youngs_modulus = 72e9, .poissons_ratio = 0.22, .density = 2440};

Body make_box(int dimension) {
  const double half = 0.5 * (dimension == 3 ? 40 : 506) * kSpacing;
  return make_lattice_body({.dimension = dimension,
                            .shape = Box{{}, {half, half, half}},
                            .thickness = dimension == 3 ? 1 : kSpacing,
                            .spacing = kSpacing,
                            .horizon = 3 * kSpacing,
                            .defects = {},
                            .mirrored = {}});
}

/// 10 mm/s times the sine of another coordinate.
std::vector<double> velocities(const Lps& model) {
  std::vector<double> v(model.dofs(), 0.0);
  constexpr std::array<std::size_t, 3> along = {0, 2, 1};
  for (const std::size_t i : model.body().points)
    for (std::size_t d = 0; d < static_cast<std::size_t>(model.body().dimension); ++d)
      v[d * model.body().size() + i] =
          0.01 * std::sin(std::numbers::pi * model.body().position(i)[along[d]] / 0.04);
  return v;
}

constexpr double kStep = 50e-9;  // s
constexpr int kSteps = 400;      // so many that what a run does once does not count

void lps_step(benchmark::State& state) {
  const bool lists = state.range(0) != 0;
  const auto set = static_cast<InstructionSet>(state.range(2));
  if (!supported(set)) return state.SkipWithError("this processor lacks the instruction set");
  use_instruction_set(set);
  omp_set_num_threads(static_cast<int>(state.range(1)));
  const Body box = make_box(static_cast<int>(state.range(3)));
  Lps model(lists ? listed(box) : box, kMaterial);
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
  const double bytes = static_cast<double>(model.bytes()) + vectors;
  state.counters["bytes/bond"] = bytes / bonds;
  state.counters["bytes/point"] = bytes / static_cast<double>(model.points());
}

BENCHMARK(lps_step)
    ->ArgNames({"listed", "threads", "isa", "dimension"})
    ->ArgsProduct({{0, 1}, {1, 2}, {0, 1, 2}, {3, 2}})
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
