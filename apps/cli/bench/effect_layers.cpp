// SPDX-License-Identifier: Apache-2.0
// The cost of a frame in layers compared with the same frame as one picture.
#include <utility>

#include <fmt/format.h>

#include "cli/bench/effects.h"

namespace contrejour::cli {
namespace {

constexpr double kLayersMust = 1.5, kLayersAim = 1.2;
constexpr EffectSystem kLayeredSystems[] = {{"heliar", 0.0, 8.0}, {"canon-70-200", 135.0, 8.0}};

struct LayersCase {
  const char* name;
  LayersBy by;
};
constexpr LayersCase kLayersCases[] = {{"layers by ten ghosts / one picture", LayersBy::Ghost},
                                       {"layers by surface / one picture", LayersBy::Surface}};

}  // namespace

Result<std::vector<Target>> measure_layers(const EffectScene& scene) {
  std::vector<Target> rows;
  for (const EffectSystem& system : kLayeredSystems) {
    auto layered = with_lens(scene, system);
    if (!layered) return tl::unexpected(layered.error());
    for (const auto& [name, by] : kLayersCases) {
      const LayerOptions options{.by = by};
      const EffectRender whole{layered->render, layered->lights}, parts{layered->render, layered->lights, &options};
      const auto cost = cost_in_turns(*layered, whole, parts);
      if (!cost) return tl::unexpected(cost.error());
      rows.push_back({.name = name,
                      .system = layered->lens.name,
                      .value = cost->ratio(),
                      .must = kLayersMust,
                      .aim = kLayersAim,
                      .note = cost_text(*layered, *cost)});
    }
  }
  return rows;
}

}  // namespace contrejour::cli
