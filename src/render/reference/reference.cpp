// SPDX-License-Identifier: Apache-2.0
#include "render/reference/reference.h"

#include "base/clock.h"
#include "base/tasks.h"
#include "render/planning/layer_images.h"
#include "render/reference/flux_image.h"
#include "render/reference/pupil_cells.h"
#include "render/stop_patterns/stop_transmittances.h"

namespace contrejour::inline internal {
namespace {

// One ghost of one light at one wavelength.
struct Item {
  Ghost ghost;
  const AppliedAdjustment* adjustment;
  const PlannedLight* light;
  const PlannedPass* pass;
  std::size_t layer;  // of the plan's
};

std::vector<Item> items_of(const FramePlan& plan) {
  std::vector<Item> items;
  for_each_pair(plan, [&](std::size_t g, std::size_t k) {
    const PlannedLight& light = plan.lights[k];
    for (const PlannedPass& pass : light.passes)
      items.push_back({plan.ghosts[g], &plan.adjustments[g], &light, &pass, plan.layer_of(g, k)});
  });
  return items;
}

struct RenderedItem {
  reference::FluxImage flux;
  reference::CellCounts counts;
  std::uint64_t surfaces = 0;  // that each of its rays meets
};

RenderedItem render_item(const Item& item, const PlannedFrame& planned, double density, const StopTransmittances& stops,
                         const Context& context) {
  const LensState& lens = planned.lens;
  const Frame& frame = planned.settings.frame;
  RenderedItem out{{frame.width, frame.height}, {}, 0};
  const LightSource& light = item.light->source;
  const StopTransmittance stop = stops.of(item.ghost, item.pass->lambda_nm, light);
  const OpticalPath path = stop.widened(ghost_path(lens, item.ghost, item.pass->lambda_nm));
  out.surfaces = path.steps.size();
  out.counts = reference::for_each_lit_polygon(
      path, stop.traced_iris(lens.iris), light, entrance_window(lens, light), item.adjustment->placed(frame),
      reference::CellLimits::for_density(density), [&] { return context.cancelled(); },
      [&](std::span<const Vec2> pixels, double flux) { out.flux.add_polygon(pixels, stop.level() * flux); }, stop);
  return out;
}

}  // namespace

Result<DrawnFlare> render_reference(const PlannedFrame& planned, const ReferenceOptions& options,
                                    const Context& context) {
  const auto start = Clock::now();
  const auto& [lens, plan, settings, cache] = planned;
  if (!(options.density > 0.0) || options.density > 64.0) {
    return failure(ErrorCode::InvalidArgument, "the reference's density is out of range; choose a value up to 64");
  }
  StopTransmittances stops(lens, settings, plan.dirt, cache);
  if (!stops.prepare(plan, context)) return interrupted();

  DrawnFlare flare;
  RenderStatistics& stats = flare.statistics;
  LayerImages images(plan, settings.frame);
  std::vector<std::vector<double>> sums(plan.layers ? plan.layers->count() : 1);
  const auto items = items_of(plan);
  const bool done = ordered_pipeline(
      items.size(), context,
      [&](std::size_t k) { return render_item(items[k], planned, options.density, stops, context); },
      [&](std::size_t k, const RenderedItem& rendered) {
        std::vector<double>& sum = sums[items[k].layer];
        sum.resize(images.at(items[k].layer).pixels.size());
        rendered.flux.add_to(sum, items[k].adjustment->tinted(items[k].pass->gain));
        stats.rays += rendered.counts.rays;
        stats.surface_hits += rendered.counts.rays * rendered.surfaces;
        stats.primitives += rendered.counts.polygons;
      });
  if (!done) return interrupted();

  for (std::size_t layer = 0; layer < sums.size(); ++layer)
    for (std::size_t i = 0; i < sums[layer].size(); ++i)
      images.at(layer).pixels[i] = static_cast<float>(sums[layer][i]);
  images.move_to(flare);
  stats.method = "reference";
  stats.ghosts_rendered = static_cast<int>(plan.ghosts.size());
  stats.ghosts_skipped_flux = plan.skipped_flux;
  stats.time_ms = {{"render", ms_since(start)}, {"total", ms_since(start)}};
  return flare;
}

}  // namespace contrejour::inline internal
