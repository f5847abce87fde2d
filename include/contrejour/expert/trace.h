// SPDX-License-Identifier: Apache-2.0
// Sequential ray tracing along a prescribed path, as in hullin2011 4.1 and its supplement: the order of surfaces is
// fixed, surfaces continue beyond their rims, and intersections behind the ray's origin are allowed. Rays are not
// clipped: what would block them is recorded. Every refraction multiplies by T and every reflection by R (the
// supplement has R only). Accuracy: double; 1e-9 mm against closed forms.
// Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "contrejour/expert/ghost_id.h"
#include "contrejour/expert/light_source.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"

namespace contrejour {

inline namespace internal {
struct ShapeConstants;
}

// A line in space; the origin may lie anywhere on it.
struct Ray {
  Vec3 origin_mm;
  Vec3 direction;  // unit
};

enum class RayStatus : std::uint8_t {
  Ok,
  Missed,  // no intersection with the next surface
  TotalReflection,  // where the path requires a refraction
  NotFinite,  // NaN or infinite input
};
[[nodiscard]] CONTREJOUR_API const char* to_string(RayStatus status);

enum class PathEvent : std::uint8_t { Refract, Reflect, Stop };

// One step of a path, with everything precomputed that does not depend on the ray.
struct PathStep {
  PathEvent event = PathEvent::Refract;
  int surface = 0;  // 0-based
  int direction = +1;  // sign of the ray's z direction as it arrives
  double z_mm = 0;
  double curvature_per_mm = 0;
  double semi_diameter_mm = 0;
  double n_in = 1;  // medium the ray comes from
  double n_out = 1;  // medium on the other side (also for a reflection)
  Coating coating;
  SurfacePose pose = {};
  std::shared_ptr<const ShapeConstants> shape = nullptr;  // none: a sphere or a plane
  std::optional<Rim> rim = std::nullopt;  // in place of the semi-diameter's circle
  bool is_rim_only = false;  // one more rim of the step that follows, without refraction
  bool blocks_within = false;  // the rim is that of an obscuration
  double absorption_per_mm = 0;  // of the medium that the ray arrives through
  Vec2 grating_shift;  // of a reflecting grating: added to the direction's x and y
  double efficiency = 1;  // efficiency of the order: its fraction of the reflected light

  // A point is inside the rim where |rim_point| <= 1; own_mm: in the surface's own x and y from its axis.
  [[nodiscard]] Vec2 rim_point(Vec2 own_mm) const {
    return rim ? rim->coordinates(own_mm) : own_mm * (1.0 / semi_diameter_mm);
  }
};

// The optical path of a ghost or of the direct image through the lens at one wavelength.
struct OpticalPath {
  std::vector<PathStep> steps;
  double lambda_nm = kLineD_nm;
  double sensor_z_mm = 0;
  double stop_radius_mm = 1;
  int stop_crossings = 0;
  bool centred = true;  // every pose is that of a centred lens
  bool obscured = false;  // some steps have blocks_within set
};

inline constexpr int kMaxStopCrossings = 3;

struct TracedRay {
  RayStatus status = RayStatus::Ok;
  Vec2 sensor_mm;
  Vec3 direction;
  double transmission = 0;  // product of R and T along the path
  double relative_height = 0;  // largest distance from the axis over clear semi-diameter; > 1 is blocked
  double obscured = -1;  // largest depth of the ray within an obscuration, over its radius; > 0 is blocked
  // Stop coordinates over the stop radius at each crossing; iris_distance() of each must be <= 0.
  std::array<Vec2, kMaxStopCrossings> stop{};
};

[[nodiscard]] CONTREJOUR_API OpticalPath direct_path(const LensState& lens, double lambda_nm);
[[nodiscard]] CONTREJOUR_API OpticalPath ghost_path(const LensState& lens, Ghost ghost, double lambda_nm);

// True if all surfaces of the ghost's path have axial symmetry. The sensor counts only if the ghost reflects there.
[[nodiscard]] CONTREJOUR_API bool has_axial_symmetry(const LensState& lens, const Ghost& ghost);

[[nodiscard]] CONTREJOUR_API TracedRay trace(const OpticalPath& path, const Ray& ray);

// The same path without obscurations, so that all its bounds (rims and iris) are convex, as pupil searches require.
[[nodiscard]] CONTREJOUR_API OpticalPath without_obscurations(const OpticalPath& path);

// How far the ray passes outside all bounds: the largest of relative_height - 1, `obscured` and the iris distances; <=
// 0 gets through.
[[nodiscard]] CONTREJOUR_API double blocked_by(const TracedRay& ray, const OpticalPath& path, const Iris& iris);

// A record of the ray at each surface, for `lens trace` and drawings. It stops at the step that fails.
struct TraceStep {
  int surface = 0;  // 1-based
  PathEvent event = PathEvent::Refract;
  Vec3 position_mm;
  Vec3 direction_after;
  double angle_of_incidence_rad = 0;
  double reflectance = 0;
  bool is_rim_only = false;  // copied from the path's step; the record has one entry a step
};
struct RayRecord {
  TracedRay ray;
  std::vector<TraceStep> steps;
};
[[nodiscard]] CONTREJOUR_API RayRecord trace_recorded(const OpticalPath& path, const Ray& ray);

// Checks that rays from a light can be traced. Errors: InvalidArgument for numbers that are not finite, a light next to
// or behind the camera, a distance of 0 or less, and a point less than kNearestLight_mm in front of the whole lens.
inline constexpr double kNearestLight_mm = 0.1;
[[nodiscard]] CONTREJOUR_API Result<void> check_source(const LensState& lens, const LightSource& source);

// The rectangle of the plane z = z_mm that contains every ray of a light that can pass the clear aperture of surface 1.
// Grids over the entrance plane span it.
struct EntranceWindow {
  double z_mm = 0;
  Vec2 min_mm, max_mm;
};
[[nodiscard]] CONTREJOUR_API EntranceWindow entrance_window(const LensState& lens, const LightSource& source);

// The direction of a light at a given distance whose chief ray (through the centre of the stop) meets the sensor at a
// point; extrapolated rectilinearly where no chief ray gets through. The light may lie outside the frame.
[[nodiscard]] CONTREJOUR_API Vec3
direction_for_image_point(const LensState& lens, Vec2 sensor_mm, double lambda_nm,
                          double distance_mm = std::numeric_limits<double>::infinity());

// The chief-ray image point of a light (the inverse of the function above).
[[nodiscard]] CONTREJOUR_API Vec2 chief_ray_image_point(const LensState& lens, const LightSource& source,
                                                        double lambda_nm);

}  // namespace contrejour
