// SPDX-License-Identifier: Apache-2.0
// Discs from traced ghosts: where a fit of photographs of a known lens starts.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/learn_lens.h"
#include "contrejour/ghost_figures.h"

namespace contrejour {
namespace {

constexpr int kAngles = 8;  // at which ghosts are traced
constexpr std::size_t kFewestAngles = 3;
constexpr int kBandsTraced = 3;
// Ghosts larger than this part of the picture's width show no edge; smaller ones than this have no outline, and are
// found as spots.
constexpr double kLargest = 0.6, kSmallest = 0.006;
constexpr int kPixels = 1000;  // across the picture, in which ghosts are measured

// A ghost at one angle, in tangents.
struct SeenDisc {
  double s = 0, centre = 0, radius = 0, peak = 0;
};

// y = a + b s^2, by least squares.
std::pair<double, double> even_fit(const std::vector<SeenDisc>& seen, double (*value)(const SeenDisc&)) {
  Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (const SeenDisc& one : seen) {
    const Eigen::Vector2d row{1.0, one.s * one.s};
    a += row * row.transpose();
    b += row * value(one);
  }
  const Eigen::Vector2d x = a.ldlt().solve(b);
  return {x[0], x[1]};
}

FoundGhost disc_of(const std::vector<SeenDisc>& seen) {
  const auto [speed, bend] = even_fit(seen, [](const SeenDisc& one) { return one.centre / one.s; });
  const auto [radius, change] = even_fit(seen, [](const SeenDisc& one) { return one.radius; });
  FoundGhost found;
  found.speed = speed;
  found.bend = bend;
  found.radius = std::max(radius, 0.0);
  found.growth = found.radius > 0.0 ? change / found.radius : 0.0;
  found.first = seen.front().s;
  found.last = seen.back().s;
  return found;
}

}  // namespace

Result<std::vector<FoundGhost>> discs_of_lens(const LensState& lens, double largest_angle_rad, std::size_t most,
                                              const Context& context) {
  if (!(largest_angle_rad > 0.0 && largest_angle_rad < 1.5))
    return invalid_argument("the largest angle of a sweep must lie between 0 and 1.5 rad");
  FiguresRequest request;
  request.frame = frame_on_sensor(
      lens, kPixels, std::max(1, static_cast<int>(kPixels * lens.sensor_height_mm / lens.sensor_width_mm)));
  request.bands = spectral_bands(kBandsTraced, IlluminantD65{}, ColourSpace::Rec709);
  const double focal_px = first_order(lens, lens.design_wavelength_nm).focal_length_mm / request.frame.pixel_pitch_mm;
  const Vec2 middle{0.5 * request.frame.width, 0.5 * request.frame.height};
  std::map<std::pair<int, int>, std::vector<SeenDisc>> seen;
  for (int k = 1; k <= kAngles; ++k) {
    const double s = std::tan(largest_angle_rad) * k / kAngles;
    request.light.direction = direction_for_image_point(
        lens, request.frame.sensor_from_pixel(middle + Vec2{s * focal_px, 0.0}), lens.design_wavelength_nm);
    const auto figures = ghost_figures(lens, request, context);
    if (!figures) return tl::unexpected(figures.error());
    for (const GhostFigures& figure : *figures) {
      const double radius = 0.5 * figure.size_px.y, centre = figure.centroid_px.x - middle.x;
      if (!(figure.relative_flux > 0.0) || std::abs(centre) > middle.x + radius) continue;
      seen[{figure.ghost.i, figure.ghost.j}].push_back(
          {s, centre / focal_px, radius / focal_px, figure.peak_irradiance});
    }
  }
  std::vector<std::pair<double, FoundGhost>> ranked;
  for (const auto& [ghost, angles] : seen) {
    if (angles.size() < kFewestAngles) continue;
    const FoundGhost found = disc_of(angles);
    const double part = 2.0 * found.radius * focal_px / kPixels;
    if (part > kLargest || part < kSmallest) continue;
    double peak = 0.0;
    for (const SeenDisc& one : angles) peak += one.peak / static_cast<double>(angles.size());
    ranked.emplace_back(peak, found);
  }
  std::ranges::stable_sort(ranked, std::greater(), &std::pair<double, FoundGhost>::first);
  std::vector<FoundGhost> discs;
  for (std::size_t k = 0; k < std::min(most, ranked.size()); ++k) discs.push_back(ranked[k].second);
  return discs;
}

}  // namespace contrejour
