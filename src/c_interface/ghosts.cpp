// SPDX-License-Identifier: Apache-2.0
// Ghosts and their figures for C callers.
#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "c_interface/call_context.h"
#include "c_interface/caller_lights.h"
#include "contrejour/expert/requests.h"

namespace contrejour {
namespace {

cj_ghost ghost_of(const GhostFigures& figures) {
  cj_ghost ours{};
  const Ghost& ghost = figures.ghost;
  const int surfaces[4] = {ghost.i, ghost.j, ghost.k, ghost.l};
  std::copy_n(surfaces, 4, ours.surfaces);
  std::copy(ghost.order.begin(), ghost.order.end(), ours.order);
  ours.relative_flux = figures.relative_flux;
  std::copy(figures.rgb.begin(), figures.rgb.end(), ours.rgb);
  ours.peak_irradiance = figures.peak_irradiance;
  ours.reflectance = figures.reflectance;
  ours.x_px = figures.centroid_px.x;
  ours.y_px = figures.centroid_px.y;
  ours.width_px = figures.size_px.x;
  ours.height_px = figures.size_px.y;
  ours.x_mm = figures.centroid_mm.x;
  ours.y_mm = figures.centroid_mm.y;
  ours.width_mm = figures.size_mm.x;
  ours.height_mm = figures.size_mm.y;
  ours.focus_mm = figures.first_order.focus_mm.value_or(std::numeric_limits<double>::quiet_NaN());
  ours.blur_mm = figures.first_order.blur_mm;
  ours.in_focus = figures.in_focus ? 1 : 0;
  ours.is_pupil_ghost = figures.pupil_ghost ? 1 : 0;
  return ours;
}

}  // namespace
}  // namespace contrejour

cj_status cj_measure_ghosts(const cj_lens_state* state, const cj_settings* settings, const cj_light* light,
                            const cj_context* context, cj_ghost_list** ghosts, cj_error* error) {
  using namespace contrejour;
  return guarded_create(ghosts, error, [&]() -> Result<cj_ghost_list> {
    if (const auto given = require_surfaces(state); !given) return tl::unexpected(given.error());
    if (const auto good = CallContext::check(context); !good) return tl::unexpected(good.error());
    const auto lights = lights_of(light, light != nullptr ? 1 : 0);
    if (!lights) return tl::unexpected(lights.error());
    const params::Values values = values_of(settings);
    const auto request = figures_request(values, state->state, lights->empty() ? nullptr : &lights->front());
    if (!request) return tl::unexpected(request.error());
    const CallContext call(context, values);
    auto figures = ghost_figures(state->state, *request, call.context());
    if (!figures) return tl::unexpected(figures.error());
    return cj_ghost_list{std::move(*figures)};
  });
}

void cj_ghost_list_destroy(cj_ghost_list* ghosts) { delete ghosts; }

size_t cj_ghost_list_count(const cj_ghost_list* ghosts) { return ghosts != nullptr ? ghosts->ghosts.size() : 0; }

cj_status cj_ghost_list_get(const cj_ghost_list* ghosts, size_t index, cj_ghost* ghost, cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require(ghosts, "ghosts"); !given) return given;
    if (const auto good = check_struct(ghost, sizeof(cj_ghost), "cj_ghost"); !good) return good;
    const std::size_t count = ghosts->ghosts.size();
    if (index >= count) return invalid_argument(fmt::format("there is no ghost {} of {}", index, count));
    write_struct(ghost_of(ghosts->ghosts[index]), ghost);
    return {};
  });
}
