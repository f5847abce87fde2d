// SPDX-License-Identifier: Apache-2.0
#include "studio/core/measured_halo.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contrejour::studio {
namespace {

constexpr std::size_t kLeastStations = 3;
constexpr float kNoLevel = std::numeric_limits<float>::quiet_NaN();
constexpr double kLeastOfRing = 0.15;  // of a ring's pixels, inside the photograph
// Rings by which a station's own brightness is measured: farther out the halo is too dim.
constexpr std::size_t kFirstRing = 2, kLastRing = 40;
constexpr float kLeastFactor = 0.75F, kMostFactor = 4.0F / 3;

float median_of(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double distance_px(int x, int y, Vec2 light_px) { return std::hypot(x + 0.5 - light_px.x, y + 0.5 - light_px.y); }

bool is_inside(const Image& photograph, int x, int y) {
  return photograph.at(x, y, 0) != 0 || photograph.at(x, y, 1) != 0 || photograph.at(x, y, 2) != 0;
}

// Between the middles of its rings. Beyond the last that has a level it is taken to fall by r^-2, which is a guess:
// too little of it is seen there to be measured.
float level_at(const std::vector<float>& rings, double r_px) {
  const double place = std::fmax(0.0, r_px - 0.5);
  auto first = static_cast<std::size_t>(place);
  if (first + 1 < rings.size() && !std::isnan(rings[first]) && !std::isnan(rings[first + 1]))
    return rings[first] + static_cast<float>(place - static_cast<double>(first)) * (rings[first + 1] - rings[first]);
  first = std::min(first, rings.size() - 1);
  while (first > 0 && std::isnan(rings[first])) --first;
  const double part = (static_cast<double>(first) + 0.5) / std::fmax(r_px, 0.5);
  return std::isnan(rings[first]) ? 0 : rings[first] * static_cast<float>(std::fmin(1.0, part * part));
}

float factor_of(const RingLevels& station, const RingLevels& halo) {
  std::vector<float> ratios;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t r = kFirstRing; r < std::min({kLastRing, halo[c].size(), station[c].size()}); ++r)
      if (halo[c][r] > 0 && !std::isnan(station[c][r])) ratios.push_back(station[c][r] / halo[c][r]);
  return ratios.empty() ? 1 : std::clamp(median_of(ratios), kLeastFactor, kMostFactor);
}

}  // namespace

RingLevels ring_levels(const Image& residual, const Image& photograph, Vec2 light_px) {
  const auto count = static_cast<std::size_t>(residual.width + residual.height);
  std::array<std::vector<std::vector<float>>, 3> rings;
  for (auto& channel : rings) channel.resize(count);
  for (int y = 0; y < residual.height; ++y)
    for (int x = 0; x < residual.width; ++x) {
      const auto ring = static_cast<std::size_t>(distance_px(x, y, light_px));
      if (ring >= count || !is_inside(photograph, x, y)) continue;
      for (int c = 0; c < 3; ++c) rings[static_cast<std::size_t>(c)][ring].push_back(residual.at(x, y, c));
    }
  RingLevels levels;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t r = 0; r < count; ++r) {
      const double whole = 3.14159265358979 * (2.0 * static_cast<double>(r) + 1);
      const bool is_seen = static_cast<double>(rings[c][r].size()) > kLeastOfRing * whole;
      levels[c].push_back(is_seen ? median_of(rings[c][r]) : kNoLevel);
    }
  return levels;
}

RingLevels halo_of(std::span<const RingLevels> stations) {
  RingLevels halo;
  if (stations.size() < kLeastStations) return halo;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t r = 0; r < stations[0][c].size(); ++r) {
      std::vector<float> levels;
      for (const RingLevels& station : stations)
        if (!std::isnan(station[c][r])) levels.push_back(station[c][r]);
      halo[c].push_back(levels.size() < kLeastStations ? kNoLevel : std::max(0.0F, median_of(levels)));
    }
  return halo;
}

Image without_halo(const Image& residual, const Image& photograph, const RingLevels& station, const RingLevels& halo,
                   Vec2 light_px) {
  Image rest = residual;
  if (halo[0].empty()) return rest;
  const float factor = factor_of(station, halo);
  for (int y = 0; y < rest.height; ++y)
    for (int x = 0; x < rest.width; ++x)
      for (int c = 0; c < 3 && is_inside(photograph, x, y); ++c)
        rest.at(x, y, c) -= factor * level_at(halo[static_cast<std::size_t>(c)], distance_px(x, y, light_px));
  return rest;
}

}  // namespace contrejour::studio
