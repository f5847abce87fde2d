// SPDX-License-Identifier: Apache-2.0
#include "render/bundle/ghost_grid.h"

#include <algorithm>
#include <cmath>

#include "render/bundle/stopwatch.h"
#include "render/planning/grid_side.h"

namespace contrejour::inline internal::bundle {
namespace {

// With fewer than 32 rays a side a caustic in a small ghost shows the grid as a four-pointed star.
constexpr int kMinScaled = 32;

void make_symmetric(Rectangle& r) {
  r.high.y = std::max(std::abs(r.low.y), std::abs(r.high.y));
  r.low.y = -r.high.y;
}

}  // namespace

void Counts::add(const Counts& other) {
  rays += other.rays;
  surface_hits += other.surface_hits;
  primitives += other.primitives;
  search_ms += other.search_ms;
  trace_ms += other.trace_ms;
  raster_ms += other.raster_ms;
}

const ReflectanceTables& GhostGrid::tables_of(const GhostPupil& pupil) const {
  return from_.tables.at(pupil.lambda_nm);
}

void GhostGrid::count_rays(std::uint64_t rays, const OpticalPath& path) {
  counts_.rays += rays;
  counts_.surface_hits += rays * path.steps.size();
}

std::optional<GhostPupil> GhostGrid::find(Ghost ghost, const LightSource& light, double lambda_nm, bool with_figures) {
  const Stopwatch watch(counts_.search_ms);
  const BundleOptions& options = from_.options;
  GhostPupil pupil;
  pupil.lambda_nm = lambda_nm;
  pupil.stop = from_.stops.of(ghost, lambda_nm, light);
  pupil.path = pupil.stop.widened(ghost_path(from_.lens, ghost, lambda_nm));
  const bool from_table = from_.bounds != nullptr && light.is_distant() && !pupil.stop.pattern;
  const bool in_meridian = mirrors() || from_table;
  pupil.meridian = in_meridian ? meridian_of(light) : Meridian{light, 0.0};
  pupil.iris = pupil.stop.traced_iris(rotated_back(from_.lens.iris, pupil.meridian));
  const EntranceWindow window = entrance_window(from_.lens, pupil.meridian.light);
  pupil.plane_z_mm = window.z_mm;

  const auto region = from_table ? from_.bounds->find(ghost, pupil.meridian.angle_rad()) : search(ghost, pupil, window);
  if (!region) return std::nullopt;
  pupil.region = *region;
  count_rays(region->rays, pupil.path);
  if (mirrors()) make_symmetric(pupil.region.pupil_mm);
  if (with_figures || options.grid_levels || options.anisotropic != BundleOptions::Anisotropic::Exact) {
    pupil.figures = figures_of(pupil);
  }
  return pupil;
}

std::optional<pupils::PupilRegion> GhostGrid::search(Ghost ghost, const GhostPupil& pupil,
                                                     const EntranceWindow& window) {
  using pupils::PupilEffort;
  const PupilEffort effort =
      from_.options.grid_levels ? PupilEffort::Finest : pupils::effort_for_grid(from_.options.grid.rays);
  const LightSource& light = pupil.meridian.light;
  return pupils::region_of(from_.kept.find_window_pupil(
      {ghost, light, pupil.lambda_nm, pupil.path.stop_radius_mm, pupil.iris, effort, &from_.context}, [&] {
        pupils::PupilRays rays(pupil.path, tables_of(pupil), light, IrisShape(pupil.iris), window);
        return find_pupil(rays, {.effort = effort, .context = &from_.context}, rays_);
      }));
}

MapFigures GhostGrid::figures_of(const GhostPupil& pupil) {
  rays_.trace(pupil.path, tables_of(pupil), IrisShape(pupil.iris), pupil.meridian.light, pupil.plane_z_mm,
              pupil.region.pupil_mm, kProbeSide, PacketPrecision::Double);
  rays_.rotate_sensor(pupil.meridian.rotation_rad);
  count_rays(static_cast<std::uint64_t>(kProbeSide) * kProbeSide, pupil.path);
  return measure_map(rays_);
}

int GhostGrid::side_of(const GhostPupil& pupil) const {
  if (from_.options.grid_levels) return grid_level(*pupil.figures);
  return grid_side(from_.options.grid, from_.lens, pupil.region.sensor_mm, kMinScaled);
}

GhostGrid::Sampling GhostGrid::sampling_of(const GhostPupil& pupil) const {
  const int side = side_of(pupil);
  return {side, precision_for(pupil.path, tables_of(pupil), pupil.meridian.light, pupil.plane_z_mm,
                              pupil.region.pupil_mm, side, pixel_pitch_mm_)};
}

void GhostGrid::trace(const GhostPupil& pupil) {
  const Stopwatch watch(counts_.trace_ms);
  const auto [side, precision] = sampling_of(pupil);
  const IrisShape iris(pupil.iris);
  const auto all = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  const Rectangle& box = pupil.region.pupil_mm;
  const LightSource& light = pupil.meridian.light;
  if (mirrors()) {
    count_rays(rays_.trace_mirrored(pupil.path, tables_of(pupil), iris, light, pupil.plane_z_mm, box, side, precision),
               pupil.path);
  } else {
    rays_.trace(pupil.path, tables_of(pupil), iris, light, pupil.plane_z_mm, box, side, precision);
    count_rays(all, pupil.path);
  }
  if (pupil.meridian.rotation_rad != 0.0) rays_.rotate_sensor(pupil.meridian.rotation_rad);
}

}  // namespace contrejour::inline internal::bundle
