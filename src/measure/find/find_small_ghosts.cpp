// SPDX-License-Identifier: Apache-2.0
#include "measure/find/find_small_ghosts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/tasks.h"
#include "measure/find/station_steps.h"

namespace contrejour::inline internal {
namespace {

constexpr std::array<double, 5> kSpotRadii_px{1.0, 1.5, 2.2, 3.2, kLargestSpot_px};
// The ring that a spot is compared with: from radius + kRingGap_px to kRingPart * radius + kRingWidth_px.
constexpr double kRingGap_px = 1.5, kRingPart = 1.6, kRingWidth_px = 3.0;
constexpr double kClearPart = 0.7, kClearRing = 0.4;  // of the spot's and the ring's pixels, for a place to count
constexpr double kUneven = 0.5;  // the error of a spot's brightness, as a logarithm, however many its pixels
constexpr double kSpeedStep_px = 0.7, kBendStep_px = 1.5;  // at the largest angle
constexpr int kBends = 4;                                  // to each side
constexpr double kNearLight_px = 4.0;  // ghosts that stay so near the light's image cannot be told from its halo
constexpr double kSameSpotSpeed_px = 2.0, kSameSpotRadius = 1.7;  // spots nearer than these are the same

// How much brighter than its surroundings each place of a station's line is, from one end of the line to the other, for
// one radius; NaN where too little of it is seen.
struct SpotLine {
  double s = 0;
  double first_px = 0, step_px = 1;  // from the optical centre, to the light
  std::vector<float> contrast;

  [[nodiscard]] double at(double place_px) const {
    const double x = (place_px - first_px) / step_px;
    if (!(x >= 0.0 && x < static_cast<double>(contrast.size()) - 1.0)) return std::nan("");
    const auto k = static_cast<std::size_t>(x);
    const double u = x - static_cast<double>(k);
    return (1.0 - u) * static_cast<double>(contrast[k]) + u * static_cast<double>(contrast[k + 1]);
  }
};

struct WeightedMean {
  double sum = 0, weight = 0, wanted = 0;

  void add(float value, double w) {
    wanted += w;
    if (std::isnan(value)) return;
    sum += w * static_cast<double>(value);
    weight += w;
  }
};

// The spot's mean over that of the ring's parts above and below, in standard deviations. A bright spot may saturate a
// channel, and the others show it; where its surroundings do, too, it is the light's halo that is seen.
double spot_contrast(const SearchPicture& picture, Vec2 along, Vec2 middle, double radius) {
  const double inner = radius + kRingGap_px, outer = kRingPart * radius + kRingWidth_px;
  WeightedMean spot, ring;
  const auto range = [outer](double at, int size) {
    return std::pair{std::max(0, static_cast<int>(std::floor(at - outer))),
                     std::min(size, static_cast<int>(std::ceil(at + outer)))};
  };
  const auto [top, bottom] = range(middle.y, picture.value.height);
  const auto [left, right] = range(middle.x, picture.value.width);
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const Vec2 offset = Vec2{x + 0.5, y + 0.5} - middle;
      const double r2 = dot(offset, offset);
      if (r2 > outer * outer) continue;
      if (r2 < (radius + 0.5) * (radius + 0.5)) {
        spot.add(picture.partial.at(x, y), std::min(radius + 0.5 - std::sqrt(r2), 1.0));
      } else if (r2 > inner * inner && std::abs(cross(along, offset)) > std::abs(dot(along, offset))) {
        ring.add(picture.value.at(x, y), 1.0);
      }
    }
  }
  if (!(spot.weight > 0.0 && ring.weight > 0.0) || spot.weight < kClearPart * spot.wanted ||
      ring.weight < kClearRing * ring.wanted)
    return std::nan("");
  const double error = std::sqrt(kUneven * kUneven + 1.0 / spot.weight + 1.0 / ring.weight);
  return (spot.sum / spot.weight - ring.sum / ring.weight) / error;
}

SpotLine spot_line(const SearchPicture& picture, double radius) {
  const TangentFrame& frame = picture.frame.pixels;
  const Vec2 along{picture.frame.to_light.x, -picture.frame.to_light.y};
  const double reach = std::hypot(frame.width, frame.height);
  SpotLine line{picture.s, -reach, std::max(0.5, 0.25 * radius), {}};
  for (double place = -reach; place <= reach; place += line.step_px) {
    const Vec2 middle = frame.centre_px + along * place;
    const bool inside = middle.x > 0.0 && middle.y > 0.0 && middle.x < frame.width && middle.y < frame.height;
    line.contrast.push_back(inside ? static_cast<float>(spot_contrast(picture, along, middle, radius)) : std::nanf(""));
  }
  return line;
}

// Contrasts of all candidates of one radius, and the best of those that are not excluded.
struct OfRadius {
  FoundGhost best;
  std::vector<double> contrasts;
};

struct SpotRange {
  double focal_length_px = 0, max_distance_px = 0, s_max = 0;
};

bool is_same_spot(const FoundGhost& a, const FoundGhost& b, const SpotRange& range) {
  return std::abs(a.speed - b.speed) * range.max_distance_px < kSameSpotSpeed_px &&
         std::max(a.radius, b.radius) < kSameSpotRadius * std::min(a.radius, b.radius);
}

FoundGhost spot_of(const std::vector<SpotLine>& lines, FoundGhost candidate, const SpotRange& range, double& all) {
  std::vector<StationStep> steps;
  for (const SpotLine& line : lines) {
    const double place = line.s * (candidate.speed + candidate.bend * line.s * line.s) * range.focal_length_px;
    const double contrast = line.at(place);
    if (!std::isnan(contrast)) steps.push_back({line.s, contrast});
  }
  const StationsContrast of_all = contrast_over_stations(steps);
  candidate.contrast = of_all.contrast;
  candidate.first = of_all.first;
  candidate.last = of_all.last;
  all = of_all.signed_contrast;
  return candidate;
}

OfRadius spots_of_radius(std::span<const SearchPicture> pictures, double radius_px, const GhostSearch& search,
                         std::span<const FoundGhost> excluded, const SpotRange& range) {
  std::vector<SpotLine> lines;
  for (const SearchPicture& picture : pictures) lines.push_back(spot_line(picture, radius_px));
  std::ranges::sort(lines, {}, &SpotLine::s);
  OfRadius one;
  const auto half = static_cast<int>(std::ceil(search.max_speed * range.max_distance_px / kSpeedStep_px));
  for (int k = -half; k <= half; ++k) {
    for (int j = -kBends; j <= kBends; ++j) {
      FoundGhost candidate;
      candidate.speed = k * kSpeedStep_px / range.max_distance_px;
      candidate.bend = j * kBendStep_px / (range.max_distance_px * range.s_max * range.s_max);
      candidate.radius = radius_px / range.focal_length_px;
      if (std::abs(candidate.speed - 1.0) * range.max_distance_px < kNearLight_px) continue;
      double all = 0.0;
      candidate = spot_of(lines, candidate, range, all);
      if (j == 0) one.contrasts.push_back(all);
      const auto same = [&](const FoundGhost& other) { return is_same_spot(candidate, other, range); };
      if (candidate.contrast > one.best.contrast && std::ranges::none_of(excluded, same)) one.best = candidate;
    }
  }
  return one;
}

}  // namespace

std::optional<FoundGhost> strongest_spot(std::span<const SearchPicture> pictures, const GhostSearch& search,
                                         std::span<const FoundGhost> excluded, const Context& context) {
  if (pictures.empty()) return std::nullopt;
  SpotRange range;
  range.focal_length_px = pictures.front().frame.pixels.focal_length_px;
  for (const SearchPicture& picture : pictures) range.s_max = std::max(range.s_max, picture.s);
  range.max_distance_px = range.s_max * range.focal_length_px;
  if (!(range.max_distance_px > 0.0)) return std::nullopt;
  FoundGhost best;
  std::vector<double> contrasts;
  const bool done = ordered_pipeline(
      kSpotRadii_px.size(), context,
      [&](std::size_t k) { return spots_of_radius(pictures, kSpotRadii_px[k], search, excluded, range); },
      [&](std::size_t /*k*/, const OfRadius& one) {
        contrasts.insert(contrasts.end(), one.contrasts.begin(), one.contrasts.end());
        if (one.best.contrast > best.contrast) best = one.best;
      });
  if (!done || !(best.contrast > 0.0)) return std::nullopt;
  best.contrast /= std::max(usual_contrast(std::move(contrasts)), 1e-6);
  if (best.contrast < search.min_contrast) return std::nullopt;
  return best;
}

}  // namespace contrejour::inline internal
