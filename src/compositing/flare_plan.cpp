// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/flare_plan.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compositing/detected_lights.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/spectrum_file.h"

namespace contrejour {
namespace {

using params::Values;

// The largest number of lights with a starburst of their own where lights are merged for the ghosts.
constexpr int kMaxImagedLights = 32;

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
    plan.light_matte = std::make_shared<const Image>(frame_of_picture(light_matte(picture.rgb, plan.found), plan.grid));
  plan.lights = lights_of(plan.found, *spectrum, picture.rgb, plan.grid, lens, values);
  if (!plan.light_matte || !values.is_on("light-shape") || plan.found.areas_found <= detection.max_lights) return {};
  detection.threshold = plan.found.threshold;
  detection.max_lights = std::max(detection.max_lights, kMaxImagedLights);
  const auto unmerged = detect_lights(picture.rgb, detection);
  if (!unmerged) return tl::unexpected(unmerged.error());
  plan.imaged_lights =
      std::make_shared<const std::vector<Light>>(lights_of(*unmerged, *spectrum, picture.rgb, plan.grid, lens, values));
  return {};
}

// The default value of `render`, 1, is that of one white pixel, whose flare would be invisible. A photograph's lights
// therefore need a value.
Result<void> check_values_given(const Values& values) {
  if (values.given("value")) return {};
  for (const char* name : {"light", "light-at"}) {
    for (const std::string& text : values.list(name)) {
      if (const auto light = params::parse_light(text); light && light->value) continue;
      return failure(ErrorCode::InvalidArgument,
                     fmt::format("--{0} {1} does not say how bright the light is; add the sum of its image, as in "
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
  plan.given_light_count = given->size();
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
  // The lights keep their colours; only the tint of the flare is slightly wrong.
  if (!knows_primaries && !values.given("colour-space"))
    warnings.emplace_back(
        "the picture's primaries are neither Rec.709 nor ACEScg; its flare is computed for Rec.709, or for the space "
        "of "
        "--colour-space");
  if (plan.found.capped_pixels > 0 && !values.given("max-value"))
    warnings.push_back(fmt::format(
        "pixels brighter than {:g} are clamped to it, and the picture has {} of them; --max-value sets this limit",
        plan.found.max_value, plan.found.capped_pixels));
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
