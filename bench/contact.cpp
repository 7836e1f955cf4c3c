// Rates of contact between points of a cube of 40^3 points or a plate of 506^2: whole, where only the points
// of its surface are looked at, and crushed, where no bond is left and every point is. The force of the whole
// model (PMB) stands beside for comparison.

#include "load/contact_model.hpp"
#include "peridynamics/pmb.hpp"
#include "vibration.hpp"

namespace {

using namespace riven;

Body body_of(std::int64_t dimension, bool crushed) {
  Body body = bench::block(static_cast<int>(dimension), dimension == 3 ? 40 : 506);
  auto& masks = std::get<LatticeBonds>(body.bonds).bonds.bytes();
  if (crushed) std::fill(masks.begin(), masks.end(), std::uint8_t{0});
  return body;
}

void tell_rate(benchmark::State& state, const Body& body, const SelfContact& contact) {
  state.counters["points"] = static_cast<double>(body.points.size());
  state.counters["exposed"] = static_cast<double>(contact.pairs().points().size());
  state.counters["points/cpu_s"] =
      benchmark::Counter(static_cast<double>(body.points.size()) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
}

/// Forces in a state a little compressed, so that what has no bond touches. With `moving`, points have moved
/// beyond the list each time, and it is made anew.
void contact_force(benchmark::State& state) {
  omp_set_num_threads(1);
  const Body body = body_of(state.range(0), state.range(1) != 0);
  const bool moving = state.range(2) != 0;
  SelfContact contact(body, {bench::kSpacing, 1});
  std::vector<double> u(static_cast<std::size_t>(body.dimension) * body.size(), 0.0), force(u);
  for (const std::size_t i : body.points) u[i] = -0.01 * body.position(i)[0];
  contact.add_force(u, force);
  for (auto _ : state) {
    if (moving)
      for (const std::size_t i : body.points) u[body.size() + i] += 0.2 * bench::kSpacing;
    contact.add_force(u, force);
    benchmark::DoNotOptimize(force.data());
  }
  tell_rate(state, body, contact);
}

void model_force(benchmark::State& state) {
  omp_set_num_threads(1);
  Pmb model(body_of(state.range(0), false), PmbSettings{.youngs_modulus = 72e9, .density = 2440});
  model.set_limits(FailureLimits::uniform(0.001));
  std::vector<double> u(model.dofs(), 0.0), force(u);
  for (auto _ : state) {
    benchmark::DoNotOptimize(model.internal_force(u, force));
    benchmark::DoNotOptimize(model.advance(u, force));
  }
  state.counters["points/cpu_s"] =
      benchmark::Counter(static_cast<double>(model.points()) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
}

BENCHMARK(contact_force)
    ->ArgNames({"dimension", "crushed", "moving"})
    ->ArgsProduct({{2, 3}, {0, 1}, {0, 1}})
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(model_force)
    ->ArgName("dimension")
    ->Arg(2)
    ->Arg(3)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
