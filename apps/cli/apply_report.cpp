#include "cli/apply_report.h"

#include <fmt/format.h>

#include "cli/text_table.h"
#include "params/settings.h"

namespace contrejour::cli {
namespace {

using params::FlarePlan;

Json array_of(const Rgb& rgb) { return Json::array({rgb[0], rgb[1], rgb[2]}); }

}  // namespace

Json report_json(const FlarePlan& plan) {
  Json lights = Json::array();
  for (std::size_t k = 0; k < plan.lights.size(); ++k) {
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
  return {{"threshold", plan.found.threshold},
          {"areas_found", plan.found.areas_found},
          {"capped_pixels", plan.found.capped_pixels},
          {"lights", lights}};
}

std::string report_text(const FlarePlan& plan) {
  std::string text = fmt::format("{} bright areas above {:.4g}, taken as {} lights\n", plan.found.areas_found,
                                 plan.found.threshold, plan.lights.size());
  if (plan.lights.empty()) return text;
  TextTable table({"light", "x px", "y px", "azimuth deg", "elevation deg", "flux R", "G", "B", "radius px", "pixels",
                   "peak", "areas"});
  for (std::size_t k = 0; k < plan.lights.size(); ++k) {
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

}  // namespace contrejour::cli
