// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/halo.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace contrejour::inline internal {
namespace {

constexpr double kQuantile = 0.3;      // of a ring's pixels: ghosts only add light, so the low ones are the halo
constexpr double kRingWidth = 1.08;    // outer over inner radius, at least a pixel wide
constexpr double kUncertainty = 0.03;  // of the halo, relative: it is not quite the same in all directions
constexpr std::size_t kFewPixels = 12;

// The halo's level on rings about the light, of rising radii; between them it is interpolated.
struct Profile {
  std::vector<double> radius_px, level;

  [[nodiscard]] double at(double r) const {
    if (radius_px.empty()) return 0.0;
    const auto next = std::ranges::upper_bound(radius_px, r);
    if (next == radius_px.begin()) return level.front();
    if (next == radius_px.end()) return level.back();
    const auto k = static_cast<std::size_t>(next - radius_px.begin());
    const double t = (r - radius_px[k - 1]) / (radius_px[k] - radius_px[k - 1]);
    return (1.0 - t) * level[k - 1] + t * level[k];
  }
};

std::vector<double> ring_edges(double from, double to) {
  std::vector<double> edges{std::max(from, 1.0)};
  while (edges.back() < to) edges.push_back(std::max(edges.back() * kRingWidth, edges.back() + 1.0));
  return edges;
}

double quantile_of(std::vector<float>& values, double q) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

double distance_of(int x, int y, Vec2 light_px) { return std::hypot(x + 0.5 - light_px.x, y + 0.5 - light_px.y); }

Profile profile_of(const FitStation& station, Vec2 light_px, double masked_px, int channel) {
  const std::vector<double> edges = ring_edges(masked_px, std::hypot(station.rate.width, station.rate.height));
  std::vector<std::vector<float>> rings(edges.size());
  for (int y = 0; y < station.rate.height; ++y) {
    for (int x = 0; x < station.rate.width; ++x) {
      if (station.weight.at(x, y, channel) == 0.0F) continue;
      const auto ring = std::ranges::upper_bound(edges, distance_of(x, y, light_px));
      if (ring != edges.begin() && ring != edges.end()) {
        rings[static_cast<std::size_t>(ring - edges.begin())].push_back(station.rate.at(x, y, channel));
      }
    }
  }
  Profile profile;
  for (std::size_t k = 1; k < edges.size(); ++k) {
    if (rings[k].size() < kFewPixels) continue;
    profile.radius_px.push_back(0.5 * (edges[k - 1] + edges[k]));
    profile.level.push_back(std::max(quantile_of(rings[k], kQuantile), 0.0));
  }
  return profile;
}

}  // namespace

void subtract_halo(FitStation& station, Vec2 light_px, double masked_px) {
  for (int c = 0; c < 3; ++c) {
    const Profile profile = profile_of(station, light_px, masked_px, c);
    for (int y = 0; y < station.rate.height; ++y) {
      for (int x = 0; x < station.rate.width; ++x) {
        const double r = distance_of(x, y, light_px), halo = profile.at(r);
        float& weight = station.weight.at(x, y, c);
        station.rate.at(x, y, c) -= static_cast<float>(halo);
        if (r < masked_px) weight = 0.0F;
        if (weight > 0.0F) {
          const double uncertain = kUncertainty * halo;
          weight = static_cast<float>(1.0 / (1.0 / static_cast<double>(weight) + uncertain * uncertain));
        }
      }
    }
  }
}

}  // namespace contrejour::inline internal
