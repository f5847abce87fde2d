// SPDX-License-Identifier: Apache-2.0
// The parts of tracing a packet, on each instruction set: the geometry without any look-up of reflectances, and the
// look-ups alone. Items are surfaces hit, or look-ups; float.
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/simd_targets.h"  // before Highway

#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include "packet_scene.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench_packet_parts.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "optics/surface/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::bench::HWY_NAMESPACE {

namespace hk = kernels::HWY_NAMESPACE;
namespace hn = hwy::HWY_NAMESPACE;
using P = hk::Packet<float>;

// The tracer's geometry without R, T and rims.
void geometry(const PacketPath& path, const float* x_mm, const float* y_mm, std::size_t count, float* out) {
  const PacketStart& rays = path.start();
  const P::Tag tag;
  for (std::size_t at = 0; at + hn::Lanes(tag) <= count; at += hn::Lanes(tag)) {
    hk::Ray3<P> ray{P(rays.origin_mm.x) + hk::load_floats(tag, x_mm + at),
                    P(rays.origin_mm.y) + hk::load_floats(tag, y_mm + at),
                    P(0.0),
                    P(rays.direction.x),
                    P(rays.direction.y),
                    P(rays.direction.z)};
    for (const PacketStep& step : path.steps()) {
      const P direction(step.direction);
      const auto hit = hk::intersect(ray, P(step.gap_mm), P(step.curvature_per_mm), direction);
      hk::move_to(ray, hit, P(0.0));
      if (step.event == PathEvent::Reflect) hk::reflect(ray, hit, direction);
      if (step.event == PathEvent::Refract) hk::refract(ray, hit, P(step.eta), direction);
    }
    hk::store_floats(ray.x + ray.dx, out + at);
  }
}

void look_ups(const float* table, int intervals, const float* u, std::size_t count, float* out) {
  const P::Tag tag;
  for (std::size_t at = 0; at + hn::Lanes(tag) <= count; at += hn::Lanes(tag)) {
    hk::store_floats(hk::look_up(table, intervals, hk::load_floats(tag, u + at)), out + at);
  }
}

}  // namespace contrejour::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::bench {
namespace {

HWY_EXPORT(geometry);
HWY_EXPORT(look_ups);

void geometry_of(benchmark::State& state, const char* lens, std::int64_t target) {
  auto scene = packet_scene(lens);
  if (!scene) return state.SkipWithError("this lens does not load");
  hwy::SetSupportedTargetsForTest(target);
  for (auto _ : state) {
    HWY_DYNAMIC_DISPATCH(geometry)
    (*scene->packets, scene->x_mm.data(), scene->y_mm.data(), scene->rays(), scene->results[0].data());
    benchmark::ClobberMemory();
  }
  hwy::SetSupportedTargetsForTest(0);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene->rays() * scene->path.steps.size()));
}

void look_ups_of(benchmark::State& state, std::int64_t target) {
  const auto scene = packet_scene("canon-70-200");
  if (!scene) return state.SkipWithError("this lens does not load");
  std::vector<float> u(scene->rays());
  for (std::size_t k = 0; k < u.size(); ++k) u[k] = static_cast<float>((k * 2654435761U) % 4096) / 4096.0F;
  std::vector<float> out(u.size());
  hwy::SetSupportedTargetsForTest(target);
  for (auto _ : state) {
    HWY_DYNAMIC_DISPATCH(look_ups)
    (scene->tables->values(), ReflectanceTables::kIntervals, u.data(), u.size(), out.data());
    benchmark::ClobberMemory();
  }
  hwy::SetSupportedTargetsForTest(0);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(u.size()));
}

const bool kRegistered = [] {
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    const std::string set = hwy::TargetName(target);
    for (const char* lens : kLenses) {
      benchmark::RegisterBenchmark(("geometry_only/" + set + "/float/" + lens).c_str(), geometry_of, lens,
                                   static_cast<std::int64_t>(target));
    }
    benchmark::RegisterBenchmark(("look_ups/" + set + "/float").c_str(), look_ups_of,
                                 static_cast<std::int64_t>(target));
  }
  return true;
}();

}  // namespace
}  // namespace contrejour::bench
#endif  // HWY_ONCE
