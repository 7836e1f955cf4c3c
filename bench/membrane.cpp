// Rates of the membrane model on a square sheet with a hole: directed bonds per second of one force
// evaluation, and bytes that the model holds per point and per directed bond; for bonds on a lattice and for
// the same bonds in lists. Run: riven_bench [--benchmark_filter=...]

#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <limits>
#include <utility>

#include "body/lattice_body.hpp"
#include "body/listed_body.hpp"
#include "peridynamics/membrane.hpp"

namespace {

using namespace riven;

Body make_sheet(int points_per_side) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  LatticeBodyInput in;
  in.shape = Box{{}, {0.25, 0.25, endless}};
  in.thickness = 0.01;
  in.spacing = 0.5 / points_per_side;
  in.horizon = 3 * in.spacing;
  in.defects.holes.push_back(Disc{{}, 0.08});
  in.mirrored = 0b1111;
  return make_lattice_body(in);
}

/// Every stored point stretched by half; ghosts included.
std::vector<double> stretched(const Membrane& sheet) {
  std::vector<double> u(sheet.dofs(), 0.0);
  const Body& body = sheet.body();
  const auto stretch = [&](std::size_t i) {
    const Point x = body.position(i);
    u[i] = 0.5 * x[0];
    u[body.size() + i] = 0.5 * x[1];
  };
  for (const std::size_t i : body.points) stretch(i);
  for (const GhostPoint& ghost : body.ghosts) stretch(ghost.point);
  return u;
}

void measure_force(benchmark::State& state, Body body) {
  omp_set_num_threads(static_cast<int>(state.range(1)));
  Membrane sheet(std::move(body), Material{"rubber", NeoHookean{18e6}, 1100}, 4.0);
  const std::vector<double> u = stretched(sheet);
  std::vector<double> f(sheet.dofs());
  for (auto _ : state) {
    benchmark::DoNotOptimize(sheet.internal_force(u, f));
    benchmark::ClobberMemory();
  }
  const auto bonds = static_cast<double>(sheet.bonds());
  state.counters["bonds/s"] =
      benchmark::Counter(bonds * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["bytes/point"] = static_cast<double>(sheet.bytes()) / static_cast<double>(sheet.points());
  state.counters["bytes/bond"] = static_cast<double>(sheet.bytes()) / bonds;
}

void force(benchmark::State& state) {
  measure_force(state, make_sheet(static_cast<int>(state.range(0))));
}

void force_listed(benchmark::State& state) {
  measure_force(state, listed(make_sheet(static_cast<int>(state.range(0)))));
}

BENCHMARK(force)
    ->ArgNames({"side", "threads"})
    ->ArgsProduct({{100, 400, 1000}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(force_listed)
    ->ArgNames({"side", "threads"})
    ->ArgsProduct({{100, 400, 1000}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
