// SPDX-License-Identifier: Apache-2.0
// Playback of a measured flare of 100 ghosts at 1920 x 1080: the target is 33 ms on two cores, the aim 8 ms.
#include <random>

#include <benchmark/benchmark.h>

#include "contrejour/expert/measured_flare.h"

namespace {

using namespace contrejour;

// Ghosts of 30 to 300 pixels' radius with soft borders, spread over the picture.
MeasuredFlare hundred_ghosts() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  MeasuredFlare flare{"bench", "", 0.6, std::nullopt, {}};
  for (int k = 0; k < 100; ++k) {
    MeasuredGhost ghost;
    const double radius = 0.02 * std::pow(10.0, unit(random));
    ghost.centre.coefficients = {3.0 * unit(random) - 1.5};
    ghost.half_width.coefficients = {radius * (0.7 + 0.3 * unit(random))};
    ghost.half_height.coefficients = {radius};
    ghost.width_in.coefficients = {0.15 * radius};
    ghost.width_out.coefficients = {0.025 * radius};
    for (std::size_t c = 0; c < 3; ++c) {
      ghost.border[c].coefficients = {1.0};
      ghost.inside[c].coefficients = {0.5};
    }
    ghost.last = 0.6;
    flare.ghosts.push_back(ghost);
  }
  return flare;
}

void BM_RenderMeasured(benchmark::State& state) {
  const MeasuredFlare flare = hundred_ghosts();
  const FlareLight light{{0.3, 0.1}, {1e4, 1e4, 1e4}};
  const TangentFrame frame{1920, 1080, 1500.0, {960.0, 540.0}};
  for (auto _ : state) {
    benchmark::DoNotOptimize(render_measured(flare, std::span(&light, 1), frame));
  }
}
BENCHMARK(BM_RenderMeasured)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
