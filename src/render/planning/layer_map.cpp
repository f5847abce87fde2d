// SPDX-License-Identifier: Apache-2.0
#include "render/planning/layer_map.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "contrejour/expert/ghost.h"

namespace contrejour::inline internal {
namespace {

double brightness(const Light& light) {
  return std::max({std::abs(light.value[0]), std::abs(light.value[1]), std::abs(light.value[2])});
}

// Indices in the order of falling values, ties in their own order.
template <class Value>
std::vector<std::size_t> by_falling(std::size_t count, const Value& value) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), value);
  return order;
}

}  // namespace

std::string unique_layer_name(const std::string& name, std::set<std::string>& taken) {
  std::string unique = name;
  for (int k = 2; !taken.insert(unique).second; ++k) unique = fmt::format("{}_{}", name, k);
  return unique;
}

LayerMap::LayerMap(const LayerOptions& options, std::span<const Ghost> ghosts, std::span<const double> flux_fractions,
                   std::span<const Light> lights) {
  switch (options.by) {
    case LayersBy::Part: names_ = {"ghosts"}; break;
    case LayersBy::Ghost: add_ghosts(own_layers(options, ghosts, flux_fractions)); break;
    case LayersBy::Surface: add_surfaces(ghosts); break;
    case LayersBy::Light: add_lights(options.light_names, lights); break;
  }
}

void LayerMap::add_ghosts(std::span<const Ghost> ghosts) {
  for (const Ghost& ghost : ghosts) {
    if (!by_ghost_.emplace(ghost, names_.size()).second) continue;
    ghosts_.push_back(ghost);
    names_.push_back(layer_name(ghost));
  }
  names_.emplace_back(kRestLayer);
}

void LayerMap::add_surfaces(std::span<const Ghost> ghosts) {
  std::set<int> surfaces;
  for (const Ghost& ghost : ghosts) surfaces.insert(ghost.j);
  for (const Ghost& ghost : ghosts)
    by_ghost_.emplace(ghost, static_cast<std::size_t>(std::distance(surfaces.begin(), surfaces.find(ghost.j))));
  for (const int surface : surfaces) names_.push_back(fmt::format("surface_{}", surface));
}

void LayerMap::add_lights(std::span<const std::string> names, std::span<const Light> lights) {
  const auto order = by_falling(lights.size(), [&](std::size_t k) { return brightness(lights[k]); });
  std::vector<bool> is_own(lights.size(), false);
  for (std::size_t k = 0; k < std::min(lights.size(), kMaxLightLayers); ++k) is_own[order[k]] = true;
  std::set<std::string> taken{kRestLayer};
  is_by_light_ = true;
  by_light_.assign(lights.size(), 0);
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const bool is_named = k < names.size() && !names[k].empty();
    const std::string name = is_named ? layer_name(names[k]) : fmt::format("light{}", k + 1);
    if (!is_own[k]) continue;
    by_light_[k] = names_.size();
    names_.push_back(unique_layer_name(name, taken));
  }
  if (lights.size() <= kMaxLightLayers) return;
  for (std::size_t k = 0; k < lights.size(); ++k)
    if (!is_own[k]) by_light_[k] = names_.size();
  names_.emplace_back(kRestLayer);
}

std::size_t LayerMap::of(const Ghost& ghost, std::size_t light) const {
  if (is_by_light_) return by_light_[light];
  const auto found = by_ghost_.find(ghost);
  return found != by_ghost_.end() ? found->second : names_.size() - 1;
}

Result<void> check_layers(const LayerOptions& options) {
  if (options.ghost_count < 0)
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("{} layers of ghosts is out of range; choose 0 or more", options.ghost_count));
  if (!(options.min_percent >= 0.0 && options.min_percent <= 100.0))
    return failure(
        ErrorCode::InvalidArgument,
        fmt::format("a layer's least flux of {} per cent is out of range; choose 0 to 100", options.min_percent));
  return {};
}

Result<void> check_layers(const LensState& lens, const LayerOptions& options) {
  if (auto good = check_layers(options); !good) return good;
  for (const Ghost& ghost : options.ghosts)
    if (!has_ghost(lens, ghost))
      return failure(ErrorCode::InvalidArgument,
                     fmt::format("there is no ghost {} in this lens to make a layer of; `contrejour ghosts` lists "
                                 "those there are",
                                 ghost_name(ghost)));
  return {};
}

bool needs_flux(const LayerOptions& options) { return options.by == LayersBy::Ghost && options.ghosts.empty(); }

std::vector<Ghost> own_layers(const LayerOptions& options, std::span<const Ghost> ghosts,
                              std::span<const double> flux_fractions) {
  if (!options.ghosts.empty()) return options.ghosts;
  std::vector<Ghost> own;
  for (const std::size_t k : by_falling(ghosts.size(), [&](std::size_t k) { return flux_fractions[k]; })) {
    if (own.size() == static_cast<std::size_t>(options.ghost_count)) break;
    if (100.0 * flux_fractions[k] >= options.min_percent) own.push_back(ghosts[k]);
  }
  return own;
}

}  // namespace contrejour::inline internal

namespace contrejour {

std::string layer_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool is_allowed = std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<unsigned char>(c) < 0x80;
    name += is_allowed ? c : '_';
  }
  const bool begins_badly = name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0;
  return begins_badly ? "_" + name : name;
}

// The orders of a grating may be negative: "7-12@1,-2" becomes "ghost_7_12_1_m2".
std::string layer_name(const Ghost& ghost) {
  const auto number = [](int value) { return value < 0 ? fmt::format("m{}", -value) : fmt::format("{}", value); };
  std::string name = fmt::format("ghost_{}_{}", ghost.i, ghost.j);
  if (ghost.reflects_four_times()) name += fmt::format("_{}_{}", ghost.k, ghost.l);
  if (ghost.order != std::array<int, 2>{0, 0})
    name += fmt::format("_{}_{}", number(ghost.order[0]), number(ghost.order[1]));
  return name;
}

}  // namespace contrejour
