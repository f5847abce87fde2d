// Packets of rays along the Canon's longest ghost, one instruction set after the other, the scalar one included;
// items are surfaces hit. Beside bench_trace.cpp: the same rays one at a time in double.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include "contrejour/ghost.h"
#include "optics/trace/packet_trace.h"

namespace {

using namespace contrejour;

constexpr int kSide = 64;  // rays over a square of the entrance plane
constexpr double kWidth_mm = 4.0;

struct Rays {
  std::vector<float> x_mm, y_mm;
  std::vector<std::vector<float>> results = std::vector<std::vector<float>>(10, std::vector<float>(kSide* kSide));

  Rays() {
    for (int k = 0; k < kSide * kSide; ++k) {
      x_mm.push_back(static_cast<float>(kWidth_mm * (k % kSide) / kSide));
      y_mm.push_back(static_cast<float>(kWidth_mm * (k / kSide) / kSide));
    }
  }

  [[nodiscard]] TracedArrays arrays() {
    const auto at = [&](std::size_t k) { return results[k].data(); };
    return {at(0), at(1), at(2), at(3), {at(4), at(5), at(6)}, {at(7), at(8), at(9)}, nullptr, 0};
  }
};

void trace_packets_of(benchmark::State& state, std::int64_t target, PacketPrecision precision) {
  const Result<Prescription> prescription = find_lens("canon-70-200");
  if (!prescription) return state.SkipWithError("this lens does not load");
  const Result<LensState> lens = lens_at(*prescription);
  if (!lens) return state.SkipWithError("this lens cannot be set");
  const auto ghosts = enumerate_ghosts(*lens, GhostScope::OneSideOfStop);
  const Ghost longest =
      *std::max_element(ghosts.begin(), ghosts.end(), [](Ghost a, Ghost b) { return a.j - a.i < b.j - b.i; });
  const ReflectanceTables tables(*lens, 550.0);
  const Vec3 direction = normalized({-0.05, -0.03, 1.0});
  const PacketPath path(ghost_path(*lens, longest, 550.0), tables,
                        {{-0.5 * kWidth_mm, -0.5 * kWidth_mm, entrance_window(*lens, direction).z_mm}, direction});
  Rays rays;
  hwy::SetSupportedTargetsForTest(target);
  for (auto _ : state) {
    trace_packets(path, precision, rays.x_mm.data(), rays.y_mm.data(), rays.x_mm.size(), rays.arrays());
    benchmark::ClobberMemory();
  }
  hwy::SetSupportedTargetsForTest(0);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rays.x_mm.size() * path.steps().size()));
}

// One benchmark an instruction set that this machine has.
const bool kRegistered = [] {
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    for (const PacketPrecision precision : {PacketPrecision::Float, PacketPrecision::Double}) {
      const std::string name = std::string("trace_packets/") + hwy::TargetName(target) +
                               (precision == PacketPrecision::Float ? "/float" : "/double");
      benchmark::RegisterBenchmark(name.c_str(), trace_packets_of, static_cast<std::int64_t>(target), precision);
    }
  }
  return true;
}();

}  // namespace
