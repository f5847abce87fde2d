// SPDX-License-Identifier: Apache-2.0
// Double-precision tracing of one ray along the direct path and along a ghost's; items are surfaces hit.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "contrejour/expert/ghost.h"
#include "contrejour/expert/trace.h"
#include "contrejour/lens.h"

namespace {

using namespace contrejour;

LensState bundled(benchmark::State& state, const char* name) {
  const Result<Prescription> prescription = find_lens(name);
  if (prescription) {
    if (const Result<LensState> lens = configure_lens(*prescription)) return *lens;
  }
  state.SkipWithError("this lens does not load");
  return {};
}

// Rays spread over the entrance window, so that branches are as mixed as in a picture.
std::vector<Ray> rays_over(const EntranceWindow& window, Vec3 direction) {
  constexpr int kSide = 16;
  std::vector<Ray> rays;
  for (int k = 0; k < kSide * kSide; ++k) {
    const int column = k % kSide;
    const int row = k / kSide;
    const double u = (column + 0.5) / kSide;
    const double v = (row + 0.5) / kSide;
    rays.push_back({{window.min_mm.x + u * (window.max_mm.x - window.min_mm.x),
                     window.min_mm.y + v * (window.max_mm.y - window.min_mm.y), window.z_mm},
                    direction});
  }
  return rays;
}

void run(benchmark::State& state, const LensState& lens, const OpticalPath& path) {
  const Vec3 direction = normalized({-0.05, -0.03, 1.0});
  const std::vector<Ray> rays = rays_over(entrance_window(lens, direction), direction);
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(trace(path, rays[next]));
    next = (next + 1) % rays.size();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(path.steps.size()));
}

void trace_direct(benchmark::State& state, const char* name) {
  const LensState lens = bundled(state, name);
  if (!lens.surfaces.empty()) run(state, lens, direct_path(lens, 550.0));
}

void trace_longest_ghost(benchmark::State& state, const char* name) {
  const LensState lens = bundled(state, name);
  if (lens.surfaces.empty()) return;
  const std::vector<Ghost> ghosts = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
  const Ghost longest =
      *std::max_element(ghosts.begin(), ghosts.end(), [](Ghost a, Ghost b) { return a.j - a.i < b.j - b.i; });
  run(state, lens, ghost_path(lens, longest, 550.0));
}

BENCHMARK_CAPTURE(trace_direct, heliar, "heliar");
BENCHMARK_CAPTURE(trace_direct, canon, "canon-70-200");
BENCHMARK_CAPTURE(trace_longest_ghost, heliar, "heliar");
BENCHMARK_CAPTURE(trace_longest_ghost, canon, "canon-70-200");

}  // namespace
