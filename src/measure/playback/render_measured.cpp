// SPDX-License-Identifier: Apache-2.0
// The picture of a measured flare: bands of rows in parallel, each of blocks that a ghost misses, fills or crosses.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "base/tasks.h"
#include "contrejour/expert/measured_flare.h"
#include "measure/model/outline_cubic.h"
#include "measure/model/pixel_samples.h"
#include "measure/playback/ghost_row.h"
#include "measure/playback/measured_range.h"

namespace contrejour {
namespace {

constexpr int kBlock = 16;
constexpr double kMaxPixels = 268435456.0;  // as for other renderers
constexpr double kBlockRadius = 0.7071067811865476 * kBlock;
constexpr double kMinHalfAxis_px = 0.02;  // floats leave the sides of a slimmer outline uncertain
constexpr double kSlack_px = 0.6;        // half a pixel, and the kernel's error

// A ghost of one light in the picture's pixels, y down.
struct PlacedGhost {
  GhostPacket packet;
  Vec2 origin;  // middle of the ghost's axis
  Vec2 along;   // from the optical centre to the light, unit
  double reach = 0;  // no light farther from the origin
  double band_in = 0, band_out = 0;  // beyond these distances inside and outside the border, the level is constant
  int across = 1;  // squares that each side of a pixel is divided into: the packet's unit of length is one of them
};

// The outline scaled to pixels and moved to its own origin.
GhostOutline in_pixels(const GhostOutline& o, double scale) {
  const auto sized = [scale](double half_axis) { return std::max(scale * half_axis, kMinHalfAxis_px); };
  return {0.0, sized(o.left), sized(o.right), sized(o.half_height), o.round_left, o.round_right};
}

PlacedGhost placed(const GhostAtAngle& ghost, Vec2 along, const Rgb& value, const TangentFrame& frame) {
  PlacedGhost at;
  at.across = samples_across(ghost.outline, 1.0 / frame.focal_length_px);
  const double scale = frame.focal_length_px * at.across, per_pixel = 1.0 / (scale * scale);
  const GhostOutline outline = in_pixels(ghost.outline, scale);
  const std::array<OutlineCubic, 2> cubics{left_cubic(outline), right_cubic(outline)};
  for (std::size_t k = 0; k < 2; ++k) {
    const std::array<Vec2, 4> coefficients = cubics[k].power_basis();
    for (std::size_t i = 0; i < coefficients.size(); ++i) {
      at.packet.x[k][i] = static_cast<float>(coefficients[i].x);
      at.packet.y[k][i] = static_cast<float>(coefficients[i].y);
    }
  }
  at.packet.fade_in = static_cast<float>(scale * ghost.shade.fade_in);
  at.packet.fade_out = static_cast<float>(scale * ghost.shade.fade_out);
  at.packet.slope_in = static_cast<float>(ghost.shade.slope_in);
  at.packet.slope_out = static_cast<float>(ghost.shade.slope_out);
  for (std::size_t c = 0; c < 3; ++c) {
    at.packet.border[c] = static_cast<float>(ghost.border[c] * value[c] * per_pixel);
    at.packet.inside[c] = static_cast<float>(ghost.inside[c] * value[c] * per_pixel);
  }
  at.packet.has_profile = ghost.has_profile;
  for (std::size_t k = 0; k < kProfileTerms && ghost.has_profile; ++k) {
    for (std::size_t c = 0; c < 3; ++c)
      at.packet.profile[c][k] = static_cast<float>(ghost.profile[k][c] * value[c] * per_pixel);
  }
  at.packet.clip_x = static_cast<float>(scale * (ghost.outline.clip_centre - ghost.outline.centre));
  at.packet.clip_radius = static_cast<float>(scale * ghost.outline.clip_radius);
  at.packet.per_left = static_cast<float>(1.0 / outline.left);
  at.packet.per_right = static_cast<float>(1.0 / outline.right);
  at.packet.per_height = static_cast<float>(1.0 / outline.half_height);
  at.along = {along.x, -along.y};
  at.origin = frame.centre_px + at.along * (frame.focal_length_px * ghost.outline.centre);
  at.band_in = frame.focal_length_px * ghost.shade.fade_in + kSlack_px;
  at.band_out = frame.focal_length_px * ghost.shade.fade_out + kSlack_px;
  at.reach = std::hypot(std::max(outline.left, outline.right), outline.half_height) / at.across + at.band_out;
  return at;
}

void place_light(const MeasuredFlare& flare, const FlareLight& light, const TangentFrame& frame,
                 std::vector<PlacedGhost>& ghosts) {
  const double s = length(light.position);
  const double level = level_beyond_range(s, flare.s_max);
  if (level <= 0.0) return;
  const Vec2 along = s > 0.0 ? light.position * (1.0 / s) : Vec2{1.0, 0.0};
  const Rgb value{level * light.value[0], level * light.value[1], level * light.value[2]};
  for (const MeasuredGhost& ghost : flare.ghosts) {
    if (const auto at = ghost_at(ghost, std::min(s, flare.s_max), flare.s_max)) {
      ghosts.push_back(placed(*at, along, value, frame));
    }
  }
}

// A row of points in the ghost's own axes; (x, y) in the picture.
PixelLine line_of(const PlacedGhost& ghost, double x, double y, double step) {
  const Vec2 offset = (Vec2{x, y} - ghost.origin) * ghost.across;
  step *= ghost.across;
  return {static_cast<float>(dot(offset, ghost.along)), static_cast<float>(cross(ghost.along, offset)),
          static_cast<float>(step * ghost.along.x), static_cast<float>(-step * ghost.along.y)};
}

// A row of a block inside the ghost, beyond its border's reach.
void fill(const PlacedGhost& at, int left, int y, std::size_t count, float* rgb) {
  const GhostPacket& ghost = at.packet;
  if (ghost.has_profile) return add_inside(ghost, line_of(at, left + 0.5, y + 0.5, 1.0), count, rgb);
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t c = 0; c < 3; ++c) rgb[3 * k + c] += ghost.inside[c];
  }
}

// Pixels of a row, each the sum over its squares.
void add_squares(const PlacedGhost& ghost, int left, int y, std::size_t count, float* rgb) {
  const auto across = static_cast<std::size_t>(ghost.across);
  const double step = 1.0 / ghost.across;
  std::vector<float> squares(3 * across * count);
  for (int row = 0; row < ghost.across; ++row) {
    std::ranges::fill(squares, 0.0F);
    add_ghost(ghost.packet, line_of(ghost, left + 0.5 * step, y + (row + 0.5) * step, step), across * count,
              squares.data());
    for (std::size_t k = 0; k < across * count; ++k) {
      for (std::size_t c = 0; c < 3; ++c) rgb[3 * (k / across) + c] += squares[3 * k + c];
    }
  }
}

// Rows from `top` to `bottom` of the ghost. Distances change by no more than one moves, so that of a block's middle
// says whether the block is wholly outside, wholly inside, or to be drawn pixel by pixel.
void add_band(const PlacedGhost& ghost, int top, int bottom, Image& image) {
  const double middle = 0.5 * (top + bottom);
  if (std::abs(middle - ghost.origin.y) > ghost.reach + 0.5 * kBlock) return;
  const int blocks = (image.width + kBlock - 1) / kBlock;
  const double first_px = (ghost.origin.x - ghost.reach) / kBlock, last_px = (ghost.origin.x + ghost.reach) / kBlock;
  const int first = static_cast<int>(std::clamp(std::floor(first_px), 0.0, static_cast<double>(blocks)));
  const int last = static_cast<int>(std::clamp(std::floor(last_px) + 1.0, 0.0, static_cast<double>(blocks)));
  if (first >= last) return;
  std::vector<float> distances(static_cast<std::size_t>(last - first));
  ghost_distances(ghost.packet, line_of(ghost, (first + 0.5) * kBlock, middle, kBlock), distances.size(),
                  distances.data());
  for (int block = first; block < last; ++block) {
    const double distance = static_cast<double>(distances[static_cast<std::size_t>(block - first)]) / ghost.across;
    if (distance > ghost.band_out + kBlockRadius) continue;
    const int left = block * kBlock;
    const auto count = static_cast<std::size_t>(std::min(kBlock, image.width - left));
    for (int y = top; y < bottom; ++y) {
      float* rgb = &image.at(left, y);
      if (ghost.across > 1) {
        add_squares(ghost, left, y, count, rgb);
      } else if (distance < -(ghost.band_in + kBlockRadius)) {
        fill(ghost, left, y, count, rgb);
      } else {
        add_ghost(ghost.packet, line_of(ghost, left + 0.5, y + 0.5, 1.0), count, rgb);
      }
    }
  }
}

Result<void> check_request(std::span<const FlareLight> lights, const TangentFrame& frame) {
  if (frame.width < 1 || frame.height < 1 || static_cast<double>(frame.width) * frame.height > kMaxPixels) {
    return invalid_argument(fmt::format("a frame of {} x {} pixels cannot be rendered", frame.width, frame.height));
  }
  if (!(frame.focal_length_px > 0.0 && std::isfinite(frame.focal_length_px))) {
    return invalid_argument(fmt::format("the focal length must be above 0 pixels: {:g}", frame.focal_length_px));
  }
  for (const FlareLight& light : lights) {
    const bool finite = std::isfinite(light.position.x) && std::isfinite(light.position.y) &&
                        std::ranges::all_of(light.value, [](double v) { return std::isfinite(v); });
    if (!finite) return invalid_argument("a light's position or value is not finite");
  }
  return {};
}

}  // namespace

Result<Image> render_measured(const MeasuredFlare& flare, std::span<const FlareLight> lights, const TangentFrame& frame,
                              const Context& context) {
  if (Result<void> ok = check_flare(flare); !ok) return tl::unexpected(ok.error());
  if (Result<void> ok = check_request(lights, frame); !ok) return tl::unexpected(ok.error());
  std::vector<PlacedGhost> ghosts;
  for (const FlareLight& light : lights) place_light(flare, light, frame, ghosts);
  Image image(frame.width, frame.height);
  const auto bands = static_cast<std::size_t>((frame.height + kBlock - 1) / kBlock);
  const bool done = parallel_for(bands, context, [&](std::size_t band) {
    const int top = static_cast<int>(band) * kBlock;
    const int bottom = std::min(top + kBlock, frame.height);
    for (const PlacedGhost& ghost : ghosts) add_band(ghost, top, bottom, image);
  });
  if (!done) return interrupted();
  return image;
}

}  // namespace contrejour
