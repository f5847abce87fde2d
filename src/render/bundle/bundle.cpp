// SPDX-License-Identifier: Apache-2.0
#include "render/bundle/bundle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/tasks.h"
#include "render/bundle/device_grids.h"
#include "render/bundle/item_renderer.h"
#include "render/bundle/stopwatch.h"
#include "render/planning/adaptive_passes.h"
#include "render/planning/grid_side.h"
#include "render/planning/layer_images.h"

namespace contrejour::inline internal {
namespace {

using bundle::Counts;
using bundle::RenderedItem;
using bundle::Stopwatch;

// hullin2011's precomputed pupil bounds, for all angles up to those of the lights; nullopt unless requested.
std::optional<pupils::PupilBounds> bounds_for(const FramePlan& plan, const LensState& lens,
                                              const BundleOptions& options, const Context& context) {
  if (!options.precomputed_bounds || !lens.has_axial_symmetry()) return std::nullopt;
  pupils::PupilBoundsRange range;
  range.ghosts = plan.ghosts;
  double shortest_nm = std::numeric_limits<double>::infinity(), longest_nm = 0.0;
  for (const PlannedLight& light : plan.lights) {
    if (light.passes.empty()) continue;
    shortest_nm = std::min(shortest_nm, light.passes.front().lambda_nm);
    longest_nm = std::max(longest_nm, light.passes.back().lambda_nm);
    range.largest_angle_rad = std::max(range.largest_angle_rad, meridian_of(light.source).angle_rad());
  }
  if (!(longest_nm > 0.0)) return std::nullopt;
  range.lambda_nm = {shortest_nm};
  if (longest_nm > shortest_nm) range.lambda_nm.push_back(longest_nm);
  return pupils::PupilBounds(lens, range, context);
}

void add_to(Image& image, const RenderedItem& item) {
  const auto row_length = 3 * static_cast<std::size_t>(item.box.width());
  for (int y = item.box.y0; y < item.box.y1; ++y) {
    float* to = image.pixels.data() + image.index(item.box.x0, y);
    const float* from = item.rgb.data() + row_length * static_cast<std::size_t>(y - item.box.y0);
    for (std::size_t k = 0; k < row_length; ++k) to[k] += from[k];
  }
}

struct PhaseTimes {
  double bounds_ms = 0, items_ms = 0, accumulate_ms = 0;
};

// Search, tracing and rasterisation run in parallel on all threads: each is given its fraction of the elapsed time.
std::vector<std::pair<std::string, double>> named(const PhaseTimes& times, const Counts& counts, double total_ms) {
  const double busy_ms = counts.search_ms + counts.trace_ms + counts.raster_ms;
  const double scale = busy_ms > 0.0 ? std::max(0.0, times.items_ms - times.accumulate_ms) / busy_ms : 0.0;
  return {{"bounds", times.bounds_ms},         {"search", counts.search_ms * scale},
          {"trace", counts.trace_ms * scale},  {"raster", counts.raster_ms * scale},
          {"accumulate", times.accumulate_ms}, {"total", total_ms}};
}

}  // namespace

Result<DrawnFlare> render_bundle(const PlannedFrame& planned, const BundleOptions& options, const Context& context) {
  PhaseTimes times;
  double total_ms = 0.0;
  const Stopwatch whole(total_ms);
  if (const auto ok = check_grid(options.grid); !ok) return tl::unexpected(ok.error());
  const LensState& lens = planned.lens;
  const Frame& frame = planned.settings.frame;
  const auto with_passes = with_adaptive_passes(planned.plan, lens, frame, context);
  if (!with_passes) return interrupted();
  const FramePlan& plan = *with_passes;
  const auto bounds = bounds_for(plan, lens, options, context);
  StopTransmittances stops(lens, planned.settings, plan.dirt, planned.cache);
  if (!stops.prepare(plan, context)) return interrupted();
  times.bounds_ms = whole.elapsed_ms();
  if (context.cancelled()) return interrupted();
  const bundle::GridSource source{lens,   options, plan.tables, stops, *plan.kept_pupils, bounds ? &*bounds : nullptr,
                                  context};
  KeptDevice& kept = *planned.cache.section<KeptDevice>({});
  if (kept.may_draw(bundle::device_lacks(source, plan))) {
    auto drawn = bundle::draw_on_device(kept, source, planned, plan, context);
    if (!kept.falls_back(drawn)) return drawn;
  }

  LayerImages images(plan, frame);
  Counts counts;
  if (bounds) {
    counts.rays = bounds->rays();
    counts.surface_hits = bounds->surface_hits();
  }
  const auto items = bundle::items_of(plan, options);
  const bool done = ordered_pipeline(
      items.size(), context,
      [&](std::size_t k) { return bundle::ItemRenderer(items[k], frame, source, context).render(); },
      [&](std::size_t k, const RenderedItem& item) {
        const Stopwatch adding(times.accumulate_ms);
        add_to(images.at(items[k].layer), item);
        counts.add(item.counts);
      });
  if (!done) return interrupted();
  times.items_ms = whole.elapsed_ms() - times.bounds_ms;

  DrawnFlare flare;
  images.move_to(flare);
  RenderStatistics& stats = flare.statistics;
  stats.method = "bundle";
  stats.rays = counts.rays;
  stats.surface_hits = counts.surface_hits;
  stats.primitives = counts.primitives;
  stats.ghosts_rendered = static_cast<int>(plan.ghosts.size());
  stats.ghosts_skipped_flux = plan.skipped_flux;
  stats.time_ms = named(times, counts, whole.elapsed_ms());
  return flare;
}

}  // namespace contrejour::inline internal
