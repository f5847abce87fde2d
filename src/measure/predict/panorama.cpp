// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/panorama.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/tasks.h"

namespace contrejour {
namespace {

constexpr double kMinViewForward = 0.0871557;  // cosine of 85 degrees
constexpr double kAspectTolerance = 0.01;

// A camera's axes in the panorama.
struct CameraAxes {
  Vec3 right, up, forward;
};

CameraAxes axes_of(const CameraView& view) {
  const double sin_a = std::sin(view.azimuth_rad), cos_a = std::cos(view.azimuth_rad);
  const double sin_e = std::sin(view.elevation_rad), cos_e = std::cos(view.elevation_rad);
  const double sin_r = std::sin(view.roll_rad), cos_r = std::cos(view.roll_rad);
  const Vec3 level_right{cos_a, 0.0, -sin_a}, level_up{-sin_e * sin_a, cos_e, -sin_e * cos_a};
  return {level_right * cos_r + level_up * sin_r,
          level_up * cos_r - level_right * sin_r,
          {cos_e * sin_a, sin_e, cos_e * cos_a}};
}

Vec3 direction_of_pixel(const Image& panorama, double x, double y) {
  const double azimuth = (x / panorama.width - 0.5) * 2.0 * std::numbers::pi;
  const double elevation = (0.5 - y / panorama.height) * std::numbers::pi;
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation), std::cos(azimuth) * std::cos(elevation)};
}

double solid_angle_of_row(const Image& panorama, double y) {
  const double elevation = (0.5 - y / panorama.height) * std::numbers::pi;
  return 2.0 * std::numbers::pi / panorama.width * std::numbers::pi / panorama.height * std::cos(elevation);
}

Result<void> check_panorama(const Image& panorama) {
  const bool twice = std::abs(panorama.width - 2.0 * panorama.height) <= kAspectTolerance * panorama.width;
  if (panorama.channels == 3 && panorama.height > 0 && twice) return {};
  return invalid_argument(
      fmt::format("a panorama by latitude and longitude is twice as wide as high and has three channels; this is {} x "
                  "{} x {}",
                  panorama.width, panorama.height, panorama.channels));
}

PanoramaLight light_of_area(const Image& panorama, const Detection& found, const DetectedLight& area) {
  const Image pixels = picture_of_areas(panorama, found, area);
  PanoramaLight light{{0.0, 0.0, 0.0}, {}};
  for (int y = 0; y < pixels.height; ++y) {
    const double row = area.min_y + y + 0.5, solid_angle = solid_angle_of_row(panorama, row);
    for (int x = 0; x < pixels.width; ++x) {
      double weight = 0.0;
      for (int c = 0; c < 3; ++c) {
        const double part = solid_angle * static_cast<double>(pixels.at(x, y, c));
        light.irradiance[static_cast<std::size_t>(c)] += part;
        weight += part;
      }
      if (weight > 0.0)
        light.towards = light.towards + direction_of_pixel(panorama, area.min_x + x + 0.5, row) * weight;
    }
  }
  light.towards = normalized(light.towards);
  return light;
}

// z of the unit vector to the point of the frame that is nearest to these tangents on the line to the centre.
double forward_within(Vec2 tangents, const Frame& frame, double focal_length_mm) {
  const double half_x = 0.5 * frame.full_width * frame.pixel_pitch_mm / focal_length_mm;
  const double half_y = 0.5 * frame.full_height * frame.pixel_pitch_mm / focal_length_mm;
  const double outside = std::max({std::abs(tangents.x) / half_x, std::abs(tangents.y) / half_y, 1.0});
  return 1.0 / std::hypot(length(tangents) / outside, 1.0);
}

// The pixel at a position, the last row for those beyond it; columns continue around.
std::array<double, 3> panorama_pixel(const Image& panorama, int x, int y) {
  const int column = ((x % panorama.width) + panorama.width) % panorama.width;
  const int row = std::clamp(y, 0, panorama.height - 1);
  std::array<double, 3> rgb;
  for (int c = 0; c < 3; ++c) rgb[static_cast<std::size_t>(c)] = static_cast<double>(panorama.at(column, row, c));
  return rgb;
}

std::array<double, 3> panorama_at(const Image& panorama, Vec3 towards) {
  const double azimuth = std::atan2(towards.x, towards.z);
  const double elevation = std::atan2(towards.y, std::hypot(towards.x, towards.z));
  const double x = (azimuth / (2.0 * std::numbers::pi) + 0.5) * panorama.width - 0.5;
  const double y = (0.5 - elevation / std::numbers::pi) * panorama.height - 0.5;
  const double left = std::floor(x), top = std::floor(y), u = x - left, v = y - top;
  const int column = static_cast<int>(left), row = static_cast<int>(top);
  std::array<double, 3> rgb{};
  for (int k = 0; k < 4; ++k) {
    const auto pixel = panorama_pixel(panorama, column + k % 2, row + k / 2);
    const double weight = (k % 2 == 1 ? u : 1.0 - u) * (k / 2 == 1 ? v : 1.0 - v);
    for (std::size_t c = 0; c < 3; ++c) rgb[c] += weight * pixel[c];
  }
  return rgb;
}

}  // namespace

Result<std::vector<PanoramaLight>> lights_of_panorama(const Image& panorama, const DetectionSettings& settings) {
  if (auto ok = check_panorama(panorama); !ok) return tl::unexpected(ok.error());
  const auto found = detect_lights(panorama, settings);
  if (!found) return tl::unexpected(found.error());
  std::vector<PanoramaLight> lights;
  for (const DetectedLight& area : found->lights) lights.push_back(light_of_area(panorama, *found, area));
  return lights;
}

std::vector<Light> lights_in_view(std::span<const PanoramaLight> lights, const CameraView& view, const Frame& frame,
                                  double focal_length_mm) {
  const CameraAxes axes = axes_of(view);
  std::vector<Light> seen;
  for (const PanoramaLight& source : lights) {
    const Vec3 at{dot(source.towards, axes.right), dot(source.towards, axes.up), dot(source.towards, axes.forward)};
    if (at.z < kMinViewForward) continue;
    const double forward = forward_within({at.x / at.z, at.y / at.z}, frame, focal_length_mm);
    // Pixels of a solid angle: (focal length in pixels)^2 / cos^3.
    const double per_irradiance = std::pow(focal_length_mm / frame.pixel_pitch_mm, 2) / std::pow(forward, 3);
    Light light;
    light.direction = {-at.x, -at.y, at.z};
    for (std::size_t c = 0; c < 3; ++c) light.value[c] = source.irradiance[c] * per_irradiance;
    seen.push_back(light);
  }
  return seen;
}

Result<Image> view_of_panorama(const Image& panorama, const CameraView& view, const Frame& frame,
                               double focal_length_mm, const Context& context) {
  if (auto ok = check_panorama(panorama); !ok) return tl::unexpected(ok.error());
  if (frame.width < 1 || frame.height < 1 || !(frame.pixel_pitch_mm > 0.0) || !(focal_length_mm > 0.0))
    return invalid_argument("a view needs pixels and a focal length above 0");
  const CameraAxes axes = axes_of(view);
  Image image(frame.width, frame.height);
  const bool done = parallel_for(static_cast<std::size_t>(frame.height), context, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < frame.width; ++x) {
      const Vec2 sensor_mm = frame.sensor_from_pixel({x + 0.5, y + 0.5});  // x to the picture's left, y down
      const Vec3 towards =
          normalized(axes.forward * focal_length_mm - axes.right * sensor_mm.x - axes.up * sensor_mm.y);
      const auto rgb = panorama_at(panorama, towards);
      for (std::size_t c = 0; c < 3; ++c) image.at(x, y, static_cast<int>(c)) = static_cast<float>(rgb[c]);
    }
  });
  if (!done) return interrupted();
  return image;
}

}  // namespace contrejour
