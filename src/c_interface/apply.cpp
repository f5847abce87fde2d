// SPDX-License-Identifier: Apache-2.0
// Flare of a photograph's own lights, and their detection, for C callers.
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "c_interface/call_context.h"
#include "c_interface/caller_image.h"
#include "contrejour/expert/requests.h"

namespace contrejour {
namespace {

struct ViewsOfApply {
  ImageView picture, result;
};

Result<ViewsOfApply> views_of_apply(const cj_image* picture, const cj_image* result) {
  const auto from = view_of(picture);
  if (!from) return tl::unexpected(from.error());
  const auto to = view_of(result);
  if (!to) return tl::unexpected(to.error());
  if (from->width != to->width || from->height != to->height)
    return invalid_argument(fmt::format("the result has {} x {} pixels and the picture {} x {}; give them one size",
                                        to->width, to->height, from->width, from->height));
  return ViewsOfApply{*from, *to};
}

cj_flare_report report_of(const AppliedFlare& applied) {
  cj_flare_report report{};
  report.lights_given = applied.plan.given_light_count;
  report.lights_found = applied.plan.lights.size() - applied.plan.given_light_count;
  report.threshold = applied.plan.found.threshold;
  report.brightest = applied.flare.visibility.brightest;
  report.relative_to_picture = applied.flare.visibility.relative_to_picture;
  report.stops_to_obvious =
      applied.flare.visibility.stops_to_obvious.value_or(std::numeric_limits<double>::quiet_NaN());
  return report;
}

// The same pixels in the same samples: then only changed samples are written.
bool is_in_place(const ViewsOfApply& views) {
  return views.picture.pixels == views.result.pixels && views.picture.type == views.result.type &&
         views.picture.channel_step == views.result.channel_step &&
         views.picture.pixel_step == views.result.pixel_step && views.picture.row_step == views.result.row_step;
}

Result<AppliedFlare> apply_for_caller(const FlareSource& source, const params::Values& values,
                                      const ViewsOfApply& views, cj_apply_output output, const Context& context) {
  const Image before = read_pixels(views.picture);
  Picture picture = picture_of(before);
  auto applied = apply_flare(picture, source, values, context);
  if (!applied) return applied;
  Result<void> written;
  if (output == CJ_FLARE_ONLY)
    written = write_pixels(applied->flare.image, views.result, context);
  else if (is_in_place(views))
    write_changes(before, picture.rgb, views.result);
  else
    written = write_pixels(picture.rgb, views.result, context);
  if (!written) return tl::unexpected(written.error());
  return applied;
}

}  // namespace
}  // namespace contrejour

using contrejour::Result;

cj_status cj_apply(const cj_lens_state* state, const cj_settings* settings, const cj_image* picture,
                   const cj_image* result, cj_apply_output output, const cj_context* context, cj_flare_report* report,
                   cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require(state, "state"); !given) return given;
    if (const auto good = CallContext::check(context); !good) return good;
    if (report != nullptr)
      if (const auto good = check_struct(report, sizeof(cj_flare_report), "cj_flare_report"); !good) return good;
    if (output != CJ_PICTURE_WITH_FLARE && output != CJ_FLARE_ONLY)
      return invalid_argument(fmt::format("{} is not an output; give CJ_PICTURE_WITH_FLARE or CJ_FLARE_ONLY", output));
    const auto views = views_of_apply(picture, result);
    if (!views) return tl::unexpected(views.error());
    const params::Values values = values_of(settings);
    const CallContext call(context, values);
    const auto applied = apply_for_caller(source_of(*state), values, *views, output, call.context());
    if (!applied) return tl::unexpected(applied.error());
    if (report != nullptr) write_struct(report_of(*applied), report);
    return {};
  });
}

cj_status cj_detect_lights(const cj_settings* settings, const cj_image* picture, cj_light_list** lights,
                           cj_error* error) {
  using namespace contrejour;
  return guarded_create(lights, error, [&]() -> Result<cj_light_list> {
    const auto view = view_of(picture);
    if (!view) return tl::unexpected(view.error());
    auto found = detect_lights(read_pixels(*view), values_of(settings));
    if (!found) return tl::unexpected(found.error());
    return cj_light_list{std::move(*found)};
  });
}

void cj_light_list_destroy(cj_light_list* lights) { delete lights; }

size_t cj_light_list_count(const cj_light_list* lights) {
  return lights != nullptr ? lights->detection.lights.size() : 0;
}

double cj_light_list_threshold(const cj_light_list* lights) {
  return lights != nullptr ? lights->detection.threshold : 0.0;
}

cj_status cj_light_list_get(const cj_light_list* lights, size_t index, cj_detected_light* light, cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require(lights, "lights"); !given) return given;
    if (const auto good = check_struct(light, sizeof(cj_detected_light), "cj_detected_light"); !good) return good;
    const auto& all = lights->detection.lights;
    if (index >= all.size()) return invalid_argument(fmt::format("there is no light {} of {}", index, all.size()));
    const DetectedLight& found = all[index];
    cj_detected_light ours{};
    ours.x_px = found.centroid_px.x;
    ours.y_px = found.centroid_px.y;
    std::copy(found.flux.begin(), found.flux.end(), ours.flux);
    ours.rms_radius_px = found.rms_radius_px;
    ours.peak = found.peak;
    ours.min_x = found.min_x;
    ours.min_y = found.min_y;
    ours.max_x = found.max_x;
    ours.max_y = found.max_y;
    ours.pixel_count = found.pixel_count;
    write_struct(ours, light);
    return {};
  });
}
