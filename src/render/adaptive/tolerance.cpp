#include "render/adaptive/tolerance.h"

#include <algorithm>
#include <cmath>

namespace contrejour::adaptive {
namespace {

constexpr double kFitShare = 0.4;  // of the allowed error, that fits may make: theirs is the same all over a ghost
constexpr double kNoLimit = 1e9;
constexpr double kPeaks = 4.0;  // fits of what is so many times brighter than the peak need be no better

}  // namespace

// Edges displaced by d over a length of about 4 L, and levels off by a share w over L^2 pixels.
Tolerance tolerance_for(const RaySheet& sheet, double weight, double shared_flux, const Frame& frame,
                        const ErrorBudget& budget) {
  if (!std::isfinite(budget.squared_error) || !(weight > 0.0)) return {kNoLimit, kNoLimit, kNoLimit, 0.0};
  Vec2 low{kNoLimit, kNoLimit};
  Vec2 high{-kNoLimit, -kNoLimit};
  for (std::size_t k = 0; k < sheet.count(); ++k) {
    if (std::isinf(sheet.r_rel[k])) continue;
    const Vec2 p = Vec2{sheet.sensor_x_mm[k], sheet.sensor_y_mm[k]} * (1.0 / frame.pixel_pitch_mm);
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const Vec2 size{std::max(high.x - low.x, 1.0), std::max(high.y - low.y, 1.0)};
  const double side = std::sqrt(size.x * size.y);
  const Vec2 pupil = sheet.box.high - sheet.box.low;
  const double level = weight * pupil.x * pupil.y * shared_flux / (size.x * size.y);
  Tolerance t;
  t.level = std::min(level, kPeaks * budget.peak);
  const double error = kFitShare * std::sqrt(budget.squared_error) / t.level;  // in levels, summed
  t.position_px = std::clamp(std::min(error / (2.0 * std::sqrt(side)), error / 8.0), 0.005, 0.05 * side + 0.5);
  t.stop = 2.0 * t.position_px / side;
  t.weight = std::clamp(error / side, 1e-4, 0.5);
  return t;
}

}  // namespace contrejour::adaptive
