// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/pupil_mask.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/tasks.h"
#include "diffraction/polygon_cover.h"

namespace contrejour {
namespace {

constexpr double kFarthest = 1e8;  // samples, of a polygon's corner

// The fraction of the unit square about the origin where normal . p + distance <= 0; normal is unit.
double half_plane_fraction(Vec2 normal, double distance) {
  const double a = std::max(std::abs(normal.x), std::abs(normal.y));
  const double b = std::min(std::abs(normal.x), std::abs(normal.y));
  const double extent = 0.5 * (a + b), straight = 0.5 * (a - b);
  const double d = std::abs(distance);
  if (d >= extent) return distance > 0.0 ? 0.0 : 1.0;
  const double beyond = d <= straight ? 0.5 - d / a : (extent - d) * (extent - d) / (2.0 * a * b);
  return distance > 0.0 ? beyond : 1.0 - beyond;
}

double open_fraction(const std::function<double(Vec2)>& distance_mm, Vec2 p, double pitch_mm) {
  const double d = distance_mm(p) / pitch_mm;
  if (std::abs(d) > 1.0) return d > 0.0 ? 0.0 : 1.0;  // farther than the sample's corners
  const double h = 0.5 * pitch_mm;
  const Vec2 gradient{distance_mm({p.x + h, p.y}) - distance_mm({p.x - h, p.y}),
                      distance_mm({p.x, p.y + h}) - distance_mm({p.x, p.y - h})};
  const double size = length(gradient);
  return size > 0.0 ? half_plane_fraction(gradient * (1.0 / size), d) : 0.5;
}

std::size_t pixels_of(int side) { return static_cast<std::size_t>(side) * static_cast<std::size_t>(side); }

Result<void> check_picture(const Image& image, int channel) {
  if (image.width <= 0 || image.height <= 0 || image.pixels.size() != image.index(0, image.height))
    return failure(ErrorCode::InvalidArgument, "the picture of the aperture is empty");
  if (channel < 0 || channel >= image.channels)
    return failure(
        ErrorCode::InvalidArgument,
        fmt::format("the picture of the aperture has {} channels; there is no channel {}", image.channels, channel));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (!(image.at(x, y, channel) >= 0.0F) || !std::isfinite(image.at(x, y, channel)))
        return failure(ErrorCode::InvalidArgument,
                       fmt::format("the picture of the aperture has the value {} at {},{}; amplitudes are 0 and more",
                                   image.at(x, y, channel), x, y));
  return {};
}

// Interpolates between the four nearest pixels; the outermost ones extend outwards; pixel 0 covers 0..1.
float sample_bilinear(const Image& image, int channel, double x, double y) {
  const double u = std::clamp(x - 0.5, 0.0, image.width - 1.0), v = std::clamp(y - 0.5, 0.0, image.height - 1.0);
  const int x0 = static_cast<int>(u), y0 = static_cast<int>(v);
  const int x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
  const auto s = static_cast<float>(u - x0), t = static_cast<float>(v - y0);
  return (1 - t) * ((1 - s) * image.at(x0, y0, channel) + s * image.at(x1, y0, channel)) +
         t * ((1 - s) * image.at(x0, y1, channel) + s * image.at(x1, y1, channel));
}

}  // namespace

MaskGrid grid_over(double radius_mm, int samples_across) {
  if (!(radius_mm > 0.0) || samples_across < 2 || samples_across > MaskGrid::kMaxSamples - 2) return {0, 0.0};
  return {samples_across + 2, 2.0 * radius_mm / samples_across};
}

double PupilMask::open_area_mm2() const {
  double sum = 0.0;
  for (const float a : amplitude) sum += static_cast<double>(a) * a;
  return sum * grid.pitch_mm * grid.pitch_mm;
}

PupilMask make_mask(const MaskGrid& grid, const std::function<double(Vec2)>& distance_mm, const Context& context) {
  if (!grid.is_usable() || !distance_mm) return {{0, 0.0}, {}, {}};
  PupilMask mask{grid, std::vector<float>(pixels_of(grid.side)), {}};
  parallel_for(static_cast<std::size_t>(grid.side), context, [&](std::size_t row) {
    for (int column = 0; column < grid.side; ++column)
      mask.amplitude[row * static_cast<std::size_t>(grid.side) + static_cast<std::size_t>(column)] = static_cast<float>(
          open_fraction(distance_mm, grid.position_mm(column, static_cast<int>(row)), grid.pitch_mm));
  });
  return mask;
}

PupilMask make_mask(const MaskGrid& grid, const IrisOpening& opening, double stop_radius_mm, const Context& context) {
  return make_mask(
      grid, [&](Vec2 mm) { return stop_radius_mm * opening.bound_distance(mm * (1.0 / stop_radius_mm)); }, context);
}

Result<PupilMask> mask_of_image(const Image& image, int channel, double width_mm) {
  if (const auto good = check_picture(image, channel); !good) return tl::unexpected(good.error());
  const int side = std::max(image.width, image.height);
  if (!MaskGrid{side, width_mm / side}.is_usable())
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("an aperture of {} samples cannot be {} mm wide", side, width_mm));
  PupilMask mask{{side, width_mm / side}, std::vector<float>(pixels_of(side)), {}};
  const int left = (side - image.width) / 2, top = (side - image.height) / 2;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      mask.amplitude[static_cast<std::size_t>(y + top) * static_cast<std::size_t>(side) +
                     static_cast<std::size_t>(x + left)] = image.at(x, y, channel);
  return mask;
}

Result<PupilMask> with_dirt(PupilMask mask, const Image& dirt, int channel) {
  if (const auto good = check_picture(dirt, channel); !good) return tl::unexpected(good.error());
  if (!mask.is_complete()) return failure(ErrorCode::InvalidArgument, "the mask has not a sample for each place");
  const double scale_x = static_cast<double>(dirt.width) / mask.grid.side;
  const double scale_y = static_cast<double>(dirt.height) / mask.grid.side;
  std::size_t k = 0;
  for (int y = 0; y < mask.grid.side; ++y)
    for (int x = 0; x < mask.grid.side; ++x)
      mask.amplitude[k++] *= sample_bilinear(dirt, channel, (x + 0.5) * scale_x, (y + 0.5) * scale_y);
  return mask;
}

void dim(PupilMask& mask, MaskPower& power, std::span<const DimPolygon> polygons) {
  power.resize(mask.amplitude.size(), 1.0F);
  if (!mask.is_complete()) return;
  PolygonCover cover(mask.grid.side);
  const double per_mm = 1.0 / mask.grid.pitch_mm, half = 0.5 * mask.grid.side;
  std::vector<Vec2> corners;
  for (const DimPolygon& polygon : polygons) {
    const double lost = 1.0 - (polygon.transmission >= 0.0 ? std::min(polygon.transmission, 1.0) : 0.0);
    const double amplitude_lost = 1.0 - std::sqrt(1.0 - lost);
    corners.clear();
    for (const Vec2 p : polygon.corners_mm) corners.push_back({half + p.x * per_mm, half - p.y * per_mm});
    const bool is_near = std::all_of(corners.begin(), corners.end(),
                                     [](Vec2 p) { return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest; });
    if (!is_near || corners.size() < 3) continue;
    cover.for_each(corners, [&](std::size_t sample, double fraction) {
      mask.amplitude[sample] *= static_cast<float>(1.0 - fraction * amplitude_lost);
      power[sample] *= static_cast<float>(1.0 - fraction * lost);
    });
  }
}

}  // namespace contrejour
