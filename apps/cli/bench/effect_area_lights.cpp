// SPDX-License-Identifier: Apache-2.0
// Extended lights compared with points: the sun in place of a point, in the same run.
#include <utility>

#include "cli/bench/effects.h"

namespace contrejour::cli {
namespace {

constexpr double kAreaLightsMust = 2.0, kAreaLightsAim = 1.5;

// In addition to the scene's own lens.
constexpr EffectSystem kAreaLightsSystems[] = {
    {"heliar", 0.0, 16.0}, {"itoh-zoom", 123.0, 32.0}, {"nikon-80-200", 140.0, 16.0}};

Result<Target> row(const EffectScene& scene) {
  const Light& point = scene.lights.front();
  Light sun = point;
  sun.radius_rad = kSunRadius_rad;
  const auto cost = cost_in_turns(scene, {scene.render, {point}}, {scene.render, {sun}});
  if (!cost) return tl::unexpected(cost.error());
  return Target{.name = "the sun / a point",
                .system = scene.lens.name,
                .value = cost->ratio(),
                .must = kAreaLightsMust,
                .aim = kAreaLightsAim,
                .note = cost_text(scene, *cost)};
}

}  // namespace

Result<std::vector<Target>> measure_area_lights(const EffectScene& scene) {
  std::vector<Target> rows;
  auto own = row(scene);
  if (!own) return tl::unexpected(own.error());
  rows.push_back(std::move(*own));
  for (const EffectSystem& system : kAreaLightsSystems) {
    const auto other = with_lens(scene, system);
    if (!other) return tl::unexpected(other.error());
    auto one = row(*other);
    if (!one) return tl::unexpected(one.error());
    rows.push_back(std::move(*one));
  }
  return rows;
}

}  // namespace contrejour::cli
