// Rates of the correspondence model in small vibrations: a cube of 40^3 points with 7 153 608 directed bonds,
// and a plate in plane stress of 506^2 points with as many to 0.1 %.

#include "peridynamics/correspondence.hpp"
#include "body/listed_body.hpp"
#include "vibration.hpp"

namespace {

using namespace riven;

/// A foam whose waves are as fast as those of glass, so that the step of `vibrate` suits it too.
CorrespondenceSettings settings(bool linear) {
  const ElasticModuli glass{.youngs_modulus = 72e9, .poissons_ratio = 0.22};
  CorrespondenceSettings settings{.material = {"glass", LinearElastic{glass}, 2440}, .plane = Plane::strain};
  if (!linear) settings.material.law = CompressibleNeoHookean{glass};
  return settings;
}

void correspondence_step(benchmark::State& state) {
  if (!bench::prepare(state, state.range(1), state.range(2))) return;
  const int dimension = static_cast<int>(state.range(3));
  const Body box = bench::block(dimension, dimension == 3 ? 40 : 506);
  Correspondence model(state.range(0) != 0 ? listed(box) : box, settings(state.range(4) != 0));
  bench::vibrate(state, model);
}

BENCHMARK(correspondence_step)
    ->ArgNames({"listed", "threads", "isa", "dimension", "linear"})
    ->ArgsProduct({{0, 1}, {1, 2}, {0, 1, 2}, {3, 2}, {0, 1}})
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
