// SPDX-License-Identifier: Apache-2.0
#include "render/planning/grid_side.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace contrejour::inline internal {
namespace {

constexpr int kFewestRays = 4, kMostRays = 512;
constexpr double kMostSigma = 1e6, kMostPhi = 4.0;
constexpr double kLowestScale = 0.05;

}  // namespace

Result<void> check_grid(const GridOptions& grid) {
  const auto refuse = [](std::string message) { return failure(ErrorCode::InvalidArgument, std::move(message)); };
  if (grid.rays < kFewestRays || grid.rays > kMostRays) {
    return refuse(
        fmt::format("a grid of {} rays a side is out of range; choose {} to {}", grid.rays, kFewestRays, kMostRays));
  }
  if (!(grid.sigma >= 0.0 && grid.sigma <= kMostSigma)) {
    return refuse(
        fmt::format("a sigma of {} for the grid's scale is out of range; choose 0 to {}", grid.sigma, kMostSigma));
  }
  if (!(grid.phi >= 0.0 && grid.phi <= kMostPhi)) {
    return refuse(fmt::format("a phi of {} for the grid's scale is out of range; choose 0 to {}", grid.phi, kMostPhi));
  }
  return {};
}

int grid_side(const GridOptions& grid, const LensState& lens, const Rectangle& on_sensor, int fewest) {
  if (!grid.scale) return grid.rays;
  const Vec2 size = on_sensor.high - on_sensor.low;
  const double share = size.x * size.y / (lens.sensor_width_mm * lens.sensor_height_mm);
  const double scale = std::clamp(std::pow(share * grid.sigma, grid.phi), kLowestScale, 1.0);
  return std::max(std::min(grid.rays, fewest), static_cast<int>(std::lround(grid.rays * scale)));
}

}  // namespace contrejour::inline internal
