// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/ghost_pixels.h"

#include <algorithm>
#include <cmath>

#include "measure/model/flare_curves.h"
#include "measure/model/outline_cubic.h"
#include "measure/model/outline_distance.h"
#include "measure/model/pixel_samples.h"

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

struct PixelShade {
  ShadeWeights weights;
  std::array<ShadeWeights, kShapeCurves> by_shape{};
};

// The weights, and their derivatives with respect to centre, half width, skew, half height, roundness, its skew, widths
// and slopes of the shade, and the circle that cuts the outline. A half width widens both sides, a skew moves the left
// side inwards and the right one outwards; a fade is its width times slope + 1.
PixelShade pixel_shade(const GhostAtAngle& ghost, const OutlinePoint& nearest, double pixel, bool with_derivatives) {
  if (!with_derivatives) return {shade_weights(ghost.shade, nearest.distance, pixel), {}};
  const auto outline = distance_gradient(ghost.outline, nearest);
  const ShadeDerivatives shade = shade_derivatives(ghost.shade, nearest.distance, pixel);
  const std::array<double, 6> distances{outline[0], outline[1] + outline[2], outline[2] - outline[1],
                                        outline[3], outline[4] + outline[5], outline[5] - outline[4]};
  PixelShade all{shade.weights, {}};
  auto& by_shape = all.by_shape;
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
  for (const std::size_t k : {kClipCentre, kClipRadius}) {
    const double distance = outline[kCubicParameters + k - kClipCentre];
    by_shape[k] = {shade.by_distance.border * distance, shade.by_distance.inside * distance};
  }
  return all;
}

// A pixel of a ghost with a profile: the level there, and how it changes as the ghost moves and grows.
template <class Pixel>
void add_profile(const GhostAtAngle& ghost, Vec2 point, bool with_derivatives, Pixel& pixel) {
  pixel.inside = ghost.inside_at(point);
  if (!with_derivatives) return;
  const ProfileWeights weights = profile_weights(ghost.outline, point);
  const GhostOutline& o = ghost.outline;
  const bool is_left = point.x < o.centre;
  const double side = is_left ? o.left : o.right;
  const double x = (point.x - o.centre) / side, y = point.y / o.half_height;
  for (std::size_t c = 0; c < pixel.inside.size(); ++c) {
    Vec2 by_place{};
    for (std::size_t k = 0; k < weights.term.size(); ++k)
      by_place = by_place + weights.by_place[k] * ghost.profile[weights.term[k]][c];
    if (pixel.inside[c] == 0.0) by_place = {};  // held at 0
    const double by_side = -by_place.x * x / side;
    pixel.inside_by_shape[0][c] = -by_place.x / side;
    pixel.inside_by_shape[1][c] = by_side;
    pixel.inside_by_shape[2][c] = is_left ? -by_side : by_side;
    pixel.inside_by_shape[3][c] = -by_place.y * y / o.half_height;
  }
}

// A ghost in a station's pixels.
struct PlacedShape {
  const GhostAtAngle& ghost;
  const StationFrame& frame;
  OutlineDistance distance;
  Vec2 along;  // to the light, in pixels, y down
  double pixel = 0;  // its width as a tangent
  double reach_out = 0, reach_in = 0;  // distances beyond which the shade is constant over a pixel
  int across = 1;  // squares that each side of a pixel is divided into

  [[nodiscard]] OutlinePoint nearest(double x, double y) const {
    const Vec2 offset = (Vec2{x, y} - frame.pixels.centre_px) * pixel;
    return distance.nearest({dot(offset, along), cross(along, offset)});
  }
  // Whether pixels far inside depend on one level, or on a profile alone; fits give a ghost one of them.
  [[nodiscard]] bool has_interior() const { return !ghost.has_profile || ghost.inside == Rgb{}; }
  [[nodiscard]] std::uint32_t index(int x, int y) const {
    return static_cast<std::uint32_t>(y * frame.pixels.width + x);
  }
};

void add_weights(const ShadeWeights& from, double factor, ShadeWeights& to) {
  to.border += factor * from.border;
  to.inside += factor * from.inside;
}

// The means of the weights and their derivatives over the squares of a pixel.
void add_squares(const PlacedShape& shape, int x, int y, bool with_derivatives, GhostPixel& pixel) {
  const double step = 1.0 / shape.across, width = shape.pixel * step, part = step * step;
  for (int k = 0; k < shape.across * shape.across; ++k) {
    const OutlinePoint nearest =
        shape.nearest(x + (k % shape.across + 0.5) * step, y + (k / shape.across + 0.5) * step);  // NOLINT
    if (nearest.distance > shape.reach_out) continue;
    const PixelShade shade = pixel_shade(shape.ghost, nearest, width, with_derivatives);
    add_weights(shade.weights, part, pixel.weights);
    for (std::size_t i = 0; i < kShapeCurves && with_derivatives; ++i)
      add_weights(shade.by_shape[i], part, pixel.by_shape[i]);
  }
}

// A pixel that the inside's level has alone.
void add_inside(const PlacedShape& shape, std::uint32_t index, bool with_derivatives, GhostPixels& pixels) {
  if (!shape.ghost.has_profile) return pixels.flat.push_back(index);
  pixels.inner.push_back({index, {}, {}});
  add_profile(shape.ghost, point_of(shape.frame, index), with_derivatives, pixels.inner.back());
}

constexpr int kBlockSide = 8;

// The pixels of a block: distances change by no more than one moves, so that of its middle may decide for all.
void add_block(const PlacedShape& shape, PixelRange columns, PixelRange rows, bool with_derivatives,
               GhostPixels& pixels) {
  const double half_width = 0.5 * (columns.last - columns.first), half_height = 0.5 * (rows.last - rows.first);
  const double radius = shape.pixel * std::hypot(half_width, half_height);
  const double middle = shape.nearest(columns.first + half_width, rows.first + half_height).distance;
  if (middle > shape.reach_out + radius) return;
  const bool all_flat = shape.has_interior() && middle < -(shape.reach_in + radius);
  for (int y = rows.first; y < rows.last; ++y) {
    for (int x = columns.first; x < columns.last; ++x) {
      if (!shape.frame.is_sampled(x, y)) continue;
      if (all_flat) {
        add_inside(shape, shape.index(x, y), with_derivatives, pixels);
        continue;
      }
      if (shape.across > 1) {
        pixels.near_border.push_back({shape.index(x, y), {}, {}, shape.ghost.inside, {}});
        add_squares(shape, x, y, with_derivatives, pixels.near_border.back());
        if (shape.ghost.has_profile)
          add_profile(shape.ghost, point_of(shape.frame, shape.index(x, y)), with_derivatives,
                      pixels.near_border.back());
        continue;
      }
      const OutlinePoint nearest = shape.nearest(x + 0.5, y + 0.5);
      if (nearest.distance > shape.reach_out) continue;
      if (shape.has_interior() && nearest.distance < -shape.reach_in) {
        add_inside(shape, shape.index(x, y), with_derivatives, pixels);
        continue;
      }
      const PixelShade shade = pixel_shade(shape.ghost, nearest, shape.pixel, with_derivatives);
      pixels.near_border.push_back({shape.index(x, y), shade.weights, shade.by_shape, shape.ghost.inside, {}});
      if (shape.ghost.has_profile)
        add_profile(shape.ghost, point_of(shape.frame, shape.index(x, y)), with_derivatives, pixels.near_border.back());
    }
  }
}

}  // namespace

Vec2 point_of(const StationFrame& frame, std::uint32_t index) {
  const auto width = static_cast<std::uint32_t>(frame.pixels.width);
  const Vec2 middle{index % width + 0.5, index / width + 0.5};
  const Vec2 offset = (middle - frame.pixels.centre_px) * (1.0 / frame.pixels.focal_length_px);
  const Vec2 along{frame.to_light.x, -frame.to_light.y};
  return {dot(offset, along), cross(along, offset)};
}

GhostPixels ghost_pixels(const GhostAtAngle& ghost, const StationFrame& frame, bool with_derivatives) {
  const double scale = frame.pixels.focal_length_px, pixel = 1.0 / scale;
  const PlacedShape shape{ghost,
                          frame,
                          OutlineDistance(ghost.outline),
                          {frame.to_light.x, -frame.to_light.y},
                          pixel,
                          ghost.shade.fade_out + 0.5 * pixel,
                          ghost.shade.fade_in + 0.5 * pixel,
                          samples_across(ghost.outline, pixel)};
  const double radius =
      std::hypot(std::max(ghost.outline.left, ghost.outline.right), ghost.outline.half_height) + shape.reach_out;
  const Vec2 origin = frame.pixels.centre_px + shape.along * (scale * ghost.outline.centre);
  const PixelRange rows = range_of(origin.y - scale * radius, origin.y + scale * radius, frame.pixels.height);
  const PixelRange columns = range_of(origin.x - scale * radius, origin.x + scale * radius, frame.pixels.width);
  GhostPixels pixels;
  for (int y = rows.first; y < rows.last; y += kBlockSide) {
    for (int x = columns.first; x < columns.last; x += kBlockSide) {
      add_block(shape, {x, std::min(x + kBlockSide, columns.last)}, {y, std::min(y + kBlockSide, rows.last)},
                with_derivatives, pixels);
    }
  }
  return pixels;
}

}  // namespace contrejour::inline internal
