// SPDX-License-Identifier: Apache-2.0
// Packets of rays along the longest ghost of three lenses, on each instruction set including the scalar one; items are
// surfaces hit. bench_trace.cpp traces the same rays one at a time in double.
#include <cstdint>
#include <string>

#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include "packet_scene.h"

namespace {

using namespace contrejour;

void trace_packets_of(benchmark::State& state, const char* lens, std::int64_t target, PacketPrecision precision) {
  auto scene = bench::packet_scene(lens);
  if (!scene) return state.SkipWithError("this lens does not load");
  hwy::SetSupportedTargetsForTest(target);
  for (auto _ : state) {
    trace_packets(*scene->packets, precision, scene->x_mm.data(), scene->y_mm.data(), scene->rays(), scene->arrays());
    benchmark::ClobberMemory();
  }
  hwy::SetSupportedTargetsForTest(0);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene->rays() * scene->path.steps.size()));
}

// The same rays one by one: the scalar reference.
void trace_scalar_of(benchmark::State& state, const char* lens) {
  const auto scene = bench::packet_scene(lens);
  if (!scene) return state.SkipWithError("this lens does not load");
  const PacketStart& rays = scene->packets->start();
  for (auto _ : state) {
    for (std::size_t k = 0; k < scene->rays(); ++k) {
      const Vec3 origin_mm = rays.origin_mm + Vec3{scene->x_mm[k], scene->y_mm[k], 0.0};
      benchmark::DoNotOptimize(trace(scene->path, {origin_mm, rays.direction}));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene->rays() * scene->path.steps.size()));
}

// One benchmark for each instruction set of this machine.
const bool kRegistered = [] {
  for (const char* lens : bench::kLenses) {
    const std::string end = std::string("/") + lens;
    benchmark::RegisterBenchmark(("trace/one_by_one/double" + end).c_str(), trace_scalar_of, lens);
    for (const auto target : hwy::SupportedAndGeneratedTargets()) {
      for (const PacketPrecision precision : {PacketPrecision::Float, PacketPrecision::Double}) {
        const std::string name = std::string("trace_packets/") + hwy::TargetName(target) +
                                 (precision == PacketPrecision::Float ? "/float" : "/double") + end;
        benchmark::RegisterBenchmark(name.c_str(), trace_packets_of, lens, static_cast<std::int64_t>(target),
                                     precision);
      }
    }
  }
  return true;
}();

}  // namespace
