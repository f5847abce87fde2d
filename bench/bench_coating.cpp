// SPDX-License-Identifier: Apache-2.0
// Reflectance of a coated surface: evaluated at every reflection and refraction of every ray.
#include <benchmark/benchmark.h>

#include "contrejour/expert/coating.h"

namespace {

using namespace contrejour;

Coating stack_of(int films) {
  FilmStack stack;
  for (int i = 0; i < films; ++i) stack.layers.push_back({i % 2 == 0 ? 1.38 : 2.1, 90.0});
  return {"", stack};
}

void run(benchmark::State& state, const Coating& coating) {
  double cos_in = 1.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(reflectance(coating, 1.0, 1.62, cos_in, 550.0));
    cos_in = cos_in > 0.3 ? cos_in - 0.01 : 1.0;
  }
  state.SetItemsProcessed(state.iterations());
}

void reflectance_bare(benchmark::State& state) { run(state, {"", Bare{}}); }
void reflectance_quarter_wave(benchmark::State& state) { run(state, {"", QuarterWave{}}); }
void reflectance_stack(benchmark::State& state) { run(state, stack_of(static_cast<int>(state.range(0)))); }

BENCHMARK(reflectance_bare);
BENCHMARK(reflectance_quarter_wave);
BENCHMARK(reflectance_stack)->Arg(1)->Arg(3)->Arg(7);

}  // namespace
