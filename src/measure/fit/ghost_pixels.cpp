// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/ghost_pixels.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal {
namespace {

// Rows and columns of a picture: [first, last).
struct PixelRange {
  int first = 0, last = 0;
};

PixelRange range_of(double low, double high, int size) {
  const auto within = [&](double x) { return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(size))); };
  return {within(std::floor(low)), within(std::ceil(high))};
}

// Derivatives with respect to centre, half width, skew, half height, roundness, its skew, widths and slopes of the
// shade. A half width widens both sides, a skew moves the left side inwards and the right one outwards; a fade is its
// width times slope + 1.
std::array<ShadeWeights, kShapeCurves> by_shape_of(const GhostAtAngle& ghost, const OutlinePoint& nearest,
                                                   double pixel) {
  const auto outline = distance_gradient(ghost.outline, nearest);
  const ShadeDerivatives shade = shade_derivatives(ghost.shade, nearest.distance, pixel);
  const std::array<double, 6> distances{outline[0], outline[1] + outline[2], outline[2] - outline[1],
                                        outline[3], outline[4] + outline[5], outline[5] - outline[4]};
  std::array<ShadeWeights, kShapeCurves> by_shape{};
  for (std::size_t k = 0; k < distances.size(); ++k) {
    by_shape[k] = {shade.by_distance.border * distances[k], shade.by_distance.inside * distances[k]};
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const double slope = side == 0 ? ghost.shade.slope_in : ghost.shade.slope_out;
    const double width = (side == 0 ? ghost.shade.fade_in : ghost.shade.fade_out) / (slope + 1.0);
    const ShadeWeights by_fade = shade.by_shade[side], by_slope = shade.by_shade[2 + side];
    by_shape[6 + side] = {(slope + 1.0) * by_fade.border, (slope + 1.0) * by_fade.inside};
    by_shape[8 + side] = {by_slope.border + width * by_fade.border, by_slope.inside + width * by_fade.inside};
  }
  return by_shape;
}

}  // namespace

std::vector<GhostPixel> ghost_pixels(const GhostAtAngle& ghost, const StationFrame& frame) {
  const double scale = frame.pixels.focal_length_px, pixel = 1.0 / scale;
  const double reach = ghost.shade.fade_out + 0.5 * pixel;
  const double radius =
      std::hypot(std::max(ghost.outline.left, ghost.outline.right), ghost.outline.half_height) + reach;
  const Vec2 along{frame.to_light.x, -frame.to_light.y};  // in pixels, y down
  const Vec2 origin = frame.pixels.centre_px + along * (scale * ghost.outline.centre);
  const PixelRange rows = range_of(origin.y - scale * radius, origin.y + scale * radius, frame.pixels.height);
  const PixelRange columns = range_of(origin.x - scale * radius, origin.x + scale * radius, frame.pixels.width);
  std::vector<GhostPixel> pixels;
  for (int y = rows.first; y < rows.last; ++y) {
    for (int x = columns.first; x < columns.last; ++x) {
      const Vec2 offset = (Vec2{x + 0.5, y + 0.5} - frame.pixels.centre_px) * pixel;
      const OutlinePoint nearest = nearest_point(ghost.outline, {dot(offset, along), cross(along, offset)});
      if (nearest.distance > reach) continue;
      pixels.push_back({static_cast<std::uint32_t>(y * frame.pixels.width + x),
                        shade_weights(ghost.shade, nearest.distance, pixel), by_shape_of(ghost, nearest, pixel)});
    }
  }
  return pixels;
}

}  // namespace contrejour::inline internal
