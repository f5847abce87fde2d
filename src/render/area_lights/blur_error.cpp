// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/blur_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "render/area_lights/image_pyramid.h"

namespace contrejour::inline internal::area {
namespace {

constexpr double kRadiusPixels = 2.5;  // radius of a blur in pixels of its level, for ghosts larger than the blur
constexpr double kSpotPixels = 6.0;    // the same for much smaller ghosts, which show the light's shape
constexpr double kMinPixels = 1.25;  // the least, whatever the error
constexpr double kLongest = 30.0;      // largest longer radius, whatever the shorter one is

int level_of_width(double px) { return px < 1.0 ? 0 : std::min(static_cast<int>(std::log2(px)), kLevels - 1); }

// Pixels may be as wide as the detail of the image allows: as the larger one of blur and ghost does. But a spot shows
// the outline of the light itself.
int safe_level(const BlurredGhost& g) {
  const double finest = g.blur_px.x / kSpotPixels, coarsest = g.blur_px.x / kRadiusPixels;
  const double width = std::clamp(g.size_px.x / kRadiusPixels, finest, coarsest);
  return level_of_width(std::max(width, g.blur_px.y / kLongest));
}

// The following errors are squared, for a pixel's length of an edge, and relative to the square of the edge's height.

// Drawn in pixels whose width is 1 / u of the radius of the disc that blurs the edge. The formula is fitted to straight
// edges in all positions between pixels, to within a third for u from 0.8 to 10 (docs/physics/area-lights.md). The
// limit for sharp edges corresponds to a displacement of about half a pixel.
double coarse_edge_error(double u) {
  constexpr double kSmooth = 2.5e-3, kSharpest = 0.08;
  const double squares = 1.0 / (u * u);
  return std::min(kSharpest, kSmooth * (squares + squares * squares * squares));
}

// The larger one of ghost and blur gives the shape, and the smaller one the width of its soft edge.
double edge_width_px(const BlurredGhost& g) { return std::max(std::min(g.blur_px.x, g.size_px.x), 1e-3); }

double outline_px(const BlurredGhost& g) {
  return std::numbers::pi * (g.blur_px.x + g.blur_px.y + g.size_px.x + g.size_px.y);
}

// Limits errors smoothly, since those above the peak do not count: to `limit`.
double clipped(double squares, double limit) { return squares > 0.0 ? squares / (1.0 + squares / limit) : 0.0; }

}  // namespace

// The error of blurring by a disc of another radius: 0.11 is the integral of u^2 S'(u)^2 over S, a disc's mean across.
// An edge much sharper than the difference is displaced by it.
double misfit_error(double height, double edge_width_px, double displacement_px) {
  constexpr double kByWidth = 0.108;
  return clipped(height * height * displacement_px * std::min(kByWidth * displacement_px / edge_width_px, 0.5),
                 displacement_px);
}

double level_error(const BlurredGhost& g, int level) {
  const double width = std::exp2(level);
  return outline_px(g) * clipped(g.level * g.level * width * coarse_edge_error(edge_width_px(g) / width), width);
}

double pixel_error(const BlurredGhost& g, int level) {
  constexpr double kNarrow = 0.8;  // below, errors fall as the fourth moment of the blur
  const double width = std::exp2(level), blur = g.blur_px.y / width;
  const double error = coarse_edge_error(std::max(blur, kNarrow)) * std::pow(std::min(blur / kNarrow, 1.0), 4.0);
  return outline_px(g) * clipped(g.level * g.level * width * error, width);
}

// The centroid of what pixels hold of a spot is off by up to half a pixel, and less by the factor by which the spot's
// size dampens a wave as long as a pixel: exp(-2 pi^2 s^2) for a Gaussian spot of standard deviation s, half the
// radius. A line is off across its short axis.
double spot_error(const BlurredGhost& g, int level) {
  const double width = std::exp2(level), s = 0.5 * g.size_px.x / width;
  const double displacement_px = width * std::exp(-2.0 * std::numbers::pi * std::numbers::pi * s * s);
  return outline_px(g) * misfit_error(g.level, 0.5 * width, displacement_px);
}

int spot_level(const BlurredGhost& g, int coarsest, double allowed_squares) {
  constexpr double kWidest = 12.0;  // radius of a blur in pixels: wider ones show no pixels
  int level = coarsest;
  while (level > kFinestLevel && g.blur_px.y < kWidest * std::exp2(level) && spot_error(g, level) > allowed_squares)
    --level;
  return level;
}

std::vector<int> levels_of(std::span<const BlurredGhost> ghosts, double allowed_squares) {
  struct Step {
    std::size_t ghost = 0;
    int level = 0;
    double error = 0.0;
  };
  std::vector<int> levels;
  std::vector<Step> steps;
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    levels.push_back(safe_level(ghosts[g]));
    const int coarsest = level_of_width(ghosts[g].blur_px.x / kMinPixels);
    for (int level = levels[g] + 1; level <= coarsest; ++level)
      steps.push_back({g, level, level_error(ghosts[g], level)});
  }
  std::stable_sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) { return a.error < b.error; });
  double sum = 0.0;
  for (const Step& step : steps) {
    sum += step.error;
    if (sum > allowed_squares) break;
    levels[step.ghost] = std::max(levels[step.ghost], step.level);
  }
  return levels;
}

}  // namespace contrejour::inline internal::area
