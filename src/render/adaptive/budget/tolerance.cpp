// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/tolerance.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "render/ray_maps/lobatto_cells.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kFitFraction = 0.3;  // of the allowed error, for fits: theirs is the same all over a ghost
// The same, over kFitFraction, for rays that are evaluated from a fit: they cost little, and none of them fails, which
// would show where a map is steep.
constexpr double kFractionOfFitted = 0.6;
constexpr double kNoLimit = 1e9;
// The largest displacement of a ghost's light, over the ghost's size: kMaxShift in general, kPreviewShift in preview
// quality, where twice that has produced false caustics between rays far apart.
constexpr double kPreviewWeight = 0.1, kPreviewStop = 0.004;  // in preview quality, of rays that are evaluated
constexpr double kPreviewShiftOfFitted = 0.2;  // of that of traced rays
constexpr double kMaxShift = 0.05, kPreviewShift = 0.02, kLittle_px = 0.5;
// In ghosts brighter than kColourLevel of the peak, wavelengths farther apart than this, over the ghost's size, show as
// colours.
constexpr double kColourLevel = 3e-4, kColourShift = 0.02, kColourShift_px = 1.0;
constexpr double kPeaks = 16.0;  // times the peak: fits of brighter light need be no better

// The level and the area of a ray set's image. pupil_light: the light of a mm^2 of the pupil, taken as uniform over the
// image of each cell between rays. Cells far outside a rim do not count, since rays at a box's border may land far
// outside the frame. Empty if no cell counts.
std::optional<LevelEstimate> level_of(const LobattoRays& ray_set, double pupil_light, const Frame& frame) {
  const LobattoCells cells(ray_set);
  const double pixel_mm2 = frame.pixel_pitch_mm * frame.pixel_pitch_mm;
  const auto rim = [&](std::size_t k) { return ray_set.relative_height[k]; };
  std::vector<std::size_t> counted;
  double image_px = 0.0;
  for (std::size_t first = 0; first < cells.end(); ++first) {
    if (!cells.has(first)) continue;
    const auto corners = cells.corners(first);
    const auto [nearest, farthest] = std::ranges::minmax(corners, {}, rim);
    if (std::isinf(rim(farthest)) || rim(nearest) > kNearlyThrough) continue;
    counted.push_back(first);
    image_px += cells.image_mm2(first) / pixel_mm2;
  }
  // A cell smaller than a pixel counts as large as one, but all cells of a ghost in a pixel together count as one.
  const double count = static_cast<double>(std::max<std::size_t>(counted.size(), 1));
  const double least_px = std::min(std::max(image_px, 1.0) / count, 1.0);
  double light = 0.0, squares = 0.0;
  for (const std::size_t first : counted) {
    const double here = pupil_light * cells.entrance_mm2(first);
    light += here;
    squares += here * here / std::max(cells.image_mm2(first) / pixel_mm2, least_px);
  }
  if (!(light > 0.0)) return std::nullopt;
  return LevelEstimate{squares / light, light * light / squares};
}

// Used where no cell counts and nothing is known: all light in one pixel.
LevelEstimate one_pixel(const LobattoRays& ray_set, double pupil_light) {
  const Vec2 size = ray_set.box.high - ray_set.box.low;
  return {pupil_light * size.x * size.y, 1.0};
}

// The smallest displacement that is asked for: positions of rays on the sensor are single-precision numbers.
double least_shift_px(const Frame& frame) {
  constexpr double kLeast_px = 0.0005, kRounding_mm = 4e-6;
  return std::max(kLeast_px, kRounding_mm / frame.pixel_pitch_mm);
}

// The brighter of the two estimates, since light may be focused where no ray is traced.
LevelEstimate brighter(const std::optional<LevelEstimate>& traced, const LevelEstimate& known) {
  return traced && traced->level >= known.level ? *traced : known;
}

}  // namespace

// Derived from edges displaced by d over a length of about 4 L, and from levels off by a fraction w over L^2 pixels.
Tolerance tolerance_for(const LobattoRays& ray_set, double weight, double shared_flux, const Frame& frame,
                        const ErrorBudget& budget) {
  constexpr Tolerance kAny{kNoLimit, kNoLimit, kNoLimit, 0.0, kNoLimit, kNoLimit};
  if (!(weight > 0.0)) return kAny;
  const double pupil_light = weight * shared_flux;
  const std::optional<LevelEstimate> traced = level_of(ray_set, pupil_light, frame);
  if (!std::isfinite(budget.squared_error)) {
    Tolerance t = kAny;
    if (traced) t.position_px = kPreviewShift * std::sqrt(traced->area_px) + kLittle_px;
    // Values of a fit far outside the light spoil polynomials through few of them.
    if (std::isfinite(ray_set.reach)) {
      t.position_px *= kPreviewShiftOfFitted;
      t.weight = kPreviewWeight;
      t.stop = kPreviewStop;
    }
    return t;
  }
  LevelEstimate spread = brighter(traced, budget.about);
  if (!(spread.area_px >= 1.0 && spread.level > 0.0)) spread = one_pixel(ray_set, pupil_light);
  const double side = std::sqrt(spread.area_px);
  Tolerance t;
  t.level = std::min(spread.level, kPeaks * budget.peak);
  t.colour_px = t.level > kColourLevel * budget.peak ? std::max(kColourShift_px, kColourShift * side) : kNoLimit;
  const double fraction = kFitFraction * (std::isfinite(ray_set.reach) ? kFractionOfFitted : 1.0);
  const double error = fraction * std::sqrt(budget.squared_error) / t.level;  // in levels, summed
  t.position_px = std::clamp(std::min(error / (2.0 * std::sqrt(side)), error / 8.0), least_shift_px(frame),
                             kMaxShift * side + kLittle_px);
  t.stop = 2.0 * t.position_px / side;
  t.lost_mm2 = error * error * t.level / pupil_light;
  t.weight = std::clamp(error / side, 1e-4, 0.5);
  return t;
}

}  // namespace contrejour::inline internal::adaptive
