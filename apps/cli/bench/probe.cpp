// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/probe.h"

#include <algorithm>
#include <chrono>

#include "cli/bench/scene.h"
#include "cli/long_task.h"
#include "contrejour/expert/machine_speed.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kPreparationSize = "64x36";

Result<double> prepare_ms(const PaperSystem& system, params::Values values, const Context& context) {
  if (const auto ok = values.set("size", kPreparationSize); !ok) return tl::unexpected(ok.error());
  const auto start = std::chrono::steady_clock::now();
  const auto scene = bench_scene(system, 1, {}, values);
  if (!scene) return tl::unexpected(scene.error());
  const auto flare = render(params::adaptive_options(values), scene->lens, scene->lights, scene->settings, context);
  if (!flare) return tl::unexpected(flare.error());
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

Result<std::uint64_t> peak_memory_bytes(const PaperSystem& system, const params::Values& values,
                                        const Context& context) {
  const auto scene = bench_scene(system, 2, {}, values);
  if (!scene) return tl::unexpected(scene.error());
  const auto flare = render(params::adaptive_options(values), scene->lens, scene->lights, scene->settings, context);
  if (!flare) return tl::unexpected(flare.error());
  return flare->statistics.peak_memory_bytes;
}

// Errors: Cancelled.
Result<void> probe_speed(const params::Values& values, const Context& context, BenchProbe& probe) {
  const auto scene = bench_scene(*probe.system, 1, {}, values);
  if (!scene) return tl::unexpected(scene.error());
  const Frame& frame = scene->settings.frame;
  probe.peak_hits_per_ms = peak_hits_per_ms(scene->lens, context);
  probe.frame_pass_ms = frame_pass_ms(frame.width, frame.height, context);
  if (context.cancelled()) return failure(ErrorCode::Cancelled, "interrupted");
  return {};
}

}  // namespace

Result<void> probe(const std::vector<const PaperSystem*>& systems, const params::Values& values, int threads,
                   BenchRows& rows) {
  const LongTask task("probes", threads);
  std::vector<BenchProbe> probes;
  for (const PaperSystem* system : systems) {
    const auto ms = prepare_ms(*system, values, task.context());
    if (!ms) return tl::unexpected(ms.error());
    probes.push_back({.system = system, .prepare_ms = *ms});
  }
  if (!probes.empty()) {
    const auto bytes = peak_memory_bytes(*systems.back(), values, task.context());
    if (!bytes) return tl::unexpected(bytes.error());
    probes.back().peak_memory_bytes = *bytes;
  }
  for (BenchProbe& probe : probes) {
    if (const auto ok = probe_speed(values, task.context(), probe); !ok) return tl::unexpected(ok.error());
    rows.add(probe);
  }
  return {};
}

}  // namespace contrejour::cli
