// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/split_mix.h"
#include "base/units.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/sweep.h"
#include "contrejour/render.h"

namespace contrejour {
namespace {

constexpr double kDirectLevel = 0.5;     // of the white level, in the short exposure
constexpr double kGhostLevel = 0.5;      // of the white level, in one second
constexpr double kBrightQuantile = 0.999;
constexpr double kSurveyScale = 0.25;    // of the picture's size, for the automatic light
constexpr int kSurveyAngles = 5;

// A normal number of variance 1, of a station.
double station_noise(std::uint64_t seed, std::size_t k) {
  const auto unit = [&](std::uint64_t which) {
    return unit_interval(split_mix(split_mix(seed) + (2 * k + which + 1) * kSplitMixIncrement));
  };
  return std::sqrt(-2.0 * std::log(1.0 - unit(0))) * std::cos(2.0 * std::numbers::pi * unit(1));
}

Frame sweep_frame(const LensState& lens, const SweepSettings& settings) {
  Frame frame = frame_on_sensor(lens, settings.width, settings.height);
  frame.shift_mm = {-settings.centre_offset_px.x * frame.pixel_pitch_mm,
                    settings.centre_offset_px.y * frame.pixel_pitch_mm};
  return frame;
}

Light source_at(const SweepSettings& settings, double angle_deg, double value) {
  const double tangent = std::tan(rad_from_deg(angle_deg - settings.zero_deg));
  const double roll = rad_from_deg(settings.roll_deg);
  Light light;
  light.direction = direction_from_angles(std::atan(tangent * std::cos(roll)), 0.0);
  if (roll != 0.0) {  // the head's axis is not quite perpendicular to the picture's rows
    const double up = tangent * std::sin(roll);
    light.direction =
        normalized(Vec3{light.direction.x, light.direction.y - up * light.direction.z, light.direction.z});
  }
  light.value = {value, value, value};
  light.radius_rad = settings.source_radius_rad;
  return light;
}

FrameSettings flare_settings(const Frame& frame, const SweepSettings& settings) {
  FrameSettings flare;
  flare.frame = frame;
  flare.starburst.on = true;
  flare.glare.fraction = settings.scattered;
  return flare;
}

Result<void> check(const SweepSettings& settings) {
  if (settings.width < 2 || settings.height < 2 || settings.width % 2 != 0 || settings.height % 2 != 0) {
    return invalid_argument(fmt::format("raw pictures need an even size: {} x {}", settings.width, settings.height));
  }
  if (settings.angles_deg.empty() || settings.times_s.empty())
    return invalid_argument("a sweep needs angles and times");
  if (!(settings.source_radius_rad >= 0.0 && settings.room_rate >= 0.0 && settings.light_rate >= 0.0)) {
    return invalid_argument("the source's radius and the rates of room and light must not be below 0");
  }
  return {};
}

float largest(const Image& image) { return *std::max_element(image.pixels.begin(), image.pixels.end()); }

Result<std::vector<RawFrame>> exposed(const Image& rate, const SweepSettings& settings, std::uint64_t seed,
                                      const Context& context) {
  std::vector<RawFrame> frames;
  for (const double time_s : settings.times_s) {
    Result<RawFrame> frame = expose(rate, settings.sensor, time_s, ++seed, context);
    if (!frame) return tl::unexpected(frame.error());
    frames.push_back(std::move(*frame));
  }
  return frames;
}

}  // namespace

double largest_angle_deg(const LensState& lens) {
  const Frame frame = frame_on_sensor(lens, 100, 100);
  const Vec3 edge = direction_for_image_point(lens, {0.5 * frame.full_width * frame.pixel_pitch_mm, 0.0}, 550.0);
  return deg_from_rad(std::atan2(std::abs(edge.x), edge.z));
}

std::vector<double> even_angles_deg(double to_deg, int stations) {
  std::vector<double> angles;
  for (int k = 0; k < stations; ++k) angles.push_back(stations > 1 ? to_deg * (2.0 * k / (stations - 1) - 1.0) : 0.0);
  return angles;
}

Result<double> automatic_light_rate(const LensState& lens, const SweepSettings& settings, const Context& context) {
  SweepSettings small = settings;
  small.width = 2 * std::max(static_cast<int>(kSurveyScale * settings.width / 2), 32);
  small.height = 2 * std::max(static_cast<int>(kSurveyScale * settings.height / 2), 32);
  FrameSettings flare = flare_settings(sweep_frame(lens, small), small);
  flare.starburst.on = false;
  flare.glare.fraction = 0.0;
  const double scale = static_cast<double>(small.width) / settings.width;
  const double to_deg = *std::max_element(settings.angles_deg.begin(), settings.angles_deg.end());
  double brightest = 0.0;
  for (int k = 0; k < kSurveyAngles; ++k) {
    const Light light = source_at(small, to_deg * (k + 0.5) / kSurveyAngles, 1.0);
    const Result<Flare> picture = render(AdaptiveOptions{}, lens, std::span(&light, 1), flare, context);
    if (!picture) return tl::unexpected(picture.error());
    brightest = std::max(brightest, quantile_of_samples(picture->image, kBrightQuantile));
  }
  if (!(brightest > 0.0)) return invalid_argument("the lens has no ghost at these angles, so give the light's rate");
  return kGhostLevel * (settings.sensor.white_dn - settings.sensor.black_dn) / (brightest * scale * scale);
}

Result<SweepStation> simulate_station(const LensState& lens, const SweepSettings& settings, std::size_t k,
                                      const Context& context) {
  if (Result<void> ok = check(settings); !ok) return tl::unexpected(ok.error());
  if (k >= settings.angles_deg.size()) return invalid_argument("there is no such station");
  Result<double> light_rate =
      settings.light_rate > 0.0 ? Result<double>(settings.light_rate) : automatic_light_rate(lens, settings, context);
  if (!light_rate) return tl::unexpected(light_rate.error());
  SweepStation station;
  station.angle_deg = settings.angles_deg[k];
  const double angle_deg = station.angle_deg + settings.jitter_deg * station_noise(settings.seed, k);
  const Light light = source_at(settings, angle_deg, *light_rate);
  Result<Flare> flare = render(AdaptiveOptions{}, lens, std::span(&light, 1),
                               flare_settings(sweep_frame(lens, settings), settings), context);
  if (!flare) return tl::unexpected(flare.error());
  Image& rate = flare->image;
  Image room(rate.width, rate.height);
  std::fill(room.pixels.begin(), room.pixels.end(), static_cast<float>(settings.room_rate));
  for (float& value : rate.pixels) value = std::max(value, 0.0F) + static_cast<float>(settings.room_rate);

  const std::uint64_t seed = split_mix(settings.seed + 1000 * (k + 1));
  Result<std::vector<RawFrame>> exposures = exposed(rate, settings, seed, context);
  if (!exposures) return tl::unexpected(exposures.error());
  Result<std::vector<RawFrame>> background = exposed(room, settings, seed + 100, context);
  if (!background) return tl::unexpected(background.error());
  const double time_s =
      kDirectLevel * (settings.sensor.white_dn - settings.sensor.black_dn) / static_cast<double>(largest(rate));
  Result<RawFrame> direct = expose(rate, settings.sensor, time_s, seed + 200, context);
  if (!direct) return tl::unexpected(direct.error());
  station.exposures = std::move(*exposures);
  station.background = std::move(*background);
  station.direct = std::move(*direct);
  return station;
}

}  // namespace contrejour
