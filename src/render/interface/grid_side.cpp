#include "render/interface/grid_side.h"

#include <algorithm>
#include <cmath>

namespace contrejour {
namespace {

constexpr double kLowestScale = 0.05;

}  // namespace

// With sigma = 1, phi = 1/2, as the paper.
int grid_side(const RenderSettings& settings, const LensState& lens, const Rectangle& on_sensor, int fewest) {
  if (!settings.scale_grid) return settings.grid;
  const Vec2 size = on_sensor.high - on_sensor.low;
  const double share = size.x * size.y / (lens.sensor_width_mm * lens.sensor_height_mm);
  const double scale = std::clamp(std::sqrt(share), kLowestScale, 1.0);
  return std::max(std::min(settings.grid, fewest), static_cast<int>(std::lround(settings.grid * scale)));
}

}  // namespace contrejour
