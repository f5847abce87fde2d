// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/ghost_start.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "measure/model/flare_curves.h"

namespace contrejour::inline internal {
namespace {

// Coefficients of each curve at the lowest degree, in the order of curves_of().
constexpr std::array<std::size_t, kGhostCurves> kMinBands{2, 2, 1, 2, 1, 0, 1, 1, 1, 1, 0, 0, 2, 2, 2, 2, 2, 2};
constexpr std::array<std::size_t, kGhostCurves> kPerDegree{1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1};
constexpr double kStartWidth_px = 1.0, kStartWidth = 0.03;  // of the radius: edges must be felt from a distance
constexpr double kRing = 1.25;  // outer over inner radius of the ring around a disc
constexpr double kRangeMargin = 1.1;
constexpr double kVeilReach = 4.0;  // half diagonals of the picture

struct Mean {
  double sum = 0, weight = 0;

  void add(double value) {
    sum += value;
    weight += 1.0;
  }
  [[nodiscard]] double value() const { return weight > 0.0 ? sum / weight : 0.0; }
};

// How much brighter the disc is than the ring about it, at the stations where it was seen.
double step_of(const FoundGhost& found, std::span<const FitStation> stations, int channel) {
  Mean steps;
  for (const FitStation& station : stations) {
    if (station.s < found.first || station.s > found.last) continue;
    const TangentFrame& frame = station.frame.pixels;
    const Vec2 along{station.frame.to_light.x, -station.frame.to_light.y};
    const double s2 = station.s * station.s;
    const Vec2 centre = frame.centre_px + along * ((found.speed + found.bend * s2) * station.s * frame.focal_length_px);
    const double radius = std::max(found.radius * (1.0 + found.growth * s2), 0.0) * frame.focal_length_px,
                 outer = std::max(kRing * radius, radius + 2.0);
    Mean inside, around;
    for (int y = std::max(0, static_cast<int>(centre.y - outer));
         y < std::min(frame.height, static_cast<int>(centre.y + outer) + 1); ++y) {
      for (int x = std::max(0, static_cast<int>(centre.x - outer));
           x < std::min(frame.width, static_cast<int>(centre.x + outer) + 1); ++x) {
        const double r = std::hypot(x + 0.5 - centre.x, y + 0.5 - centre.y);
        if (r > outer || station.weight.at(x, y, channel) == 0.0F) continue;
        (r < radius ? inside : around).add(static_cast<double>(station.rate.at(x, y, channel)));
      }
    }
    if (inside.weight > 0.0 && around.weight > 0.0) steps.add(inside.value() - around.value());
  }
  return steps.value();
}

double area_scale(const FitStation& station) {
  return station.frame.pixels.focal_length_px * station.frame.pixels.focal_length_px;
}

}  // namespace

MeasuredGhost with_degree(MeasuredGhost ghost, int degree) {
  const auto curves = curves_of(ghost);
  for (std::size_t k = 0; k < kGhostCurves; ++k) {
    if (is_clip_curve(k)) continue;
    curves[k]->coefficients.resize(kMinBands[k] + static_cast<std::size_t>(degree) * kPerDegree[k], 0.0);
  }
  return ghost;
}

MeasuredGhost start_of_ghost(const FoundGhost& found, std::span<const FitStation> residuals, double s_max) {
  const double pixel = 1.0 / residuals.front().frame.pixels.focal_length_px;
  MeasuredGhost ghost;
  ghost.centre.coefficients = {found.speed, found.bend};
  ghost.half_width.coefficients = ghost.half_height.coefficients = {found.radius, found.radius * found.growth};
  ghost.width_in.coefficients =
      ghost.width_out.coefficients = {std::max(kStartWidth_px * pixel, kStartWidth * found.radius)};
  for (int c = 0; c < 3; ++c) {
    const double level = std::max(step_of(found, residuals, c), 0.0) * area_scale(residuals.front());
    ghost.border[static_cast<std::size_t>(c)].coefficients = {level};
    ghost.inside[static_cast<std::size_t>(c)].coefficients = {level};
  }
  ghost.last = std::min(s_max, kRangeMargin * found.last);
  if (ghost.last > 0.9 * s_max) ghost.last = s_max;
  ghost.transition = 0.05 * s_max;
  return with_degree(std::move(ghost), 0);
}

MeasuredGhost start_of_veil(std::span<const FitStation> stations, double s_max) {
  const TangentFrame& frame = stations.front().frame.pixels;
  const double half_diagonal = 0.5 * std::hypot(frame.width, frame.height) / frame.focal_length_px;
  MeasuredGhost veil;
  veil.name = "veil";
  veil.half_width.coefficients = veil.half_height.coefficients = {kVeilReach * half_diagonal};
  veil.width_in.coefficients = veil.width_out.coefficients = {1.0 / frame.focal_length_px};
  veil.centre.coefficients = {0.0};
  for (int c = 0; c < 3; ++c) {
    std::vector<float> levels;
    for (const FitStation& station : stations) {
      std::vector<float> values;
      for (std::size_t k = static_cast<std::size_t>(c); k < station.rate.pixels.size(); k += 3) {
        if (station.weight.pixels[k] > 0.0F) values.push_back(station.rate.pixels[k]);
      }
      if (values.empty()) continue;
      const auto low = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 5);
      std::nth_element(values.begin(), low, values.end());
      levels.push_back(*low);
    }
    std::ranges::sort(levels);
    const double level = levels.empty() ? 0.0 : std::max(static_cast<double>(levels[levels.size() / 2]), 0.0);
    veil.border[static_cast<std::size_t>(c)].coefficients = {level * area_scale(stations.front())};
    veil.inside[static_cast<std::size_t>(c)].coefficients = {level * area_scale(stations.front()), 0.0, 0.0};
  }
  veil.last = s_max;
  return veil;
}

}  // namespace contrejour::inline internal
