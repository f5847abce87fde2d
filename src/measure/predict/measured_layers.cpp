// SPDX-License-Identifier: Apache-2.0
// Layers of a measured flare: its pictures of some lights, or of some of its ghosts.
#include <algorithm>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "contrejour/expert/flare_source.h"
#include "render/planning/layer_map.h"

namespace contrejour {
namespace {

// A layer to be drawn: a flare with some of the ghosts, and some of the lights.
struct MeasuredLayer {
  std::string name;
  MeasuredFlare flare;
  std::vector<Light> lights;
};

MeasuredFlare with_ghosts(const MeasuredFlare& flare, std::vector<MeasuredGhost> ghosts) {
  MeasuredFlare some = flare;
  some.ghosts = std::move(ghosts);
  return some;
}

std::vector<MeasuredLayer> layers_by_light(const MeasuredFlare& flare, std::span<const Light> lights,
                                           const LayerOptions& options) {
  const LayerMap map(options, {}, {}, lights);
  std::vector<MeasuredLayer> layers;
  for (const std::string& name : map.names()) layers.push_back({name, flare, {}});
  for (std::size_t k = 0; k < lights.size(); ++k) layers[map.of_light(k)].lights.push_back(lights[k]);
  return layers;
}

// The sum of all samples of each ghost's picture by itself.
Result<std::vector<double>> fluxes_of_ghosts(const MeasuredFlare& flare, std::span<const Light> lights,
                                             const Frame& frame, const Context& context) {
  std::vector<double> flux;
  for (const MeasuredGhost& ghost : flare.ghosts) {
    const auto drawn = render(with_ghosts(flare, {ghost}), lights, frame, context);
    if (!drawn) return tl::unexpected(drawn.error());
    flux.push_back(std::accumulate(drawn->image.pixels.begin(), drawn->image.pixels.end(), 0.0));
  }
  return flux;
}

// The brightest ghosts, and the rest.
Result<std::vector<MeasuredLayer>> layers_by_ghost(const MeasuredFlare& flare, std::span<const Light> lights,
                                                   const Frame& frame, const LayerOptions& options,
                                                   const Context& context) {
  const auto flux = fluxes_of_ghosts(flare, lights, frame, context);
  if (!flux) return tl::unexpected(flux.error());
  const double least = 0.01 * options.min_percent * std::accumulate(flux->begin(), flux->end(), 0.0);
  std::vector<std::size_t> order(flux->size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t k) { return (*flux)[k]; });
  const std::vector<Light> all(lights.begin(), lights.end());
  std::vector<MeasuredLayer> layers;
  std::set<std::string> taken{kRestLayer};
  std::vector<MeasuredGhost> rest;
  for (const std::size_t k : order) {
    const MeasuredGhost& ghost = flare.ghosts[k];
    if (layers.size() == static_cast<std::size_t>(options.ghost_count) || (*flux)[k] < least) {
      rest.push_back(ghost);
    } else {
      layers.push_back({unique_layer_name(layer_name(ghost.name), taken), with_ghosts(flare, {ghost}), all});
    }
  }
  layers.push_back({kRestLayer, with_ghosts(flare, std::move(rest)), all});
  return layers;
}

Result<std::vector<MeasuredLayer>> layers_of(const MeasuredFlare& flare, std::span<const Light> lights,
                                             const Frame& frame, const LayerOptions& options, const Context& context) {
  if (options.by == LayersBy::Surface || !options.ghosts.empty())
    return invalid_argument(
        "a measured flare's ghosts belong to no surfaces; give layers by light, by part, or by its brightest ghosts");
  if (options.by == LayersBy::Light) return layers_by_light(flare, lights, options);
  if (options.by == LayersBy::Ghost) return layers_by_ghost(flare, lights, frame, options, context);
  return std::vector<MeasuredLayer>{{"ghosts", flare, std::vector<Light>(lights.begin(), lights.end())}};
}

}  // namespace

Result<LayeredFlare> render_layers(const MeasuredFlare& flare, std::span<const Light> lights, const Frame& frame,
                                   const LayerOptions& options, const Context& context) {
  const auto start = Clock::now();
  if (auto good = check_layers(options); !good) return tl::unexpected(good.error());
  const auto layers = layers_of(flare, lights, frame, options, context);
  if (!layers) return tl::unexpected(layers.error());
  LayeredFlare sum{Image(frame.width, frame.height), {}, {}};
  for (const MeasuredLayer& layer : *layers) {
    auto drawn = render(layer.flare, layer.lights, frame, context);
    if (!drawn) return tl::unexpected(drawn.error());
    for (std::size_t k = 0; k < sum.image.pixels.size(); ++k) sum.image.pixels[k] += drawn->image.pixels[k];
    sum.layers.push_back({layer.name, std::move(drawn->image), 0, 0});
  }
  sum.statistics.method = "measured";
  sum.statistics.time_ms = {{"draw", ms_since(start)}, {"total", ms_since(start)}};
  sum.statistics.ghosts_rendered = static_cast<int>(flare.ghosts.size());
  return sum;
}

}  // namespace contrejour
