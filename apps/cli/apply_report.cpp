// SPDX-License-Identifier: Apache-2.0
#include "cli/apply_report.h"

#include <fmt/format.h>

#include "cli/text_table.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

Json array_of(const Rgb& rgb) { return Json::array({rgb[0], rgb[1], rgb[2]}); }

const char* source_name(ThresholdSource source) {
  switch (source) {
    case ThresholdSource::Given: return "given";
    case ThresholdSource::Gap: return "gap";
    case ThresholdSource::Clipped: return "clipped";
    case ThresholdSource::Brightest: return "brightest";
    case ThresholdSource::Region: return "region";
    case ThresholdSource::None: return "none";
  }
  return "";
}

const char* source_text(ThresholdSource source) {
  switch (source) {
    case ThresholdSource::Clipped: return " (the picture is clipped at white)";
    case ThresholdSource::Brightest:
      return " (no gap in brightness between the lights and what they illuminate: two stops below the brightest)";
    case ThresholdSource::Region: return " (two stops below the brightest pixel of the region)";
    default: return "";
  }
}

Json given_json(const FlarePlan& plan) {
  Json given = Json::array();
  for (std::size_t k = plan.lights.size() - plan.given_light_count; k < plan.lights.size(); ++k) {
    const LightAngles angles = angles_from_direction(plan.lights[k].direction);
    given.push_back({{"azimuth_deg", angles.azimuth_rad / params::kDegree_rad},
                     {"elevation_deg", angles.elevation_rad / params::kDegree_rad},
                     {"flux", array_of(plan.lights[k].value)}});
  }
  return given;
}

std::string no_lights_text(const FlarePlan& plan) {
  const Detection& found = plan.found;
  std::string text = fmt::format("no lights were detected, because no pixel is above {:.4g}", found.threshold);
  if (found.areas_found == 0 && !found.areas.empty())
    text = "no lights were detected, because all bright areas are smaller than --min-pixels";
  if (!(found.brightest > 0.0)) return text + "; the picture is black\n";
  const Vec2 uv = plan.grid.frame.uv_from_sensor(plan.grid.sensor_from_pixel(found.brightest_px));
  return text + fmt::format(
                    "; the brightest pixel has {:.4g}, at {:.1f}, {:.1f} px (white is 1).\n"
                    "Give --threshold {:.2g}, a --region around the light, or the light itself as\n"
                    "--light-at {:.3f},{:.3f}:VALUE, where VALUE is the sum of its image, typically 1000 or more\n",
                    found.brightest, found.brightest_px.x, found.brightest_px.y, 0.5 * found.brightest, uv.x, uv.y);
}

std::string detected_lights_text(const FlarePlan& plan) {
  std::string text = fmt::format("{} bright areas above {:.4g}{} are {} lights\n", plan.found.areas_found,
                                 plan.found.threshold, source_text(plan.found.source), plan.found.lights.size());
  TextTable table({"light", "x px", "y px", "azimuth deg", "elevation deg", "flux R", "G", "B", "radius px", "pixels",
                   "peak", "areas"});
  for (std::size_t k = 0; k < plan.found.lights.size(); ++k) {
    const DetectedLight& area = plan.found.lights[k];
    const LightAngles angles = angles_from_direction(plan.lights[k].direction);
    table.add({fmt::format("{}", k + 1), fmt::format("{:.1f}", area.centroid_px.x),
               fmt::format("{:.1f}", area.centroid_px.y),
               fmt::format("{:.3f}", angles.azimuth_rad / params::kDegree_rad),
               fmt::format("{:.3f}", angles.elevation_rad / params::kDegree_rad), fmt::format("{:.4g}", area.flux[0]),
               fmt::format("{:.4g}", area.flux[1]), fmt::format("{:.4g}", area.flux[2]),
               fmt::format("{:.2f}", area.rms_radius_px), fmt::format("{}", area.pixel_count),
               fmt::format("{:.4g}", area.peak), fmt::format("{}", area.merged_areas)});
  }
  return text + table.text();
}

}  // namespace

Json report_json(const FlarePlan& plan) {
  Json lights = Json::array();
  for (std::size_t k = 0; k < plan.found.lights.size(); ++k) {
    const DetectedLight& area = plan.found.lights[k];
    const Vec2 uv = plan.grid.frame.uv_from_sensor(plan.grid.sensor_from_pixel(area.centroid_px));
    const LightAngles angles = angles_from_direction(plan.lights[k].direction);
    lights.push_back({{"centroid_px", {area.centroid_px.x, area.centroid_px.y}},
                      {"uv", {uv.x, uv.y}},
                      {"azimuth_deg", angles.azimuth_rad / params::kDegree_rad},
                      {"elevation_deg", angles.elevation_rad / params::kDegree_rad},
                      {"flux", array_of(area.flux)},
                      {"rms_radius_px", area.rms_radius_px},
                      {"bounds_px", {area.min_x, area.min_y, area.max_x, area.max_y}},
                      {"pixels", area.pixel_count},
                      {"peak", area.peak},
                      {"merged_areas", area.merged_areas}});
  }
  const Detection& found = plan.found;
  return {{"threshold", found.area_of_pixel.empty() ? Json() : Json(found.threshold)},
          {"threshold_source", source_name(found.source)},
          {"brightest", {{"value", found.brightest}, {"px", {found.brightest_px.x, found.brightest_px.y}}}},
          {"areas_found", found.areas_found},
          {"capped_pixels", found.capped_pixels},
          {"lights", lights},
          {"given_lights", given_json(plan)}};
}

Json visibility_json(const FlareVisibility& visibility) {
  return {{"brightest", visibility.brightest},
          {"over_picture", visibility.relative_to_picture},
          {"stops_to_plain", visibility.stops_to_obvious ? Json(*visibility.stops_to_obvious) : Json()}};
}

std::string visibility_text(const FlareVisibility& visibility, std::size_t lights) {
  if (lights == 0) return {};
  if (!visibility.stops_to_obvious) return "no visible part of the flare falls on the picture\n";
  const std::string text =
      fmt::format("the flare adds {:.3g} per cent to the picture below its brightest parts (level {:.2g})",
                  100.0 * visibility.relative_to_picture, visibility.brightest);
  if (!(*visibility.stops_to_obvious > 0.0)) return text + "\n";
  return text + fmt::format("; it would be obvious with {:.1f} more stops (--stops)\n", *visibility.stops_to_obvious);
}

std::string report_text(const FlarePlan& plan) {
  std::string text;
  if (plan.found.lights.empty() && !plan.found.area_of_pixel.empty()) text = no_lights_text(plan);
  if (!plan.found.lights.empty()) text = detected_lights_text(plan);
  if (plan.given_light_count > 0) text += fmt::format("{} lights were given as options\n", plan.given_light_count);
  return text;
}

}  // namespace contrejour::cli
