// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/flare_plan.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/settings.h"
#include "contrejour/expert/spectrum_file.h"
#include "contrejour/expert/trace.h"

namespace contrejour {
namespace {

using params::Values;

constexpr double kPoint_px = 1.0;         // root mean square radius: a smaller light is a point
constexpr int kLargestShape_px = 512;     // on a side of a shape
constexpr int kMostImages = 32;  // lights with a starburst of their own where the lights of ghosts are merged

Light light_of(const DetectedLight& area, const Spectrum& spectrum, const PixelGrid& grid, const LensState& lens,
               const Values& values) {
  const double gain = params::gain(values);
  Light light;
  light.distance_mm = *params::parse_distance_mm(*values.text("light-distance"));
  light.direction = direction_for_image_point(lens, grid.sensor_from_pixel(area.centroid_px), lens.design_wavelength_nm,
                                              light.distance_mm);
  light.value = {area.flux[0] * gain, area.flux[1] * gain, area.flux[2] * gain};
  light.spectrum = spectrum;
  return light;
}

// The angles of a pixel's sides around a light's direction, as tangents, from the displacement of its image. nullopt
// where no light gets through.
std::optional<LightShape> shape_about(const LightSource& source, const PixelGrid& grid, const LensState& lens) {
  constexpr double kStep = 1e-3;
  const auto at = [&](Vec2 tangents) {
    return grid.pixel_from_sensor(
        chief_ray_image_point(lens, source_beside(source, tangents), lens.design_wavelength_nm));
  };
  const Vec2 x = (at({kStep, 0.0}) - at({-kStep, 0.0})) * (0.5 / kStep);
  const Vec2 y = (at({0.0, kStep}) - at({0.0, -kStep})) * (0.5 / kStep);
  const double determinant = cross(x, y);
  if (!std::isnormal(determinant)) return std::nullopt;
  LightShape shape;
  shape.right = {y.y / determinant, -x.y / determinant};
  shape.down = {-y.x / determinant, x.x / determinant};
  return shape;
}

// Gives a light the extent of its own pixels, if it is larger than a point and its pixels can be a shape.
void give_shape(Light& light, const DetectedLight& area, const Picture& picture, const FlarePlan& plan,
                const Detection& found, const LensState& lens) {
  if (!(area.rms_radius_px > kPoint_px)) return;
  auto shape = shape_about(light.source(), plan.grid, lens);
  if (!shape) return;
  shape->level = picture_of_areas(picture.rgb, found, area);
  shape->centre_px = area.centroid_px - Vec2{static_cast<double>(area.min_x), static_cast<double>(area.min_y)};
  const int side = std::max(shape->level.width, shape->level.height);
  Light shaped = light;
  shaped.shape = std::make_shared<const LightShape>(
      side > kLargestShape_px ? coarser(*shape, side / kLargestShape_px + 1) : std::move(*shape));
  if (check_extent(shaped)) light = shaped;
}

std::vector<Light> lights_of(const Detection& found, const Spectrum& spectrum, const Picture& picture,
                             const FlarePlan& plan, const LensState& lens, const Values& values) {
  std::vector<Light> lights;
  for (const DetectedLight& area : found.lights) {
    lights.push_back(light_of(area, spectrum, plan.grid, lens, values));
    if (values.is_on("light-shape")) give_shape(lights.back(), area, picture, plan, found, lens);
  }
  return lights;
}

std::vector<PixelRegion> regions_of(const Values& values, const PixelGrid& grid) {
  std::vector<PixelRegion> regions;
  const auto pixel = [&](Vec2 uv) { return grid.pixel_from_sensor(grid.frame.sensor_from_uv(uv)); };
  const auto whole = [](double px) { return static_cast<int>(std::clamp(std::round(px), -1e9, 1e9)); };
  for (const std::string& text : values.list("region")) {
    const params::UvRegion region = *params::parse_region(text);
    const Vec2 from = pixel(region.from), to = pixel(region.to);
    regions.push_back({whole(from.x), whole(from.y), whole(to.x), whole(to.y)});
  }
  return regions;
}

Result<void> find_lights(const Picture& picture, const LensState& lens, const Values& values, FlarePlan& plan) {
  const auto spectrum = find_spectrum(*values.text("spectrum"));
  if (!spectrum) return tl::unexpected(spectrum.error());
  DetectionSettings detection = params::detection_settings(values);
  detection.regions = regions_of(values, plan.grid);
  auto found = detect_lights(picture.rgb, detection);
  if (!found) return tl::unexpected(found.error());
  plan.found = std::move(*found);
  if (values.is_on("starburst") || values.number("glare") > 0.0)
    plan.already_there =
        std::make_shared<const Image>(frame_of_picture(light_matte(picture.rgb, plan.found), plan.grid));
  plan.lights = lights_of(plan.found, *spectrum, picture, plan, lens, values);
  if (!plan.already_there || !values.is_on("light-shape") || plan.found.areas_found <= detection.max_lights) return {};
  detection.threshold = plan.found.threshold;
  detection.max_lights = std::max(detection.max_lights, kMostImages);
  const auto apart = detect_lights(picture.rgb, detection);
  if (!apart) return tl::unexpected(apart.error());
  plan.imaged_lights =
      std::make_shared<const std::vector<Light>>(lights_of(*apart, *spectrum, picture, plan, lens, values));
  return {};
}

// A value of 1, the default of `render`, would be that of one white pixel: its flare would be invisible, which no user
// intends.
Result<void> check_values_given(const Values& values) {
  if (values.given("value")) return {};
  for (const char* name : {"light", "light-at"}) {
    for (const std::string& text : values.list(name)) {
      if (const auto light = params::parse_light(text); light && light->value) continue;
      return failure(ErrorCode::InvalidArgument,
                     fmt::format("--{0} {1} does not say how bright the light is; add what its image sums to, as in "
                                 "--{0} {1}:50000, or give --value",
                                 name, text.substr(0, text.find(':'))));
    }
  }
  return {};
}

Result<void> add_given_lights(const LensState& lens, const Values& values, FlarePlan& plan) {
  if (auto valued = check_values_given(values); !valued) return valued;
  auto given = params::given_lights(values, lens, plan.grid.frame, plan.space);
  if (!given) return tl::unexpected(given.error());
  plan.given_lights = given->size();
  if (given->empty()) return {};
  for (Light& light : *given)
    for (double& value : light.value) value *= params::gain(values);
  plan.lights.insert(plan.lights.end(), given->begin(), given->end());
  if (!plan.imaged_lights) return {};
  std::vector<Light> imaged = *plan.imaged_lights;
  imaged.insert(imaged.end(), given->begin(), given->end());
  plan.imaged_lights = std::make_shared<const std::vector<Light>>(std::move(imaged));
  return {};
}

Result<void> check_window(const Picture& picture) {
  const Image& rgb = picture.rgb;
  const PixelWindow& window = picture.data_window;
  if (rgb.width == window.width && rgb.height == window.height && rgb.channels == 3 &&
      rgb.pixels.size() == rgb.index(0, rgb.height))
    return {};
  return failure(ErrorCode::InvalidArgument, "the picture's RGB pixels do not fill its data window");
}

std::vector<std::string> warnings_about(const FlarePlan& plan, bool knows_primaries, const Values& values) {
  std::vector<std::string> warnings;
  // The colours of the lights stay right; only the flare's own tint is slightly off.
  if (!knows_primaries && !values.given("colour-space"))
    warnings.emplace_back(
        "the picture's primaries are neither Rec.709 nor ACEScg; its flare is computed as for Rec.709 "
        "(--colour-space)");
  if (plan.found.capped_pixels > 0 && !values.given("max-value"))
    warnings.push_back(fmt::format("{} pixels are brighter than {:g} and count as of that level (--max-value)",
                                   plan.found.capped_pixels, plan.found.max_value));
  return warnings;
}

}  // namespace

Result<FlarePlan> plan_flare(const Picture& picture, const LensState& lens, const Values& values) {
  if (const auto filled = check_window(picture); !filled) return tl::unexpected(filled.error());
  FlarePlan plan;
  const auto named = colour_space_of(picture);
  plan.space = params::colour_space(values, named.value_or(ColourSpace::Rec709));
  plan.pixel_aspect = values.real("pixel-aspect").value_or(pixel_aspect_of(picture));
  const auto grid = pixel_grid(values, lens, picture.data_window, picture.display_window, plan.pixel_aspect);
  if (!grid) return tl::unexpected(grid.error());
  plan.grid = *grid;
  if (values.is_on("detect")) {
    if (auto found = find_lights(picture, lens, values, plan); !found) return tl::unexpected(found.error());
  }
  if (auto added = add_given_lights(lens, values, plan); !added) return tl::unexpected(added.error());
  plan.warnings = warnings_about(plan, named.has_value(), values);
  return plan;
}

}  // namespace contrejour
