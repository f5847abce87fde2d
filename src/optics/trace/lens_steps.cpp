// SPDX-License-Identifier: Apache-2.0
#include "optics/trace/lens_steps.h"

#include <algorithm>

#include "optics/trace/path_steps.h"

namespace contrejour::inline internal {

LensSteps::LensSteps(const LensState& lens, const ReflectanceTables& tables)
    : lens_(lens), tables_(tables), surfaces_(lens.surfaces.size()) {
  const bool centred = std::ranges::all_of(lens.surfaces, &SurfaceState::is_centred);
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    for (const int direction : {+1, -1}) {
      OpticalPath path;
      path.lambda_nm = tables.lambda_nm();
      path.centred = centred;
      add_steps(path, lens, static_cast<int>(k), direction, PathEvent::Refract);
      const PacketPath packets(path, tables, {});
      AtSurface& at = surfaces_[k][direction > 0 ? 0 : 1];
      at.steps = packets.steps();
      at.vertex_mm = Vec3{0.0, 0.0, path.steps.back().z_mm} + path.steps.back().pose.shift_mm;
      at.geometry = packets.geometry();
      for (const PathStep& step : path.steps)
        if (step.shape) at.shapes.push_back(step.shape);
    }
  }
}

PacketPath::PacketPath(const LensSteps& from, const Ghost& ghost, const LightRays& rays, double stop_times)
    : tables_(from.tables().values()), source_(rays.source),
      inverse_stop_radius_per_mm_(1.0 / (from.lens().stop_radius_mm * stop_times)) {
  start_.origin_mm = rays.origin_mm;
  start_from({rays.origin_mm.x, rays.origin_mm.y});
  steps_.reserve(3 * from.lens().surfaces.size());
  Vec3 before_mm{0.0, 0.0, rays.origin_mm.z};
  walk_ghost(
      from.lens(), ghost,
      [&](int surface, int direction, PathEvent event) {
        const LensSteps::AtSurface& at = from.at(surface, direction);
        const std::size_t first = steps_.size();
        steps_.insert(steps_.end(), at.steps.begin(), at.steps.end());
        steps_[first].gap_mm = at.vertex_mm.z - before_mm.z;
        steps_[first].offset_mm = {at.vertex_mm.x - before_mm.x, at.vertex_mm.y - before_mm.y};
        PacketStep& last = steps_.back();
        if (last.event == PathEvent::Stop)
          last.crossing = stop_crossings_++;
        else
          last.event = event;
        geometry_ = std::max(geometry_, at.geometry);
        before_mm = at.vertex_mm;
      },
      [&](int surface, std::array<int, 2> order) {
        const auto deflection = grating_deflection(from.lens(), surface, order, from.tables().lambda_nm());
        if (!deflection) return;
        steps_.back().grating_shift = deflection->grating_shift;
        steps_.back().efficiency = deflection->efficiency;
        if (deflection->efficiency != 1.0) geometry_ = PathGeometry::General;
      });
  sensor_gap_mm_ = from.lens().sensor_z_mm - before_mm.z;
  sensor_offset_mm_ = {-before_mm.x, -before_mm.y};
}

}  // namespace contrejour::inline internal
