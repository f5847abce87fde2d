#include "render/interface/grid_side.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace contrejour {
namespace {

constexpr int kFewestRays = 4, kMostRays = 512;
constexpr double kMostSigma = 1e6, kMostPhi = 4.0;
constexpr double kLowestScale = 0.05;

}  // namespace

Result<void> check_grid(const RenderSettings& settings) {
  const auto refuse = [](std::string message) { return failure(ErrorCode::InvalidArgument, std::move(message)); };
  if (settings.grid < kFewestRays || settings.grid > kMostRays) {
    return refuse(fmt::format("a grid of {} rays a side is out of range; choose {} to {}", settings.grid, kFewestRays,
                              kMostRays));
  }
  if (!(settings.scale_grid_sigma >= 0.0 && settings.scale_grid_sigma <= kMostSigma)) {
    return refuse(fmt::format("a sigma of {} for the grid's scale is out of range; choose 0 to {}",
                              settings.scale_grid_sigma, kMostSigma));
  }
  if (!(settings.scale_grid_phi >= 0.0 && settings.scale_grid_phi <= kMostPhi)) {
    return refuse(fmt::format("a phi of {} for the grid's scale is out of range; choose 0 to {}",
                              settings.scale_grid_phi, kMostPhi));
  }
  return {};
}

int grid_side(const RenderSettings& settings, const LensState& lens, const Rectangle& on_sensor, int fewest) {
  if (!settings.scale_grid) return settings.grid;
  const Vec2 size = on_sensor.high - on_sensor.low;
  const double share = size.x * size.y / (lens.sensor_width_mm * lens.sensor_height_mm);
  const double scale =
      std::clamp(std::pow(share * settings.scale_grid_sigma, settings.scale_grid_phi), kLowestScale, 1.0);
  return std::max(std::min(settings.grid, fewest), static_cast<int>(std::lround(settings.grid * scale)));
}

}  // namespace contrejour
