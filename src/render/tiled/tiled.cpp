// SPDX-License-Identifier: Apache-2.0
#include "render/tiled/tiled.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/tasks.h"
#include "optics/trace/by_wavelength.h"
#include "render/planning/adaptive_passes.h"
#include "render/planning/frame_plan.h"
#include "render/planning/grid_side.h"
#include "render/planning/layer_images.h"
#include "render/planning/statistics.h"
#include "render/pupils/kept_pupils.h"
#include "render/stop_patterns/stop_transmittances.h"
#include "render/tiled/device_grids.h"
#include "render/tiled/primitive_builder.h"
#include "render/tiled/tiled_frame.h"

namespace contrejour::inline internal {
namespace {

constexpr int kMaxMergeSteps = 9;  // merges a grid of 512 into one primitive
constexpr int kLargestTile = 4096;
constexpr double kTracingProgress = 0.7;  // fraction of the whole progress

Result<void> check(const TiledOptions& o) {
  const auto refuse = [](std::string message) { return failure(ErrorCode::InvalidArgument, std::move(message)); };
  if (auto ok = check_grid(o.grid); !ok) return ok;
  if (o.merge_steps < 0 || o.merge_steps > kMaxMergeSteps) {
    return refuse(fmt::format("{} merge steps is out of range; choose 0 to {}", o.merge_steps, kMaxMergeSteps));
  }
  if (!(o.merge_threshold >= 0.0) || !std::isfinite(o.merge_threshold)) {
    return refuse("the merge threshold must be a number of 0 or more");
  }
  if (o.dense_tile < 1 || o.dense_tile > kLargestTile || o.coarse_tile < 0 || o.coarse_tile > kLargestTile) {
    return refuse(fmt::format("tiles of {} and {} pixels are out of range; choose 1 to {}, coarse ones 0 for none",
                              o.dense_tile, o.coarse_tile, kLargestTile));
  }
  if (o.coarse_tile % o.dense_tile != 0) {
    return refuse(fmt::format("coarse tiles of {} pixels do not hold whole tiles of {}; choose a multiple",
                              o.coarse_tile, o.dense_tile));
  }
  return {};
}

// One ghost of one light at one wavelength.
struct Item {
  Ghost ghost;
  Vec2 shift_mm;  // of the ghost, on the sensor
  LightSource light;
  double lambda_nm = 550;
};

struct Counts {
  std::uint64_t rays = 0, surface_hits = 0, primitives = 0;
  double search_ms = 0, trace_ms = 0;

  void add(const Counts& other) {
    rays += other.rays;
    surface_hits += other.surface_hits;
    primitives += other.primitives;
    search_ms += other.search_ms;
    trace_ms += other.trace_ms;
  }
};

struct TracedItem {
  tiled::PrimitiveBuffer buffer;
  Counts counts;
};

// Scratch memory to trace an item. Threads take and return it, so that each piece is touched for the first time only
// once.
struct Workspace {
  RayGrid grid;
  tiled::PrimitiveBuilder builder;
};

class Workspaces {
 public:
  Workspaces(const Frame& frame, const TiledOptions& options) : frame_(frame), options_(options) {}

  std::unique_ptr<Workspace> take() {
    const std::scoped_lock lock(mutex_);
    if (free_.empty()) {
      return std::make_unique<Workspace>(Workspace{{}, tiled::PrimitiveBuilder(frame_, options_)});
    }
    auto workspace = std::move(free_.back());
    free_.pop_back();
    return workspace;
  }
  void give_back(std::unique_ptr<Workspace> workspace) {
    const std::scoped_lock lock(mutex_);
    free_.push_back(std::move(workspace));
  }

 private:
  const Frame& frame_;
  const TiledOptions& options_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Workspace>> free_;
};

struct Job {
  const LensState& lens;
  const Frame& frame;
  const TiledOptions& options;
  const Context& context;
  const TablesByWavelength& tables;
  pupils::KeptPupils& kept;
  IrisShape iris;
  std::vector<Item> items;
  std::vector<tiled::Gain> gains;  // one for each item
  std::vector<StopTransmittance> stops = {};  // one for each item; empty: the iris is sharp for all, the lens clean
  IrisShape round = IrisShape(Iris{});  // for items with a stop pattern
};

// Lists the items of a layer; without layers all.
void list_items(const FramePlan& plan, std::size_t layer, const StopTransmittances& stops, Job& job) {
  const bool any = stops.on() || plan.dirt;
  for_each_pair_with_passes(plan, [&](std::size_t g, std::size_t k, std::span<const PlannedPass> passes) {
    if (plan.layer_of(g, k) != layer) return;
    const AppliedAdjustment& adjustment = plan.adjustments[g];
    const PlannedLight& light = plan.lights[k];
    for (const PlannedPass& pass : passes) {
      const StopTransmittance stop = stops.of(plan.ghosts[g], pass.lambda_nm, light.source);
      if (any) job.stops.push_back(stop);
      Rgb gain = adjustment.tinted(pass.gain);
      for (double& value : gain) value *= stop.level();
      job.items.push_back({plan.ghosts[g], adjustment.shift_mm, light.source, pass.lambda_nm});
      job.gains.push_back({static_cast<float>(gain[0]), static_cast<float>(gain[1]), static_cast<float>(gain[2])});
    }
  });
}

TracedItem trace_item(const Job& job, std::size_t index, Workspace& workspace) {
  TracedItem out;
  const Item& item = job.items[index];
  const StopTransmittance stop = job.stops.empty() ? StopTransmittance{} : job.stops[index];
  const IrisShape& iris = stop.pattern ? job.round : job.iris;
  const OpticalPath path = stop.widened(ghost_path(job.lens, item.ghost, item.lambda_nm));
  const ReflectanceTables& tables = job.tables.at(item.lambda_nm);
  const EntranceWindow window = entrance_window(job.lens, item.light);
  const auto count_rays = [&](std::uint64_t rays) {
    out.counts.rays += rays;
    out.counts.surface_hits += rays * path.steps.size();
  };

  auto start = Clock::now();
  const pupils::PupilEffort effort = pupils::effort_for_grid(job.options.grid.rays);
  const pupils::Pupil pupil =
      job.kept.find_window_pupil({item.ghost, item.light, item.lambda_nm, path.stop_radius_mm,
                                  stop.traced_iris(job.lens.iris), effort, &job.context},
                                 [&] {
                                   pupils::PupilRays rays(path, tables, item.light, iris, window);
                                   return find_pupil(rays, {.effort = effort, .context = &job.context}, workspace.grid);
                                 });
  out.counts.search_ms = ms_since(start);
  if (pupil.is_empty()) return out;
  count_rays(pupil.rays);

  start = Clock::now();
  const int side = tiled::side_of_grid(job.options.grid, job.lens, pupil.sensor_mm);
  const auto precision =
      precision_for(path, tables, item.light, window.z_mm, pupil.box(), side, job.frame.pixel_pitch_mm);
  workspace.grid.trace(path, tables, iris, item.light, window.z_mm, pupil.box(), side, precision);
  count_rays(static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side));
  const tiled::TracedPass traced{item.light.shared_flux(),
                                 static_cast<std::uint32_t>(index),
                                 item.shift_mm,
                                 stop.has_front() ? &stop.dirt->site() : nullptr,
                                 item.light,
                                 window.z_mm};
  out.counts.primitives = workspace.builder.build(workspace.grid, traced, out.buffer);
  out.counts.trace_ms = ms_since(start);
  return out;
}

// Traces all items; the frame takes their primitives in order and draws whenever its buffer is full.
bool trace_all(const Job& job, tiled::TiledFrame& frame, Counts& counts) {
  Workspaces workspaces(job.frame, job.options);
  return ordered_pipeline(
      job.items.size(), job.context,
      [&](std::size_t k) {
        auto workspace = workspaces.take();
        TracedItem item = trace_item(job, k, *workspace);
        workspaces.give_back(std::move(workspace));
        return item;
      },
      [&](std::size_t, const TracedItem& item) {
        counts.add(item.counts);
        frame.add(item.buffer);
      });
}

// Draws the items of a job and adds its work to the statistics. Incomplete when cancelled.
Image draw_items(const Job& job, RenderStatistics& stats) {
  const auto start = Clock::now();
  tiled::TiledFrame frame(job.frame, job.options, job.context, job.iris, job.gains, {}, job.stops);
  Counts counts;
  trace_all(job, frame, counts);
  const double trace_ms = ms_since(start) - frame.draw_ms();
  frame.draw();
  RenderStatistics own;
  own.method = "tiled";
  own.rays = counts.rays;
  own.surface_hits = counts.surface_hits;
  own.primitives = counts.primitives;
  // Search and tracing run in parallel on all threads: each is given its fraction of the elapsed time.
  const double busy_ms = counts.search_ms + counts.trace_ms;
  const double scale = busy_ms > 0.0 ? trace_ms / busy_ms : 0.0;
  own.time_ms = {{"search", counts.search_ms * scale}, {"trace", counts.trace_ms * scale}};
  frame.report(own);
  add(stats, own);
  return frame.take_image();
}

}  // namespace

Result<DrawnFlare> render_tiled(const PlannedFrame& planned, const TiledOptions& options, const Context& context) {
  const auto start = Clock::now();
  if (const auto ok = check(options); !ok) return tl::unexpected<Error>(ok.error());
  const LensState& lens = planned.lens;
  const Frame& pixels = planned.settings.frame;
  const auto with_passes = with_adaptive_passes(planned.plan, lens, pixels, context);
  if (!with_passes) return interrupted();
  const FramePlan& plan = *with_passes;
  StopTransmittances stops(lens, planned.settings, plan.dirt, planned.cache);
  if (!stops.prepare(plan, context)) return interrupted();
  KeptDevice& kept = *planned.cache.section<KeptDevice>({});
  if (kept.may_draw(tiled::device_lacks(stops, plan))) {
    auto drawn = tiled::draw_on_device(kept, options, stops, planned, plan, context);
    if (!kept.falls_back(drawn)) return drawn;
  }
  const std::size_t layer_count = plan.layers ? plan.layers->count() : 1;
  LayerImages images(plan, pixels);
  DrawnFlare flare;
  RenderStatistics& stats = flare.statistics;
  for (std::size_t layer = 0; layer < layer_count; ++layer) {
    Context part = context;
    if (context.progress)
      part.progress = [&](double done) {
        context.progress(kTracingProgress * (static_cast<double>(layer) + done) / static_cast<double>(layer_count));
      };
    Job job{lens, pixels, options, part, plan.tables, *plan.kept_pupils, IrisShape(lens.iris), {}, {}};
    list_items(plan, layer, stops, job);
    if (plan.layers && job.items.empty()) continue;
    images.set(layer, draw_items(job, stats));
    if (context.cancelled()) return interrupted();
  }
  if (context.progress) context.progress(1.0);

  stats.method = "tiled";
  stats.ghosts_rendered = static_cast<int>(plan.ghosts.size());
  stats.ghosts_skipped_flux = plan.skipped_flux;
  images.move_to(flare);
  stats.time_ms.emplace_back("total", ms_since(start));
  return flare;
}

}  // namespace contrejour::inline internal
