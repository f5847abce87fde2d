// SPDX-License-Identifier: Apache-2.0
#include "render/tiled/device_grids.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/tasks.h"
#include "render/device/device_frame.h"
#include "render/planning/grid_side.h"
#include "render/pupils/kept_pupils.h"

namespace contrejour::inline internal::tiled {
namespace {

// bodonyi2023 eq. 13 uses at least this fraction of the grid's rays.
constexpr double kMinFraction = 0.05;

struct DevicePass {
  Ghost ghost;
  const AppliedAdjustment* adjustment = nullptr;
  const PlannedLight* light = nullptr;
  PlannedPass pass;
  std::size_t layer = 0;
};

std::vector<DevicePass> passes_of(const FramePlan& plan) {
  std::vector<DevicePass> all;
  for_each_pair_with_passes(plan, [&](std::size_t g, std::size_t k, std::span<const PlannedPass> passes) {
    for (const PlannedPass& pass : passes)
      all.push_back({plan.ghosts[g], &plan.adjustments[g], &plan.lights[k], pass, plan.layer_of(g, k)});
  });
  return all;
}

struct FoundGrid {
  std::optional<PatternedGrid> grid;
  std::uint64_t rays = 0, surface_hits = 0;
};

// The input of a search for pupils.
struct SearchInput {
  const LensState& lens;
  const TiledOptions& options;
  const StopTransmittances& stops;
  const FramePlan& plan;
  double pixel_pitch_mm;
  const Context& context;
};

FoundGrid find_grid(const DevicePass& item, const SearchInput& from) {
  const LightSource& light = item.light->source;
  const StopTransmittance stop = from.stops.of(item.ghost, item.pass.lambda_nm, light);
  const OpticalPath path = stop.widened(ghost_path(from.lens, item.ghost, item.pass.lambda_nm));
  const ReflectanceTables& tables = from.plan.tables.at(item.pass.lambda_nm);
  const Iris traced_iris = stop.traced_iris(from.lens.iris);
  const IrisShape iris(traced_iris);
  const EntranceWindow window = entrance_window(from.lens, light);
  const pupils::PupilEffort effort = pupils::effort_for_grid(from.options.grid.rays);
  const pupils::Pupil pupil = from.plan.kept_pupils->find_window_pupil(
      {item.ghost, light, item.pass.lambda_nm, path.stop_radius_mm, traced_iris, effort, &from.context}, [&] {
        return find_pupil(pupils::PupilRays(path, tables, light, iris, window),
                          {.effort = effort, .context = &from.context});
      });
  FoundGrid found;
  if (pupil.is_empty()) return found;
  const Rectangle box = pupil.box();
  const int side = side_of_grid(from.options.grid, from.lens, pupil.sensor_mm);
  found.rays = pupil.rays + static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side);
  found.surface_hits = found.rays * path.steps.size();
  PacketPath packets(path, tables, {{0.0, 0.0, window.z_mm}, light});
  packets.start_from(box.low);
  const Rgb gain = item.adjustment->tinted(item.pass.gain);
  DeviceGrid made{.path = std::move(packets),
                  .step_mm = (box.high - box.low) * (1.0 / (side - 1)),
                  .side = side,
                  .precision = precision_for(path, tables, light, window.z_mm, box, side, from.pixel_pitch_mm),
                  .irradiance = light.shared_flux() * stop.level(),
                  .gain = {static_cast<float>(gain[0]), static_cast<float>(gain[1]), static_cast<float>(gain[2])},
                  .shift_mm = item.adjustment->shift_mm};
  if (stop.has_front()) made.front_gap_mm = stop.dirt->site().front_z_mm - window.z_mm;
  found.grid = PatternedGrid{std::move(made), stop.pattern};
  return found;
}

}  // namespace

int side_of_grid(const GridOptions& grid, const LensState& lens, const Rectangle& sensor_mm) {
  const int min_count = std::max(2, static_cast<int>(std::lround(grid.rays * kMinFraction)));
  return grid_side(grid, lens, sensor_mm, min_count);
}

std::string device_lacks(const StopTransmittances& stops, const FramePlan& plan) { return stop_lacks(stops, plan); }

Result<DrawnFlare> draw_on_device(KeptDevice& kept, const TiledOptions& options, const StopTransmittances& stops,
                                  const PlannedFrame& planned, const FramePlan& plan, const Context& context) {
  DeviceFrame frame(plan, planned.settings.frame, planned.cache);
  const std::vector<DevicePass> passes = passes_of(plan);
  const SearchInput input{planned.lens, options, stops, plan, planned.settings.frame.pixel_pitch_mm, context};
  RenderStatistics statistics;
  statistics.method = "tiled";
  const bool done = ordered_pipeline(
      passes.size(), part_of(context, kDeviceSearch), [&](std::size_t k) { return find_grid(passes[k], input); },
      [&](std::size_t k, FoundGrid& found) {
        statistics.rays += found.rays;
        statistics.surface_hits += found.surface_hits;
        if (found.grid) frame.add(passes[k].layer, {std::move(*found.grid)});
      });
  if (!done) return interrupted();
  return frame.draw(*kept.device, planned.lens.iris, options, std::move(statistics), context);
}

}  // namespace contrejour::inline internal::tiled
