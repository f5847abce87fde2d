#include "render/area/blur_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "render/area/layers.h"

namespace contrejour::area {
namespace {

constexpr double kRadiusPixels = 2.5;  // a blur's radius in pixels of its level, where ghosts are larger than it
constexpr double kSpotPixels = 6.0;    // where they are much smaller, so that the light's shape shows
constexpr double kLeastPixels = 1.25;  // whatever the error
constexpr double kLongest = 30.0;      // its longer radius, whatever the shorter one is

int level_of_width(double px) { return px < 1.0 ? 0 : std::min(static_cast<int>(std::log2(px)), kLevels - 1); }

// Pixels may be as wide as what they show is smooth: blur and ghost, whichever is the larger, but a spot shows the
// light's own outline.
int safe_level(const BlurredGhost& g) {
  const double finest = g.blur_px.x / kSpotPixels, coarsest = g.blur_px.x / kRadiusPixels;
  const double width = std::clamp(g.size_px.x / kRadiusPixels, finest, coarsest);
  return level_of_width(std::max(width, g.blur_px.y / kLongest));
}

// Squared errors along an edge, over its height's square, for a length of a pixel.

// Drawn in pixels of a u-th of the radius of the disc that blurs it: measured at straight edges in all places between
// pixels, within a third for u from 0.8 to 10 (docs/physics/area-lights.md). The sharpest is off by half a pixel or so.
double coarse_edge_error(double u) {
  constexpr double kSmooth = 2.5e-3, kSharpest = 0.08;
  const double squares = 1.0 / (u * u);
  return std::min(kSharpest, kSmooth * (squares + squares * squares * squares));
}

// Of ghost and blur the larger is the shape that shows, its edge as soft as the smaller is wide.
double softness_px(const BlurredGhost& g) { return std::max(std::min(g.blur_px.x, g.size_px.x), 1e-3); }

double outline_px(const BlurredGhost& g) {
  return std::numbers::pi * (g.blur_px.x + g.blur_px.y + g.size_px.x + g.size_px.y);
}

// Above the peak errors do not count: so much at most.
double clipped(double squares, double most) { return squares > 0.0 ? squares / (1.0 + squares / most) : 0.0; }

}  // namespace

// Blurred by a disc of another radius: 0.11 = integral of u^2 S'(u)^2 over S, a disc's mean across. An edge much
// sharper than that is moved.
double misfit_error(double height, double softness_px, double off_px) {
  constexpr double kByWidth = 0.108;
  return clipped(height * height * off_px * std::min(kByWidth * off_px / softness_px, 0.5), off_px);
}

double level_error(const BlurredGhost& g, int level) {
  const double width = std::exp2(level);
  return outline_px(g) * clipped(g.level * g.level * width * coarse_edge_error(softness_px(g) / width), width);
}

double pixel_error(const BlurredGhost& g) {
  constexpr double kNarrow = 0.8;  // below, errors fall as the blur's fourth moments do
  const double error =
      coarse_edge_error(std::max(g.blur_px.y, kNarrow)) * std::pow(std::min(g.blur_px.y / kNarrow, 1.0), 4.0);
  return outline_px(g) * clipped(g.level * g.level * error, 1.0);
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
    const int coarsest = level_of_width(ghosts[g].blur_px.x / kLeastPixels);
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

}  // namespace contrejour::area
