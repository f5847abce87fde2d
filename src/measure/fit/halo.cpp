// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/halo.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Dense>

namespace contrejour::inline internal {
namespace {

constexpr double kRingWidth = 1.06;    // outer over inner radius, at least a pixel wide
constexpr double kUncertainty = 0.01;  // of the halo, relative: it is not quite the same everywhere
constexpr double kOffset_px = 0.4;  // colours of a Bayer block are not at one place
constexpr std::size_t kFewPixels = 12;
constexpr double kSeenPart = 0.9;  // of a ring's pixels: those that saturate first are the brightest
constexpr double kFewStations = 0.2;  // of all stations: a distance that fewer show has no level

// How the level changes with the angle is measured where the halo is far brighter than ghosts: up to a multiple of the
// mask's radius, or of the radius within which the light saturates every exposure.
constexpr double kNear = 4.0, kNearSaturated = 1.6;
constexpr std::size_t kFewestForChange = 7;  // stations
constexpr double kLeastScale = 0.05;
constexpr double kMostDeviation = 0.05;  // of one station from the others
constexpr double kMostOblong = 0.2;  // of one station: more is no halo
constexpr int kParts = 4;  // of each step from ring to ring

using Profile = std::vector<double>;  // a level of each ring; NaN: too few pixels

std::vector<double> ring_edges(double from, double to) {
  std::vector<double> edges{std::max(from, 1.0)};
  while (edges.back() < to) edges.push_back(std::max(edges.back() * kRingWidth, edges.back() + 1.0));
  return edges;
}

template <class T>
double quantile_of(std::vector<T>& values, double q) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

double distance_of(int x, int y, Vec2 light_px) { return std::hypot(x + 0.5 - light_px.x, y + 0.5 - light_px.y); }

std::array<Profile, 3> profiles_of(const FitStation& station, Vec2 light_px, std::span<const double> edges, double q) {
  std::array<std::vector<std::vector<float>>, 3> rings;
  rings.fill(std::vector<std::vector<float>>(edges.size()));
  std::vector<double> pixels(edges.size());
  for (int y = 0; y < station.rate.height; ++y) {
    for (int x = 0; x < station.rate.width; ++x) {
      const auto ring = std::ranges::upper_bound(edges, distance_of(x, y, light_px));
      if (ring == edges.begin() || ring == edges.end()) continue;
      pixels[static_cast<std::size_t>(ring - edges.begin())] += 1.0;
      for (int c = 0; c < 3; ++c) {
        if (station.weight.at(x, y, c) > 0.0F) {
          rings[static_cast<std::size_t>(c)][static_cast<std::size_t>(ring - edges.begin())].push_back(
              station.rate.at(x, y, c));
        }
      }
    }
  }
  std::array<Profile, 3> profiles;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < edges.size(); ++k) {
      std::vector<float>& ring = rings[c][k];
      const bool is_seen = ring.size() >= kFewPixels && static_cast<double>(ring.size()) >= kSeenPart * pixels[k];
      profiles[c].push_back(is_seen ? quantile_of(ring, q) : std::nan(""));
    }
  }
  return profiles;
}

// The direction from the light to a pixel, relative to the one away from the optical centre, in radians.
double direction_of(int x, int y, Vec2 light_px, const FitStation& station) {
  const Vec2 away{station.frame.to_light.x, -station.frame.to_light.y};
  const Vec2 offset = Vec2{x + 0.5, y + 0.5} - light_px;
  return std::atan2(cross(away, offset), dot(away, offset));
}

// Calls use(ratio, direction) for each channel of a station's pixels near the light, with its level over that of the
// profile.
template <class Use>
void for_each_near(const HaloProfile& halo, const FitStation& station, Vec2 light_px, double masked_px,
                   const Use& use) {
  const double measured_px = halo.radius_px.empty() ? 0.0 : halo.radius_px.front();
  const double from = std::max(masked_px, measured_px);
  const double reach = std::max(kNear * masked_px, kNearSaturated * measured_px);
  for (int y = std::max(0, static_cast<int>(light_px.y - reach)); y < station.rate.height && y < light_px.y + reach;
       ++y) {
    for (int x = std::max(0, static_cast<int>(light_px.x - reach)); x < station.rate.width && x < light_px.x + reach;
         ++x) {
      const double r = distance_of(x, y, light_px);
      if (r < from || r > reach) continue;
      for (int c = 0; c < 3; ++c) {
        const double usual = halo.at(r, static_cast<std::size_t>(c));
        if (usual > 0.0 && station.weight.at(x, y, c) > 0.0F)
          use(static_cast<double>(station.rate.at(x, y, c)) / usual, direction_of(x, y, light_px, station));
      }
    }
  }
}

// A station's usual level near the light over that of the profile; NaN where too few pixels show it.
double level_over(const HaloProfile& halo, const FitStation& station, Vec2 light_px, double masked_px) {
  std::vector<double> ratios;
  for_each_near(halo, station, light_px, masked_px, [&](double ratio, double) { ratios.push_back(ratio); });
  return ratios.size() < kFewPixels ? std::nan("") : quantile_of(ratios, 0.5);
}

// The amplitude of cos(2 phi) in a station's level near the light, relative to its mean; NaN where some direction has
// too few pixels. Each of eight directions counts by its median, as a ghost may cover some.
double oblong_of(const HaloProfile& halo, const FitStation& station, Vec2 light_px, double masked_px) {
  constexpr std::size_t kDirections = 8;
  constexpr double kStep = 2.0 * std::numbers::pi / kDirections;
  std::array<std::vector<double>, kDirections> ratios;
  for_each_near(halo, station, light_px, masked_px, [&](double ratio, double direction) {
    const double turned = std::round(direction / kStep) + kDirections;
    ratios[static_cast<std::size_t>(turned) % kDirections].push_back(ratio);
  });
  double mean = 0.0, wave = 0.0;
  for (std::size_t k = 0; k < kDirections; ++k) {
    if (ratios[k].size() < kFewPixels) return std::nan("");
    const double level = quantile_of(ratios[k], 0.5);
    mean += level;
    wave += 2.0 * level * std::cos(2.0 * kStep * static_cast<double>(k));
  }
  const double of_median = std::cos(0.5 * kStep);  // the part of the amplitude that a median over one direction has
  return mean > 0.0 ? wave / (of_median * mean) : std::nan("");
}

// By how much the halo is oblong, from all stations: least squares of the amplitudes over s^2.
double oblong_of_all(std::span<const FitStation> stations, std::span<const Vec2> lights_px, double masked_px,
                     const HaloProfile& halo) {
  double sum = 0.0, squares = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const double amplitude = oblong_of(halo, stations[k], lights_px[k], masked_px);
    if (!(std::abs(amplitude) <= kMostOblong)) continue;
    const double s2 = stations[k].s * stations[k].s;
    sum += s2 * amplitude;
    squares += s2 * s2;
    ++count;
  }
  return count < kFewestForChange || squares == 0.0 ? 0.0 : sum / squares;
}

// The levels between rings by a power of the radius, which a straight line would exceed by up to 0.6 per cent.
HaloProfile with_power_laws(const HaloProfile& halo) {
  HaloProfile fine;
  for (std::size_t k = 0; k < halo.radius_px.size(); ++k) {
    for (int part = k == 0 ? kParts - 1 : 0; part < kParts; ++part) {
      const double t = (part + 1.0) / kParts;
      const std::size_t last = k == 0 ? 0 : k - 1;
      fine.radius_px.push_back(halo.radius_px[last] * std::pow(halo.radius_px[k] / halo.radius_px[last], t));
      for (std::size_t c = 0; c < 3; ++c) {
        const double from = halo.level[c][last], to = halo.level[c][k];
        fine.level[c].push_back(from > 0.0 && to > 0.0 ? from * std::pow(to / from, t) : from + (to - from) * t);
      }
    }
  }
  return fine;
}

// Fits the change of the level with the angle to all stations, and refers the profile to the axis.
void fit_change(std::span<const FitStation> stations, std::span<const Vec2> lights_px, double masked_px,
                HaloProfile& halo) {
  std::vector<std::pair<double, double>> levels;  // s, level
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const double level = level_over(halo, stations[k], lights_px[k], masked_px);
    if (std::isfinite(level)) levels.emplace_back(stations[k].s, level);
  }
  if (levels.size() < kFewestForChange) return;
  Eigen::MatrixXd powers(static_cast<Eigen::Index>(levels.size()), 3);
  Eigen::VectorXd right(powers.rows());
  for (Eigen::Index k = 0; k < powers.rows(); ++k) {
    const auto& [s, level] = levels[static_cast<std::size_t>(k)];
    powers.row(k) << 1.0, s * s, s * s * s * s;
    right[k] = level;
  }
  const Eigen::Vector3d curve = powers.colPivHouseholderQr().solve(right);
  if (!(curve[0] > 0.0)) return;
  halo.change = {curve[1] / curve[0], curve[2] / curve[0]};
  for (auto& channel : halo.level)
    for (double& level : channel) level *= curve[0];
}

}  // namespace

double HaloProfile::scale(double s) const {
  const double s2 = s * s;
  return std::max(1.0 + s2 * (change[0] + s2 * change[1]), kLeastScale);
}

double HaloProfile::at(double r_px, std::size_t channel) const {
  if (radius_px.empty()) return 0.0;
  const auto next = std::ranges::upper_bound(radius_px, r_px);
  if (next == radius_px.begin()) return level[channel].front();
  if (next == radius_px.end()) return level[channel].back();
  const auto k = static_cast<std::size_t>(next - radius_px.begin());
  const double t = (r_px - radius_px[k - 1]) / (radius_px[k] - radius_px[k - 1]);
  return (1.0 - t) * level[channel][k - 1] + t * level[channel][k];
}

HaloProfile halo_of(std::span<const FitStation> stations, std::span<const Vec2> lights_px,
                    const HaloSettings& settings) {
  HaloProfile halo;
  if (stations.empty()) return halo;
  const Image& first = stations.front().rate;
  const std::vector<double> edges = ring_edges(settings.masked_px, std::hypot(first.width, first.height));
  std::vector<std::array<Profile, 3>> profiles;
  for (std::size_t k = 0; k < stations.size(); ++k)
    profiles.push_back(profiles_of(stations[k], lights_px[k], edges, settings.quantile));
  const double few = std::max(1.0, kFewStations * static_cast<double>(stations.size()));
  for (std::size_t ring = 1; ring < edges.size(); ++ring) {
    std::array<std::vector<double>, 3> levels;
    for (const auto& profile : profiles) {
      for (std::size_t c = 0; c < 3; ++c) {
        if (std::isfinite(profile[c][ring])) levels[c].push_back(profile[c][ring]);
      }
    }
    if (std::ranges::any_of(levels, [&](const auto& l) { return static_cast<double>(l.size()) < few; })) continue;
    halo.radius_px.push_back(0.5 * (edges[ring - 1] + edges[ring]));
    for (std::size_t c = 0; c < 3; ++c) halo.level[c].push_back(quantile_of(levels[c], settings.quantile));
  }
  for (auto& level : halo.level) {  // it falls with the distance, to 0
    for (std::size_t k = 1; k < level.size(); ++k) level[k] = std::min(level[k], level[k - 1]);
    const double farthest = level.empty() ? 0.0 : level.back();
    for (double& value : level) value -= farthest;
  }
  halo = with_power_laws(halo);
  fit_change(stations, lights_px, settings.masked_px, halo);
  halo.oblong = oblong_of_all(stations, lights_px, settings.masked_px, halo);
  return halo;
}

double halo_deviation(const HaloProfile& halo, const FitStation& residual, Vec2 light_px, double masked_px) {
  const double level = level_over(halo, residual, light_px, masked_px) / halo.scale(residual.s);
  return std::isfinite(level) ? std::clamp(level, 1.0 - kMostDeviation, 1.0 + kMostDeviation) : 1.0;
}

void subtract_halo(FitStation& station, const HaloProfile& halo, Vec2 light_px, double masked_px, double factor) {
  const double scale = factor * halo.scale(station.s), oblong = halo.oblong * station.s * station.s;
  // Nearer than its innermost level, the halo is brighter by an unknown amount.
  const double unknown_px = std::max(masked_px, halo.radius_px.empty() ? 0.0 : halo.radius_px.front());
  for (int y = 0; y < station.rate.height; ++y) {
    for (int x = 0; x < station.rate.width; ++x) {
      const double r = distance_of(x, y, light_px);
      const double here = scale * (1.0 + oblong * std::cos(2.0 * direction_of(x, y, light_px, station)));
      for (int c = 0; c < 3; ++c) {
        const double level = here * halo.at(r, static_cast<std::size_t>(c));
        float& weight = station.weight.at(x, y, c);
        station.rate.at(x, y, c) -= static_cast<float>(level);
        if (r < unknown_px) weight = 0.0F;
        if (weight > 0.0F) {
          const double slope =
              halo.at(r - 0.5, static_cast<std::size_t>(c)) - halo.at(r + 0.5, static_cast<std::size_t>(c));
          const double uncertain = kUncertainty * level + kOffset_px * scale * slope;
          weight = static_cast<float>(1.0 / (1.0 / static_cast<double>(weight) + uncertain * uncertain));
        }
      }
    }
  }
}

}  // namespace contrejour::inline internal
