// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/machine_speed.h"

#include <atomic>
#include <chrono>

#include <doctest/doctest.h>

#include "contrejour/expert/ghost.h"
#include "contrejour/expert/trace.h"

using namespace contrejour;

namespace {

LensState heliar() { return configure_lens(find_lens("heliar").value()).value(); }

// Surfaces hit per millisecond, one ray at a time, in double.
double scalar_hits_per_ms(const LensState& lens) {
  const OpticalPath path = ghost_path(lens, enumerate_ghosts(lens, GhostScope::OneSideOfStop).front(), 550.0);
  constexpr int kRays = 20000;
  double sum = 0.0;
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < kRays; ++k) sum += trace(path, {{1e-4 * k, 0.0, 0.0}, {0.0, 0.0, 1.0}}).sensor_mm.x;
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  CHECK(sum != 0.0);
  return static_cast<double>(kRays) * static_cast<double>(path.steps.size()) / took.count();
}

}  // namespace

TEST_CASE("a peak rate is above that of rays one by one") {
  const LensState lens = heliar();
  CHECK(peak_hits_per_ms(lens, {.threads = 1}) > scalar_hits_per_ms(lens));
}

TEST_CASE("a lens without ghosts and a cancelled measurement have no rate") {
  LensState lens = heliar();
  const std::atomic<bool> cancel = true;
  CHECK(peak_hits_per_ms(lens, {.threads = 1, .cancel = &cancel}) == 0.0);
  lens.surfaces = {lens.surfaces[static_cast<std::size_t>(lens.stop_index)]};
  lens.stop_index = 0;
  CHECK(peak_hits_per_ms(lens, {.threads = 1}) == 0.0);
}

TEST_CASE("a pass over a larger frame takes longer") {
  const double small_ms = frame_pass_ms(64, 36, {.threads = 1});
  CHECK(small_ms > 0.0);
  CHECK(frame_pass_ms(1920, 1080, {.threads = 1}) > small_ms);
}
