#include "render/adaptive/tolerance.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/adaptive/sheet_cells.h"

namespace contrejour::adaptive {
namespace {

constexpr double kFitShare = 0.3;  // of the allowed error, that fits may make: theirs is the same all over a ghost
constexpr double kNoLimit = 1e9;
// Of a ghost that bright beside the peak: wavelengths farther apart, in its sizes, give it colours that are seen.
constexpr double kColourLevel = 1e-3, kColourShift = 0.02, kColourShift_px = 1.0;
constexpr double kPeaks = 16.0;  // fits of what is so many times brighter than the peak need be no better

// Of a sheet's image. pupil_light: of a mm^2 of the pupil, which lies evenly over the image of each cell between rays.
// Cells far outside a rim do not count: the rays at a box's border may be flung anywhere. None: no cell counts.
std::optional<Spread> spread_of(const RaySheet& sheet, double pupil_light, const Frame& frame) {
  const SheetCells cells(sheet);
  const double pixel_mm2 = frame.pixel_pitch_mm * frame.pixel_pitch_mm;
  const auto rim = [&](std::size_t k) { return sheet.r_rel[k]; };
  double light = 0.0, squares = 0.0;
  for (std::size_t first = 0; first < cells.end(); ++first) {
    if (!cells.has(first)) continue;
    const auto corners = cells.corners(first);
    const auto [nearest, farthest] = std::ranges::minmax(corners, {}, rim);
    if (std::isinf(rim(farthest)) || rim(nearest) > kNearlyThrough) continue;
    const double here = pupil_light * cells.entrance_mm2(first);
    light += here;
    squares += here * here / std::max(cells.image_mm2(first) / pixel_mm2, 1.0);
  }
  if (!(light > 0.0)) return std::nullopt;
  return Spread{squares / light, light * light / squares};
}

// The same where no cell tells: about what a small frame shows, or else all light in one pixel.
Spread guessed_spread(const RaySheet& sheet, double pupil_light, const Spread& about) {
  constexpr double kGathers = 4.0;  // in so much less of its area
  if (about.area_px > 1.0 && about.level > 0.0)
    return {about.level * kGathers, std::max(about.area_px / kGathers, 1.0)};
  const Vec2 size = sheet.box.high - sheet.box.low;
  return {pupil_light * size.x * size.y, 1.0};
}

}  // namespace

// Edges displaced by d over a length of about 4 L, and levels off by a share w over L^2 pixels.
Tolerance tolerance_for(const RaySheet& sheet, double weight, double shared_flux, const Frame& frame,
                        const ErrorBudget& budget) {
  if (!std::isfinite(budget.squared_error) || !(weight > 0.0)) return {kNoLimit, kNoLimit, kNoLimit, 0.0, kNoLimit};
  const double pupil_light = weight * shared_flux;
  const Spread spread = spread_of(sheet, pupil_light, frame).value_or(guessed_spread(sheet, pupil_light, budget.about));
  const double side = std::sqrt(spread.area_px);
  Tolerance t;
  t.level = std::min(spread.level, kPeaks * budget.peak);
  t.colour_px = t.level > kColourLevel * budget.peak ? std::max(kColourShift_px, kColourShift * side) : kNoLimit;
  const double error = kFitShare * std::sqrt(budget.squared_error) / t.level;  // in levels, summed
  t.position_px = std::clamp(std::min(error / (2.0 * std::sqrt(side)), error / 8.0), 0.005, 0.05 * side + 0.5);
  t.stop = 2.0 * t.position_px / side;
  t.weight = std::clamp(error / side, 1e-4, 0.5);
  return t;
}

}  // namespace contrejour::adaptive
