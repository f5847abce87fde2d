// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "contrejour/expert/ghost.h"
#include "contrejour/expert/published_samples.h"
#include "contrejour/expert/trace.h"
#include "polynomial/published/seeded_random.h"

namespace contrejour::published {
namespace {

struct EntranceRay {
  Vec2 entrance_mm, sensor_mm;
};

// Rays of one field that pass the stop and all rims, or pass them by less than the margin.
std::vector<EntranceRay> rays_of_field(const LensState& lens, const OpticalPath& path, double field,
                                       const ZoneSampling& sampling, polynomial::SeededRandom& random) {
  const LightSource light(normalized({field, 0.0, 1.0}));
  const EntranceWindow window = entrance_window(lens, light);
  const int most = 400 * sampling.rays;
  std::vector<EntranceRay> rays;
  for (int tried = 0; tried < most && static_cast<int>(rays.size()) < sampling.rays; ++tried) {
    const Vec2 at{window.min_mm.x + random.unit() * (window.max_mm.x - window.min_mm.x),
                  window.min_mm.y + random.unit() * (window.max_mm.y - window.min_mm.y)};
    const TracedRay ray = trace(path, {{at.x, at.y, window.z_mm}, normalized(Vec3{field, 0.0, 1.0})});
    if (ray.status != RayStatus::Ok || ray.relative_height > sampling.margin) continue;
    bool inside = true;
    for (int k = 0; k < path.stop_crossings; ++k)
      inside = inside && length(ray.stop[static_cast<std::size_t>(k)]) <= sampling.margin;
    if (inside) rays.push_back({at, ray.sensor_mm});
  }
  return rays;
}

ZoneSamples zone_of(const std::vector<EntranceRay>& rays, double radius_mm, bool along_field) {
  ZoneSamples zone;
  for (const EntranceRay& ray : rays) {
    const Vec2 at = ray.entrance_mm * (1.0 / radius_mm);
    zone.inputs.push_back({at.x, at.y, length(at), 1.0 - length(at)});
    zone.values.push_back(along_field ? ray.sensor_mm.x : ray.sensor_mm.y);
  }
  return zone;
}

}  // namespace

Result<GhostZones> zone_samples(const LensState& lens, const Ghost& ghost, const ZoneSampling& sampling) {
  if (!has_ghost(lens, ghost))
    return failure(ErrorCode::InvalidArgument, fmt::format("there is no ghost {} in this lens", ghost_name(ghost)));
  if (sampling.fields < 1 || sampling.rays < 1 || !(sampling.largest_field >= 0.0) || !(sampling.margin > 0.0))
    return failure(ErrorCode::InvalidArgument, "zones need fields, rays, a tangent of at least 0 and a margin above 0");
  const OpticalPath path = ghost_path(lens, ghost, sampling.lambda_nm);
  polynomial::SeededRandom random(sampling.seed);
  GhostZones all;
  std::vector<std::vector<EntranceRay>> rays;
  for (int k = 0; k < sampling.fields; ++k) {
    const double field = sampling.largest_field * k / std::max(sampling.fields - 1, 1);
    auto found = rays_of_field(lens, path, field, sampling, random);
    if (static_cast<int>(found.size()) < sampling.rays / 2) continue;
    for (const EntranceRay& ray : found) all.radius_mm = std::max(all.radius_mm, length(ray.entrance_mm));
    all.fields.push_back(field);
    rays.push_back(std::move(found));
  }
  if (rays.empty())
    return failure(ErrorCode::InvalidArgument, fmt::format("no light takes the path of ghost {}", ghost_name(ghost)));
  for (const auto& found : rays) all.zones.push_back(zone_of(found, all.radius_mm, sampling.along_field));
  return all;
}

}  // namespace contrejour::published
