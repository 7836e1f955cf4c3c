// Rates of the membrane model on a square sheet with a hole: directed bonds per second of one force
// evaluation, and bytes that the model holds per point and per directed bond. Run: riven_bench
// [--benchmark_filter=...]

#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <limits>

#include "body/lattice_body.hpp"
#include "peridynamics/membrane.hpp"

namespace {

using namespace riven;

Membrane make_sheet(int points_per_side) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  LatticeBodyInput in;
  in.shape = Box{{}, {0.25, 0.25, endless}};
  in.thickness = 0.01;
  in.spacing = 0.5 / points_per_side;
  in.horizon = 3 * in.spacing;
  in.defects.holes.push_back(Disc{{}, 0.08});
  in.mirrored = 0b1111;
  return {make_lattice_body(in), Material{"rubber", NeoHookean{18e6}, 1100}, 4.0};
}

/// Every stored point stretched by half; ghosts included.
std::vector<double> stretched(const Membrane& sheet) {
  std::vector<double> u(sheet.dofs(), 0.0);
  const Lattice& lattice = sheet.body().on_lattice()->lattice;
  lattice.for_each_cell([&](const Cell& cell, std::size_t i) {
    const Point x = lattice.position(cell);
    u[i] = 0.5 * x[0];
    u[lattice.size() + i] = 0.5 * x[1];
  });
  return u;
}

void force(benchmark::State& state) {
  omp_set_num_threads(static_cast<int>(state.range(1)));
  Membrane sheet = make_sheet(static_cast<int>(state.range(0)));
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

BENCHMARK(force)
    ->ArgNames({"side", "threads"})
    ->ArgsProduct({{100, 400, 1000}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
