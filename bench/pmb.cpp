// Rates of the PMB model: a cube of 40^3 points with 7 153 608 directed bonds, in small vibrations that break
// nothing, with the failure test.

#include "peridynamics/pmb.hpp"
#include "body/listed_body.hpp"
#include "vibration.hpp"

namespace {

using namespace riven;

constexpr PmbSettings kMaterial{.youngs_modulus = 72e9, .density = 2440};

void pmb_step(benchmark::State& state) {
  if (!bench::prepare(state, state.range(1), state.range(2))) return;
  const Body cube = bench::block(3, static_cast<int>(state.range(3)));
  Pmb model(state.range(0) != 0 ? listed(cube) : cube, kMaterial);
  model.set_limits(FailureLimits::uniform(0.001));
  bench::vibrate(state, model);
}

BENCHMARK(pmb_step)
    ->ArgNames({"listed", "threads", "isa", "side"})
    ->ArgsProduct({{0, 1}, {1, 2}, {0, 1, 2}, {40}})
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
