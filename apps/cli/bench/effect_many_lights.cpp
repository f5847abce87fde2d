// SPDX-License-Identifier: Apache-2.0
// The cost of each of many lights compared with a single light, in a small frame, where only the number of lights
// matters.
#include <utility>

#include <fmt/format.h>

#include "cli/bench/effects.h"
#include "cli/bench/r2_sequence.h"
#include "contrejour/expert/trace.h"

namespace contrejour::cli {
namespace {

constexpr double kManyLightsMust = 1.0, kManyLightsAim = 0.5;
constexpr int kManyLightsWidth = 64, kManyLightsHeight = 36;
constexpr EffectSystem kManyLightsSystem{"heliar", 0.0, 8.0};

}  // namespace

Result<std::vector<Target>> measure_many_lights(const EffectScene& scene) {
  auto small = with_lens(scene, kManyLightsSystem);
  if (!small) return tl::unexpected(small.error());
  small->render.frame = frame_on_sensor(small->lens, kManyLightsWidth, kManyLightsHeight);
  std::vector<Target> rows;
  for (const int count : {10, 100, 1000}) {
    std::vector<Light> lights(static_cast<std::size_t>(count), small->lights.front());
    for (std::size_t k = 0; k < lights.size(); ++k) {
      lights[k].direction = direction_for_image_point(small->lens, small->render.frame.sensor_from_uv(r2_point(k)),
                                                      small->lens.design_wavelength_nm);
    }
    const auto cost = cost_in_turns(*small, {small->render, {lights.front()}}, {small->render, lights});
    if (!cost) return tl::unexpected(cost.error());
    rows.push_back({.name = "a light of many / one alone",
                    .system = small->lens.name,
                    .lights = count,
                    .value = cost->ratio() / count,
                    .must = kManyLightsMust,
                    .aim = kManyLightsAim,
                    .note = fmt::format("{} x {}, {}", kManyLightsWidth, kManyLightsHeight, cost_text(*small, *cost))});
  }
  return rows;
}

}  // namespace contrejour::cli
