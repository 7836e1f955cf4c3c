#pragma once

#include <benchmark/benchmark.h>
#include <omp.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/instruction_set.hpp"
#include "body/lattice_body.hpp"
#include "peridynamics/point_model.hpp"
#include "solver/velocity_verlet.hpp"

namespace riven::bench {

inline constexpr double kSpacing = 1e-3;  // m

/// A block of side^dimension points with free surfaces, horizon 3 spacings.
inline Body block(int dimension, int side) {
  const double half = 0.5 * side * kSpacing;
  return make_lattice_body({.dimension = dimension,
                            .shape = Box{{}, {half, half, half}},
                            .thickness = dimension == 3 ? 1 : kSpacing,
                            .spacing = kSpacing,
                            .horizon = 3 * kSpacing,
                            .defects = {},
                            .mirrored = {}});
}

/// Sets what the arguments "threads" and "isa" say, unless the processor lacks the instruction set.
inline bool prepare(benchmark::State& state, std::int64_t threads, std::int64_t isa) {
  const auto set = static_cast<InstructionSet>(isa);
  if (!supported(set)) {
    state.SkipWithError("this processor lacks the instruction set");
    return false;
  }
  use_instruction_set(set);
  omp_set_num_threads(static_cast<int>(threads));
  return true;
}

/// 10 mm/s times the sine of another coordinate.
inline std::vector<double> velocities(const PointModel& model) {
  std::vector<double> v(model.dofs(), 0.0);
  constexpr std::array<std::size_t, 3> along = {0, 2, 1};
  for (const std::size_t i : model.body().points)
    for (std::size_t d = 0; d < static_cast<std::size_t>(model.body().dimension); ++d)
      v[d * model.body().size() + i] =
          0.01 * std::sin(std::numbers::pi * model.body().position(i)[along[d]] / 0.04);
  return v;
}

/// Small vibrations by whole steps of Verlet's method, a run of them per iteration. Rates are per CPU second
/// of all threads; bytes are those of body, model and the solver's vectors.
inline void vibrate(benchmark::State& state, PointModel& model) {
  constexpr double step = 50e-9;  // s
  constexpr int steps = 400;      // so many that what a run does once does not count
  Constraints constraints(model.dofs(), 1);
  constexpr double end = steps * step;
  VelocityVerletSettings settings{.until = end, .every = end, .history_every = end, .step = step};
  settings.initial_v = velocities(model);
  Observer nobody;
  for (auto _ : state) benchmark::DoNotOptimize(march(model, constraints, settings, nobody).u.data());
  const auto bonds = static_cast<double>(model.bonds());
  state.counters["bonds"] = bonds;
  state.counters["bonds/cpu_s"] = benchmark::Counter(steps * bonds * static_cast<double>(state.iterations()),
                                                     benchmark::Counter::kIsRate);
  const auto vectors = static_cast<double>(4 * model.dofs() * sizeof(double));  // u, v, force, mass
  const double bytes = static_cast<double>(model.bytes()) + vectors;
  state.counters["bytes/bond"] = bytes / bonds;
  state.counters["bytes/point"] = bytes / static_cast<double>(model.points());
}

}  // namespace riven::bench
