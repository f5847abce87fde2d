// SPDX-License-Identifier: Apache-2.0
#include "requests/layered_mean.h"

#include <algorithm>
#include <utility>

namespace contrejour::inline internal {
namespace {

// The layer in a larger rectangle, dark where it had no pixels.
void grow(FlareLayer& layer, int left, int top, int right, int bottom) {
  Image image(right - left, bottom - top);
  for (int y = 0; y < layer.image.height; ++y)
    std::ranges::copy(layer.image.row(y), &image.at(layer.left - left, layer.top - top + y));
  layer.image = std::move(image);
  layer.left = left;
  layer.top = top;
}

void grow_to_hold(FlareLayer& layer, const FlareLayer& other) {
  const int right = other.left + other.image.width, bottom = other.top + other.image.height;
  if (layer.image.pixels.empty()) {
    layer.left = other.left, layer.top = other.top;
    layer.image = Image(other.image.width, other.image.height);
    return;
  }
  const int own_right = layer.left + layer.image.width, own_bottom = layer.top + layer.image.height;
  if (layer.left <= other.left && layer.top <= other.top && right <= own_right && bottom <= own_bottom) return;
  grow(layer, std::min(layer.left, other.left), std::min(layer.top, other.top), std::max(right, own_right),
       std::max(bottom, own_bottom));
}

void add_weighted(FlareLayer& to, const FlareLayer& from, float weight) {
  if (from.image.pixels.empty()) return;
  grow_to_hold(to, from);
  for (int y = 0; y < from.image.height; ++y) {
    const auto source = from.image.row(y);
    float* const target = &to.image.at(from.left - to.left, from.top - to.top + y);
    for (std::size_t k = 0; k < source.size(); ++k) target[k] += weight * source[k];
  }
}

FlareLayer& layer_named(std::vector<FlareLayer>& layers, const std::string& name) {
  const auto found = std::ranges::find(layers, name, &FlareLayer::name);
  return found != layers.end() ? *found : layers.emplace_back(FlareLayer{name, {}, 0, 0});
}

}  // namespace

void add_weighted(LayeredFlare& to, const LayeredFlare& from, double weight) {
  const auto factor = static_cast<float>(weight);
  if (to.image.pixels.empty()) to.image = Image(from.image.width, from.image.height);
  for (std::size_t k = 0; k < from.image.pixels.size(); ++k) to.image.pixels[k] += factor * from.image.pixels[k];
  for (const FlareLayer& layer : from.layers) add_weighted(layer_named(to.layers, layer.name), layer, factor);
}

void scale(LayeredFlare& flare, double factor) {
  const auto by = static_cast<float>(factor);
  for (float& sample : flare.image.pixels) sample *= by;
  for (FlareLayer& layer : flare.layers)
    for (float& sample : layer.image.pixels) sample *= by;
}

void add_statistics(RenderStatistics& to, const RenderStatistics& from) {
  if (to.method.empty()) {
    to = from;
    return;
  }
  for (const auto& [phase, time] : from.time_ms) {
    const auto same = std::ranges::find(to.time_ms, phase, &std::pair<std::string, double>::first);
    if (same != to.time_ms.end())
      same->second += time;
    else
      to.time_ms.insert(to.time_ms.begin(), {phase, time});  // "total" stays last
  }
  to.rays += from.rays;
  to.surface_hits += from.surface_hits;
  to.primitives += from.primitives;
  to.primitives_merged += from.primitives_merged;
  to.tile_indices += from.tile_indices;
  to.ghosts_rendered = std::max(to.ghosts_rendered, from.ghosts_rendered);
  to.peak_memory_bytes = std::max(to.peak_memory_bytes, from.peak_memory_bytes);
  to.primitive_bytes = std::max(to.primitive_bytes, from.primitive_bytes);
  to.tile_list_bytes = std::max(to.tile_list_bytes, from.tile_list_bytes);
}

}  // namespace contrejour::inline internal
