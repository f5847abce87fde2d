// SPDX-License-Identifier: Apache-2.0
#include "render/planning/grid_side.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace contrejour::inline internal {
namespace {

constexpr int kMinRays = 4, kMaxRays = 512;
constexpr double kMaxSigma = 1e6, kMaxPhi = 4.0;
constexpr double kLowestScale = 0.05;

}  // namespace

Result<void> check_grid(const GridOptions& grid) {
  const auto refuse = [](std::string message) { return failure(ErrorCode::InvalidArgument, std::move(message)); };
  if (grid.rays < kMinRays || grid.rays > kMaxRays) {
    return refuse(
        fmt::format("a grid of {} rays a side is out of range; choose {} to {}", grid.rays, kMinRays, kMaxRays));
  }
  if (!(grid.sigma >= 0.0 && grid.sigma <= kMaxSigma)) {
    return refuse(
        fmt::format("a sigma of {} for the grid's scale is out of range; choose 0 to {}", grid.sigma, kMaxSigma));
  }
  if (!(grid.phi >= 0.0 && grid.phi <= kMaxPhi)) {
    return refuse(fmt::format("a phi of {} for the grid's scale is out of range; choose 0 to {}", grid.phi, kMaxPhi));
  }
  return {};
}

int grid_side(const GridOptions& grid, const LensState& lens, const Rectangle& on_sensor, int min_count) {
  if (!grid.scale) return grid.rays;
  const Vec2 size = on_sensor.high - on_sensor.low;
  const double fraction = size.x * size.y / (lens.sensor_width_mm * lens.sensor_height_mm);
  const double scale = std::clamp(std::pow(fraction * grid.sigma, grid.phi), kLowestScale, 1.0);
  return std::max(std::min(grid.rays, min_count), static_cast<int>(std::lround(grid.rays * scale)));
}

}  // namespace contrejour::inline internal
