// SPDX-License-Identifier: Apache-2.0
// Values -> lights, and the settings of light detection.
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "contrejour/expert/moving_light.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/trace.h"
#include "settings/photometry.h"

namespace contrejour::params {
namespace {

constexpr double kMaxLightAngle_deg = 89.9;  // beyond, no light meets the front of a lens
constexpr Vec2 kDefaultLight_uv{0.70, 0.33};  // bodonyi2023's light

Result<Vec3> direction_of_angles(Vec2 angles_deg) {
  if (std::abs(angles_deg.x) > kMaxLightAngle_deg || std::abs(angles_deg.y) > kMaxLightAngle_deg) {
    return invalid_argument(
        fmt::format("a light at {},{} degrees is not in front of the camera; give angles from -{} to {} degrees",
                    angles_deg.x, angles_deg.y, kMaxLightAngle_deg, kMaxLightAngle_deg));
  }
  return direction_from_angles(angles_deg.x * kDegree_rad, angles_deg.y * kDegree_rad);
}

// Sets the light's spectrum and value. A value per channel already contains the light's colour.
Result<Light> with_colour(Light light, const LightValue& value, const LightColour& colour, ColourSpace space) {
  light.spectrum = colour.spectrum;
  light.value = value.rgb;
  if (value.per_channel) {
    if (!colour.rgb) return light;
    return invalid_argument(
        "a light has R,G,B for both its value and its colour; give one of them as a single "
        "number or a name");
  }
  const Rgb tint = colour.rgb ? *colour.rgb : rgb_of(colour.spectrum, space);
  for (std::size_t c = 0; c < tint.size(); ++c) light.value[c] *= tint[c];
  return light;
}

// Makes lights from their texts, with the common values where a text has none.
struct LightMaker {
  const Values& values;
  const LensState& lens;
  const Frame& frame;
  ColourSpace space;
  LightValue value;
  LightColour colour;
  double distance_mm;
  Exposure exposure;

  // Errors: a file that the colour names may have been removed since the value was checked.
  static Result<LightMaker> create(const Values& values, const LensState& lens, const Frame& frame, ColourSpace space) {
    const auto colour = parse_light_colour(*values.text("colour"));
    if (!colour) return tl::unexpected(colour.error());
    return LightMaker{values,
                      lens,
                      frame,
                      space,
                      *parse_light_value(*values.text("value")),
                      *colour,
                      *parse_distance_mm(*values.text("light-distance")),
                      {values.number("iso"), *parse_shutter(*values.text("shutter"))}};
  }

  // path: the directions of the text's.
  [[nodiscard]] Result<Light> make(std::span<const Vec3> path, const LightText& text) const {
    Light light;
    light.direction = path[path.size() / 2];
    light.distance_mm = text.distance_mm.value_or(distance_mm);
    light.radius_rad = 0.5 * text.size_deg.value_or(values.number("light-size")) * kDegree_rad;
    LightValue own = text.value.value_or(value);
    const auto sum = sum_of(own, light, lens, frame, exposure);
    if (!sum) return tl::unexpected(sum.error());
    if (!own.per_channel) own.rgb = {*sum, *sum, *sum};
    auto coloured = with_colour(light, own, text.colour.value_or(colour), space);
    if (!coloured || path.size() == 1) return coloured;
    return swept_light(std::move(*coloured), path);
  }

  [[nodiscard]] Result<Light> make_by_angles(const LightText& text) const {
    std::vector<Vec3> path;
    for (const Vec2 angles_deg : text.path) {
      const auto direction = direction_of_angles(angles_deg);
      if (!direction) return tl::unexpected(direction.error());
      path.push_back(*direction);
    }
    return make(path, text);
  }

  [[nodiscard]] Result<Light> make_by_image(const LightText& text) const {
    std::vector<Vec3> path;
    for (const Vec2 uv : text.path)
      path.push_back(direction_for_image_point(lens, frame.sensor_from_uv(uv), lens.design_wavelength_nm,
                                               text.distance_mm.value_or(distance_mm)));
    return make(path, text);
  }
};

}  // namespace

Result<std::vector<Light>> given_lights(const Values& values, const LensState& lens, const Frame& frame,
                                        ColourSpace space) {
  const auto maker = LightMaker::create(values, lens, frame, space);
  if (!maker) return tl::unexpected(maker.error());
  std::vector<Light> all;
  for (const auto& [name, make] :
       {std::pair("light", &LightMaker::make_by_angles), std::pair("light-at", &LightMaker::make_by_image)}) {
    for (const std::string& given : values.list(name)) {
      const auto text = parse_light(given);
      if (!text) return tl::unexpected(text.error());
      const auto light = ((*maker).*make)(*text);
      if (!light) return tl::unexpected(light.error());
      all.push_back(*light);
    }
  }
  return all;
}

Result<std::vector<Light>> lights(const Values& values, const LensState& lens, const Frame& frame, ColourSpace space) {
  auto all = given_lights(values, lens, frame, space);
  if (!all || !all->empty()) return all;
  const auto maker = LightMaker::create(values, lens, frame, space);
  if (!maker) return tl::unexpected(maker.error());
  LightText text;
  text.path = {kDefaultLight_uv};
  const auto light = maker->make_by_image(text);
  if (!light) return tl::unexpected(light.error());
  return std::vector<Light>{*light};
}

double gain(const Values& values) { return values.number("gain") * std::exp2(values.number("stops")); }

DetectionSettings detection_settings(const Values& values) {
  DetectionSettings settings;
  settings.threshold = values.real("threshold");
  settings.softness = values.number("softness");
  settings.max_lights = values.integer("max-lights");
  settings.min_pixels = values.integer("min-pixels");
  settings.max_value = values.number("max-value");
  return settings;
}

}  // namespace contrejour::params
