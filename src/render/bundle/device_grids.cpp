// SPDX-License-Identifier: Apache-2.0
#include "render/bundle/device_grids.h"

#include <optional>

#include "base/tasks.h"
#include "render/bundle/item_renderer.h"
#include "render/device/device_frame.h"

namespace contrejour::inline internal::bundle {
namespace {

// Below this number of rays a side, a cell's arcs are cut by more tangents than a device has memory for.
constexpr int kFewestRays = 16;

struct FoundGrids {
  std::vector<PatternedGrid> grids;
  Counts counts;
};

// The grids of an item's passes.
FoundGrids find_grids(const Item& item, const Frame& frame, const GridSource& source) {
  FoundGrids found;
  GhostGrid grid(source, frame.pixel_pitch_mm);
  for (const PlannedPass& pass : item.passes) {
    const auto pupil = grid.find(item.ghost, item.light->source, pass.lambda_nm, false);
    if (!pupil) continue;
    const auto [side, precision] = grid.sampling_of(*pupil);
    const Rectangle& box = pupil->region.pupil_mm;
    const ReflectanceTables& tables = source.tables.at(pass.lambda_nm);
    PacketPath path(pupil->path, tables, {{0.0, 0.0, pupil->plane_z_mm}, item.light->source});
    path.start_from(box.low);
    const Rgb gain = item.adjustment->tinted(pass.gain);
    DeviceGrid made{.path = std::move(path),
                    .step_mm = (box.high - box.low) * (1.0 / (side - 1)),
                    .side = side,
                    .precision = precision,
                    .irradiance = item.light->source.shared_flux() * pupil->stop.level(),
                    .gain = {static_cast<float>(gain[0]), static_cast<float>(gain[1]), static_cast<float>(gain[2])},
                    .shift_mm = item.adjustment->shift_mm};
    if (pupil->stop.has_front()) made.front_gap_mm = pupil->stop.dirt->site().front_z_mm - pupil->plane_z_mm;
    found.grids.push_back({std::move(made), pupil->stop.pattern});
    grid.counts().rays += static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side);
    grid.counts().surface_hits +=
        static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side) * pupil->path.steps.size();
  }
  found.counts = grid.counts();
  return found;
}

}  // namespace

std::string device_lacks(const GridSource& source, const FramePlan& plan) {
  const BundleOptions& options = source.options;
  if (std::string lacks = stop_lacks(source.stops, plan); !lacks.empty()) return lacks;
  if (options.mirror_symmetry) return "mirrored grids are";
  if (options.precomputed_bounds) return "precomputed pupils are";
  if (options.spectral_filter) return "the spectral filter is";
  if (options.anisotropic != BundleOptions::Anisotropic::Exact) return "lines in place of exact coverage are";
  if (options.grid.rays < kFewestRays) return "grids of fewer than 16 rays a side are";
  return {};
}

Result<DrawnFlare> draw_on_device(KeptDevice& kept, const GridSource& source, const PlannedFrame& planned,
                                  const FramePlan& plan, const Context& context) {
  DeviceFrame frame(plan, planned.settings.frame, planned.cache);
  const std::vector<Item> items = items_of(plan, source.options);
  Counts counts;
  const bool done = ordered_pipeline(
      items.size(), part_of(context, kDeviceSearch),
      [&](std::size_t k) { return find_grids(items[k], planned.settings.frame, source); },
      [&](std::size_t k, FoundGrids& found) {
        counts.add(found.counts);
        frame.add(items[k].layer, std::move(found.grids));
      });
  if (!done) return interrupted();
  RenderStatistics statistics;
  statistics.method = "bundle";
  statistics.rays = counts.rays;
  statistics.surface_hits = counts.surface_hits;
  return frame.draw(*kept.device, source.lens.iris, source.options, std::move(statistics), context);
}

}  // namespace contrejour::inline internal::bundle
