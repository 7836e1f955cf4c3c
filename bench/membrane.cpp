// Rates of the membrane models on a square sheet with a hole: directed bonds per CPU second of all threads,
// and bytes that body and model hold per directed bond; on a lattice and with the same bonds in lists, for
// each instruction set. One iteration is one evaluation of the force. Run: riven_bench
// [--benchmark_filter=...]

#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <limits>
#include <utility>

#include "base/instruction_set.hpp"
#include "body/lattice_body.hpp"
#include "body/listed_body.hpp"
#include "peridynamics/bond_membrane.hpp"
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
std::vector<double> stretched(const PointModel& sheet) {
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

Membrane make_model(Body body, const Membrane* /*kind*/) {
  return {std::move(body), Material{"rubber", NeoHookean{18e6}, 1100}, 4.0};
}

BondMembrane make_model(Body body, const BondMembrane* /*kind*/) {
  return {std::move(body), Material{"rubber", NeoHookean{18e6}, 1100}, {}};
}

template <class Model>
void force(benchmark::State& state) {
  const bool lists = state.range(0) != 0;
  const auto set = static_cast<InstructionSet>(state.range(2));
  if (!supported(set)) return state.SkipWithError("this processor lacks the instruction set");
  use_instruction_set(set);
  omp_set_num_threads(static_cast<int>(state.range(1)));
  const Body body = make_sheet(static_cast<int>(state.range(3)));
  Model sheet = make_model(lists ? listed(body) : body, static_cast<const Model*>(nullptr));
  const std::vector<double> u = stretched(sheet);
  std::vector<double> f(sheet.dofs());
  for (auto _ : state) {
    benchmark::DoNotOptimize(sheet.internal_force(u, f));
    benchmark::ClobberMemory();
  }
  const auto bonds = static_cast<double>(sheet.bonds());
  state.counters["bonds"] = bonds;
  state.counters["bonds/cpu_s"] =
      benchmark::Counter(bonds * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["bytes/bond"] = static_cast<double>(sheet.bytes()) / bonds;
}

void arguments(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"listed", "threads", "isa", "side"})
      ->ArgsProduct({{0, 1}, {1, 2}, {0, 1, 2}, {100, 400}})
      ->MeasureProcessCPUTime()
      ->Unit(benchmark::kMicrosecond);
}
BENCHMARK(force<Membrane>)->Apply(arguments);
BENCHMARK(force<BondMembrane>)->Apply(arguments);

}  // namespace
