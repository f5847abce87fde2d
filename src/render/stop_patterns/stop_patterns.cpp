// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/stop_patterns.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/tasks.h"
#include "contrejour/expert/fresnel.h"
#include "contrejour/expert/iris_field.h"
#include "render/stop_patterns/resampled.h"

namespace contrejour::inline internal::stop_patterns {
namespace {

constexpr int kMaskSamples = 256;     // across the stop
constexpr int kPatternSide = 192;
constexpr double kNodesPerOctave = 32.0;  // fringes of successive steps differ by 1 per cent
constexpr double kSpreadStep = 0.002;
constexpr double kFade = 0.9;  // of the extent, beyond which a pattern fades to zero

constexpr int kFractionalSide = 512;
constexpr double kFractionalExtent = 4.0 / 3.0;  // stop radii

double fresnel_at(int node) { return std::exp2(node / kNodesPerOctave); }
int node_of(double fresnel_number) {
  const double f = std::clamp(fresnel_number, StopPatterns::kLowestFresnel, StopPatterns::kHighestFresnel);
  return static_cast<int>(std::lround(kNodesPerOctave * std::log2(f)));
}

PupilMask mask_of(const Iris& iris, const MaskGrid& grid, const Context& context) {
  if (!iris.field) return make_mask(grid, IrisOpening(iris), 1.0, context);
  PupilMask mask = make_mask(grid, [&](Vec2 p) { return iris_distance(iris, p); }, context);
  // The amplitude of a wave is the root of the transmittance (hullin2011 3.2).
  for (std::size_t k = 0; iris.field->has_half_tones() && k < mask.amplitude.size(); ++k) {
    const auto side = static_cast<std::size_t>(grid.side);
    const Vec2 point = grid.position_mm(static_cast<int>(k % side), static_cast<int>(k / side));
    mask.amplitude[k] *= static_cast<float>(std::sqrt(iris_transmittance(iris, point, grid.pitch_mm)));
  }
  return mask;
}

// Fades the pattern to zero at a round rim, and scales its flux to that of the opening.
PatternTexture trimmed(int side, double extent, std::vector<float> samples, double open_area) {
  double sum = 0.0;
  const double pitch = 2.0 * extent / side;
  std::size_t k = 0;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column, ++k) {
      const double r = std::hypot(column + 0.5 - 0.5 * side, row + 0.5 - 0.5 * side) * pitch / extent;
      const double t = std::clamp((1.0 - r) / (1.0 - kFade), 0.0, 1.0);
      samples[k] *= static_cast<float>(t * t * (3.0 - 2.0 * t));
      sum += samples[k];
    }
  }
  const auto scale = static_cast<float>(sum > 0.0 ? open_area / (sum * pitch * pitch) : 0.0);
  for (float& s : samples) s *= scale;
  return {side, extent, std::move(samples)};
}

// The steps of the Fresnel grid that a band covers: F varies as 1 / lambda, over a uniform band with that spread.
std::pair<int, int> nodes_of(int node, double spread) {
  const double half_band = std::min(std::numbers::sqrt3 * spread, 0.9);
  return {node - static_cast<int>(std::lround(kNodesPerOctave * std::log2(1.0 + half_band))),
          node - static_cast<int>(std::lround(kNodesPerOctave * std::log2(1.0 - half_band)))};
}

Context quiet(const Context& context) {
  Context same = context;
  same.progress = {};
  return same;
}

}  // namespace

StopPatterns::StopPatterns(const Iris& iris)
    : iris_(iris), mask_(mask_of(iris, grid_over(1.0, kMaskSamples), {})), open_area_(mask_.open_area_mm2()),
      atlas_(iris) {}

StopPatterns::BandKey StopPatterns::key_of(const Request& requested) {
  return {node_of(requested.fresnel_number), static_cast<int>(std::lround(requested.spread / kSpreadStep))};
}

bool StopPatterns::make(std::span<const Request> requested, const Context& context) {
  std::set<BandKey> missing;
  std::set<int> nodes;
  for (const Request& w : requested) {
    const BandKey key = key_of(w);
    if (patterns_.contains(key)) continue;
    missing.insert(key);
    const auto [low, high] = nodes_of(key.node, key.spread * kSpreadStep);
    for (int node = low; node <= high; ++node)
      if (!nodes_.contains(node)) nodes.insert(node);
  }
  const std::vector<int> node_list(nodes.begin(), nodes.end());
  std::vector<Node> made_nodes(node_list.size());
  Context alone = quiet(context);  // one thread a pattern
  alone.threads = 1;
  bool done = parallel_for(node_list.size(), quiet(context), [&](std::size_t k) {
    FresnelPattern p = fresnel_pattern(mask_, 1.0, {fresnel_at(node_list[k]), kPatternSide, 0.0}, alone);
    if (p.irradiance.empty()) return;
    made_nodes[k] = {p.extent, std::vector<float>(p.irradiance.begin(), p.irradiance.end())};
  });
  if (!done || context.cancelled()) return false;
  for (std::size_t k = 0; k < node_list.size(); ++k) nodes_[node_list[k]] = std::move(made_nodes[k]);

  const std::vector<BandKey> key_list(missing.begin(), missing.end());
  std::vector<Texture> made(key_list.size());
  done = parallel_for(key_list.size(), quiet(context), [&](std::size_t k) { made[k] = average(key_list[k]); });
  if (!done || context.cancelled()) return false;
  for (std::size_t k = 0; k < key_list.size(); ++k) patterns_[key_list[k]] = made[k];
  return true;
}

StopPatterns::Texture StopPatterns::average(const BandKey& key) const {
  const auto [low, high] = nodes_of(key.node, key.spread * kSpreadStep);
  const double extent = fresnel_extent(fresnel_at(key.node));
  std::vector<float> samples(static_cast<std::size_t>(kPatternSide) * kPatternSide);
  const float weight = 1.0F / static_cast<float>(high - low + 1);
  for (int node = low; node <= high; ++node) {
    const Node& from = nodes_.at(node);
    const auto there = resampled({kPatternSide, from.extent, from.samples}, kPatternSide, extent);
    for (std::size_t k = 0; k < samples.size(); ++k) samples[k] += weight * there[k];
  }
  return std::make_shared<const PatternTexture>(trimmed(kPatternSide, extent, std::move(samples), open_area_));
}

StopPatterns::Texture StopPatterns::pattern(const Request& requested) const {
  const auto found = patterns_.find(key_of(requested));
  return found == patterns_.end() ? nullptr : found->second;
}

StopPatterns::Profile StopPatterns::profile(double spread) {
  const int key = static_cast<int>(std::lround(spread / kSpreadStep));
  Profile& profile = profiles_[key];
  if (!profile) profile = std::make_shared<const EdgeProfile>(key * kSpreadStep);
  return profile;
}

StopPatterns::Texture StopPatterns::fractional(std::span<const double> orders, const Context& context) {
  const std::vector<double> key(orders.begin(), orders.end());
  const auto found = by_orders_.find(key);
  if (found != by_orders_.end()) return found->second;
  const auto count = static_cast<std::size_t>(kFractionalSide) * kFractionalSide;
  if (!fractional_) fractional_.emplace(kFractionalSide);
  if (analysis_.empty()) {
    const PupilMask mask = mask_of(iris_, {kFractionalSide, 2.0 * kFractionalExtent / kFractionalSide}, quiet(context));
    std::vector<std::complex<double>> wave(count);
    for (std::size_t k = 0; k < count; ++k) wave[k] = mask.at(k);
    analysis_ = fractional_->analyse(wave, quiet(context));
  }
  std::vector<float> mean(count);
  for (const double order : orders) {
    const auto wave = fractional_->at_order(analysis_, order, quiet(context));
    if (wave.empty()) return nullptr;
    for (std::size_t k = 0; k < count; ++k)
      mean[k] += static_cast<float>(std::norm(wave[k]) / static_cast<double>(orders.size()));
  }
  return by_orders_[key] = std::make_shared<const PatternTexture>(
             trimmed(kFractionalSide, kFractionalExtent, std::move(mean), open_area_));
}

StopPatterns::Band StopPatterns::band(std::span<const PatternTexture* const> parts) {
  const std::vector<const PatternTexture*> key(parts.begin(), parts.end());
  {
    const std::scoped_lock lock(bands_mutex_);
    const auto found = bands_.find(key);
    if (found != bands_.end()) return found->second;
  }
  raster::TextureTable table = texture_table(parts);
  const std::scoped_lock lock(bands_mutex_);
  Band& band = bands_[key];
  if (!band) band = std::make_shared<const BandTexture>(std::move(table), atlas_);
  return band;
}

std::size_t StopPatterns::memory_bytes() const {
  std::size_t sum = atlas_.bytes() + mask_.amplitude.size() * sizeof(float) + analysis_.size() * sizeof(analysis_[0]);
  for (const auto& [fresnel, node] : nodes_) sum += node.samples.size() * sizeof(float);
  for (const auto& [key, texture] : patterns_) sum += texture->bytes();
  for (const auto& [orders, texture] : by_orders_) sum += texture ? texture->bytes() : 0;
  return sum;
}

}  // namespace contrejour::inline internal::stop_patterns
