// SPDX-License-Identifier: Apache-2.0
// Renderers for C callers.
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "c_interface/call_context.h"
#include "c_interface/caller_image.h"
#include "c_interface/caller_lights.h"
#include "contrejour/expert/renderer_settings.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"

namespace contrejour {
namespace {

cj_statistics statistics_of(const RenderStatistics& given) {
  cj_statistics ours{};
  ours.total_ms = given.time_ms.empty() ? 0.0 : given.time_ms.back().second;
  ours.rays = given.rays;
  ours.primitives = given.primitives;
  ours.peak_memory_bytes = given.peak_memory_bytes;
  ours.ghosts_rendered = given.ghosts_rendered;
  ours.ghosts_skipped_flux = given.ghosts_skipped_flux.value_or(std::numeric_limits<double>::quiet_NaN());
  return ours;
}

// The settings of a picture of this size.
Result<params::Values> values_of_size(const cj_settings* settings, const ImageView& view) {
  params::Values values;
  if (auto set = values.set("size", fmt::format("{}x{}", view.width, view.height)); !set)
    return tl::unexpected(set.error());
  return values.over(values_of(settings));
}

Result<PictureRequest> request_of(const cj_renderer& renderer, const params::Values& values,
                                  const std::vector<Light>& lights) {
  if (const auto* measured = std::get_if<MeasuredFlare>(&renderer.renderer))
    return picture_request(values, *measured, lights);
  if (!renderer.lens) return invalid_argument("the renderer has no lens; call cj_renderer_set_lens() first");
  return picture_request(values, *renderer.lens, lights);
}

Result<RenderStatistics> render_for_caller(cj_renderer& renderer, const cj_settings* settings,
                                           const std::vector<Light>& lights, const ImageView& view,
                                           const cj_context* context) {
  const auto values = values_of_size(settings, view);
  if (!values) return tl::unexpected(values.error());
  const auto request = request_of(renderer, *values, lights);
  if (!request) return tl::unexpected(request.error());
  if (auto* of_lens = std::get_if<Renderer>(&renderer.renderer))
    if (auto set = configure_renderer(*of_lens, *values); !set) return tl::unexpected(set.error());
  const CallContext call(context, *values);
  return render_picture(*request, renderer.renderer, view, call.context());
}

// The renderer keeps what frames have in common from lens to lens.
Result<void> set_source(cj_renderer& renderer, const cj_lens_state& state) {
  if (state.measured) {
    renderer = {*state.measured};
    return {};
  }
  if (!std::holds_alternative<Renderer>(renderer.renderer)) {
    auto made = Renderer::create();
    if (!made) return tl::unexpected(made.error());
    renderer = {std::move(*made)};
  }
  if (auto set = std::get<Renderer>(renderer.renderer).set_lens(state.state); !set) return set;
  renderer.lens = state.state;
  return {};
}

}  // namespace
}  // namespace contrejour

using contrejour::Result;

cj_status cj_renderer_create(cj_renderer** renderer, cj_error* error) {
  return contrejour::guarded_create(renderer, error, []() -> Result<cj_renderer> {
    auto made = contrejour::Renderer::create();
    if (!made) return tl::unexpected(made.error());
    return cj_renderer{std::move(*made)};
  });
}

void cj_renderer_destroy(cj_renderer* renderer) { delete renderer; }

cj_status cj_renderer_set_lens(cj_renderer* renderer, const cj_lens_state* state, cj_error* error) {
  return contrejour::guarded(error, [&]() -> Result<void> {
    if (const auto given = contrejour::require(renderer, "renderer"); !given) return given;
    if (const auto given = contrejour::require(state, "state"); !given) return given;
    return contrejour::set_source(*renderer, *state);
  });
}

cj_status cj_renderer_render(cj_renderer* renderer, const cj_settings* settings, const cj_light* lights,
                             size_t light_count, const cj_image* image, const cj_context* context,
                             cj_statistics* statistics, cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require(renderer, "renderer"); !given) return given;
    if (const auto good = CallContext::check(context); !good) return good;
    if (statistics != nullptr)
      if (const auto good = check_struct(statistics, sizeof(cj_statistics), "cj_statistics"); !good) return good;
    const auto view = view_of(image);
    if (!view) return tl::unexpected(view.error());
    const auto all_lights = lights_of(lights, light_count);
    if (!all_lights) return tl::unexpected(all_lights.error());
    const auto rendered = render_for_caller(*renderer, settings, *all_lights, *view, context);
    if (!rendered) return tl::unexpected(rendered.error());
    if (statistics != nullptr) write_struct(statistics_of(*rendered), statistics);
    return {};
  });
}
