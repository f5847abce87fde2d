// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/measured_settings.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "compositing/picture_flare.h"
#include "contrejour/expert/settings.h"
#include "settings/photometry.h"

namespace contrejour {
namespace {

constexpr std::array<std::string_view, 22> kWithMeasured{
    "light",      "light-at",   "value",     "colour",       "size",   "hfov",   "pixel-aspect", "exposure",
    "threads",    "fnumber",    "iso",       "shutter",      "detect", "region", "threshold",    "softness",
    "max-lights", "min-pixels", "max-value", "colour-space", "gain",   "stops"};

bool has_exposure_values(const params::Values& values) {
  return values.given("fnumber") || values.given("iso") || values.given("shutter");
}

// Each light as a point, which is what a measured flare takes.
std::vector<Light> points_of(const FlarePlan& plan) {
  std::vector<Light> points = plan.lights;
  for (Light& light : points) light.shape = nullptr;
  return points;
}

}  // namespace

Result<void> check_measured_values(const MeasuredFlare& flare, const params::Values& values, MeasuredUse use) {
  for (const params::Parameter& p : params::all_parameters()) {
    if (std::ranges::find(kWithMeasured, p.name) != kWithMeasured.end()) continue;
    if (!values.given(p.name) || values.text(p.name) == std::string(p.fallback)) continue;
    return invalid_argument(
        fmt::format("--{} cannot be used with a measured flare, which holds for the lens, settings and light that were "
                    "photographed; leave it out, or name a lens instead",
                    p.name));
  }
  if (!flare.half_field && !values.given("hfov")) return tl::unexpected(unknown_field(flare));
  if (use == MeasuredUse::Lights || !has_exposure_values(values)) return {};
  return invalid_argument(
      "--fnumber, --iso and --shutter cannot be used with a measured flare on a photograph: its lights are in the "
      "photograph's exposure already; leave them out");
}

Result<double> exposure_scale(const MeasuredFlare& flare, const params::Values& values) {
  if (!has_exposure_values(values)) return 1.0;
  if (!flare.exposure) {
    return invalid_argument(fmt::format(
        "the measured flare \"{}\" does not state the exposure of its photographs, so that --fnumber, --iso "
        "and --shutter have nothing to refer to; leave them out, or add exposure = {{ f_number = ..., iso = "
        "..., time_s = ... }} to the file",
        flare.name));
  }
  CaptureExposure picture = *flare.exposure;
  if (values.given("fnumber")) picture.f_number = values.number("fnumber");
  if (values.given("iso")) picture.iso = values.number("iso");
  if (values.given("shutter")) {
    const auto shutter_s = params::parse_shutter(*values.text("shutter"));
    if (!shutter_s) return tl::unexpected(shutter_s.error());
    picture.time_s = *shutter_s;
  }
  return brightness_scale(*flare.exposure, picture, 1.0);
}

Result<std::vector<Light>> exposed_lights(const MeasuredFlare& flare, std::vector<Light> lights,
                                          const params::Values& values) {
  const auto scale = exposure_scale(flare, values);
  if (!scale) return tl::unexpected(scale.error());
  for (Light& light : lights)
    for (double& value : light.value) value *= *scale;
  return lights;
}

Result<PictureFlare> render_flare(const FlarePlan& plan, const Image& rgb, const MeasuredFlare& flare,
                                  const Context& context) {
  if (plan.lights.empty()) return flare_without_lights(plan);
  auto drawn = render(flare, points_of(plan), plan.grid.frame, context);
  if (!drawn) return tl::unexpected(drawn.error());
  return on_picture(std::move(*drawn), plan, rgb);
}

Result<PictureLayers> render_flare_layers(const FlarePlan& plan, const Image& rgb, const MeasuredFlare& flare,
                                          const LayerOptions& options, const Context& context) {
  auto drawn = render_layers(flare, points_of(plan), plan.grid.frame, options, context);
  if (!drawn) return tl::unexpected(drawn.error());
  return layers_on_picture(std::move(*drawn), plan, rgb);
}

}  // namespace contrejour
