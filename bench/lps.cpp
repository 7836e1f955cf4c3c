// Rates of the linear peridynamic solid in small vibrations: a cube of 40^3 points with 7 153 608 directed
// bonds, and a plate in plane stress of 506^2 points with as many to 0.1 %.

#include "peridynamics/lps.hpp"
#include "body/listed_body.hpp"
#include "vibration.hpp"

namespace {

using namespace riven;

constexpr LpsSettings kMaterial{.youngs_modulus = 72e9, .poissons_ratio = 0.22, .density = 2440};

void lps_step(benchmark::State& state) {
  if (!bench::prepare(state, state.range(1), state.range(2))) return;
  const int dimension = static_cast<int>(state.range(3));
  const Body box = bench::block(dimension, dimension == 3 ? 40 : 506);
  Lps model(state.range(0) != 0 ? listed(box) : box, kMaterial);
  bench::vibrate(state, model);
}

BENCHMARK(lps_step)
    ->ArgNames({"listed", "threads", "isa", "dimension"})
    ->ArgsProduct({{0, 1}, {1, 2}, {0, 1, 2}, {3, 2}})
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
