// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/flare_source.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/units.h"
#include "measure/playback/measured_range.h"

namespace contrejour {
namespace {

constexpr std::string_view kFlareEnding = ".flare.toml";
constexpr double kMinForward = 1e-6;  // z of a direction: beyond it, tangents have no use

// The tangents of a light's angles, to the right and up; light travels away from where the light is.
Vec2 tangents_of(Vec3 direction) { return {-direction.x / direction.z, -direction.y / direction.z}; }

Result<std::vector<FlareLight>> flare_lights(std::span<const Light> lights) {
  std::vector<FlareLight> all;
  for (const Light& light : lights) {
    if (!(light.direction.z > kMinForward)) return invalid_argument("a light is not in front of the camera");
    if (light.radius_rad != 0.0 || light.shape)
      return invalid_argument("a measured flare has the size of the light it was measured with; give lights no size");
    all.push_back({tangents_of(light.direction), light.value});
  }
  return all;
}

// The window of the ideal lens's picture: a millimetre of its sensor is a tangent of 1.
TangentFrame tangent_frame(const Frame& frame) {
  return {frame.width, frame.height, 1.0 / frame.pixel_pitch_mm, frame.pixel_from_sensor({0.0, 0.0})};
}

}  // namespace

bool is_measured_flare(std::string_view name) {
  if (name.size() < kFlareEnding.size()) return false;
  return std::ranges::equal(name.substr(name.size() - kFlareEnding.size()), kFlareEnding, [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == static_cast<unsigned char>(b);
  });
}

Error unknown_field(const MeasuredFlare& flare) {
  return {ErrorCode::InvalidArgument,
          fmt::format("the measured flare \"{}\" does not state the field of its photographs (half_field), so that the "
                      "size of the picture is unknown; give the horizontal field with --hfov",
                      flare.name),
          {}};
}

LensState ideal_lens_of(const MeasuredFlare& flare) {
  LensState lens;
  lens.name = flare.name;
  lens.focal_length_mm = 1.0;
  lens.f_number = flare.exposure ? flare.exposure->f_number : 0.0;
  const Vec2 half = flare.half_field.value_or(Vec2{0.0, 0.0});
  lens.sensor_width_mm = 2.0 * half.x;
  lens.sensor_height_mm = 2.0 * half.y;
  return lens;
}

LensState geometry_of(const FlareSource& source) {
  if (const auto* flare = std::get_if<MeasuredFlare>(&source)) return ideal_lens_of(*flare);
  return std::get<LensState>(source);
}

Result<Flare> render(const MeasuredFlare& flare, std::span<const Light> lights, const Frame& frame,
                     const Context& context) {
  if (!(frame.pixel_pitch_mm > 0.0)) return tl::unexpected(unknown_field(flare));
  const auto placed = flare_lights(lights);
  if (!placed) return tl::unexpected(placed.error());
  const auto start = Clock::now();
  auto image = render_measured(flare, *placed, tangent_frame(frame), context);
  if (!image) return tl::unexpected(image.error());
  Flare drawn{std::move(*image), {}};
  drawn.statistics.method = "measured";
  drawn.statistics.time_ms = {{"draw", ms_since(start)}, {"total", ms_since(start)}};
  drawn.statistics.ghosts_rendered = static_cast<int>(flare.ghosts.size());
  return drawn;
}

Result<Flare> render(const MethodOptions& method, const FlareSource& source, std::span<const Light> lights,
                     const FrameSettings& settings, const Context& context) {
  if (const auto* flare = std::get_if<MeasuredFlare>(&source)) return render(*flare, lights, settings.frame, context);
  return render(method, std::get<LensState>(source), lights, settings, context);
}

std::vector<std::string> range_warnings(const MeasuredFlare& flare, std::span<const Light> lights) {
  std::vector<std::string> warnings;
  for (const Light& light : lights) {
    const double s = length(tangents_of(light.direction));
    if (!(s > flare.s_max)) continue;
    warnings.push_back(fmt::format(
        "a light {:.2f} degrees from the axis is beyond the measured {:.2f} degrees: it is drawn with the "
        "flare at the end of that range, faded to {:.0f} per cent",
        deg_from_rad(std::atan(s)), deg_from_rad(std::atan(flare.s_max)), 100.0 * level_beyond_range(s, flare.s_max)));
  }
  return warnings;
}

}  // namespace contrejour
