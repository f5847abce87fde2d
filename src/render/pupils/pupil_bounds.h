// SPDX-License-Identifier: Apache-2.0
// hullin2011 4.2, ray bounding by precomputation: rectangles of the entrance plane that contain every ray of a ghost
// that gets through, as functions of the light's angle, zoom and stop. They are in the frame of the light's meridian
// (meridian.h), where they are symmetric in y; the iris counts as a full circle, so they are valid for any blades.
// Same result for any thread count. Thread-safety: constant once built.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/ghost.h"
#include "render/pupils/pupil_search.h"

namespace contrejour::inline internal::pupils {

// One rectangle, and what a search found about it.
struct PupilRegion {
  Rectangle pupil_mm;   // enclosing, with a margin
  Rectangle sensor_mm;  // approximate bounds of its rays on the sensor
  std::uint64_t rays = 0;
};
// pupil: from a search over a window.
[[nodiscard]] inline std::optional<PupilRegion> region_of(const Pupil& pupil) {
  if (pupil.is_empty()) return std::nullopt;
  return PupilRegion{pupil.box(), pupil.sensor_mm, pupil.rays};
}

struct PupilBoundsRange {
  std::vector<Ghost> ghosts;
  std::vector<double> lambda_nm;  // one rectangle serves all of them; the shortest and the longest suffice
  double largest_angle_rad = 0;
};

// One lens state, over the light's angle. Differs: hullin2011 takes the union of neighbouring entries; here angles are
// added until linear interpolation is accurate, and the rectangle is widened by its remaining error.
class PupilBounds {
 public:
  // Incomplete when the context is cancelled.
  PupilBounds(const LensState& lens, const PupilBoundsRange& range, const Context& context);

  // None when nothing gets through. Angle and ghost must lie within the range.
  [[nodiscard]] std::optional<PupilRegion> find(Ghost ghost, double angle_rad) const;

  [[nodiscard]] std::uint64_t rays() const;
  [[nodiscard]] std::uint64_t surface_hits() const;

  // An interval between two angles. If one end has no region, the pupil closes between them.
  struct Stretch {
    double from_rad = 0, to_rad = 0;
    std::optional<PupilRegion> at_from, at_to;
    Vec2 margin_mm;
  };
  struct Entry {
    std::vector<Stretch> stretches;  // by rising angle, without gaps
    std::uint64_t rays = 0, surface_hits = 0;
  };

 private:
  std::map<Ghost, Entry> entries_;
};

// A prescription's bounds over zoom and stop: one PupilBounds for each pair, looked up for any lens state between them.
// The result contains the rectangles of all neighbouring pairs, as in hullin2011.
class ZoomPupilBounds {
 public:
  struct Settings {
    std::vector<double> focal_length_mm;  // rising; empty: a prime
    std::vector<double> f_number;  // rising
    LensSettings others;  // focus, coating, iris
  };

  // Errors: those of configure_lens(); Cancelled.
  [[nodiscard]] static Result<ZoomPupilBounds> build(const Prescription& lens, const Settings& settings,
                                                     const PupilBoundsRange& range, const Context& context);

  // As PupilBounds::find. A focal length or f-number beyond the table is clamped to its end.
  [[nodiscard]] std::optional<PupilRegion> find(const LensState& lens, Ghost ghost, double angle_rad) const;

 private:
  struct Node {
    double focal_length_mm = 0, stop_radius_mm = 0;
    PupilBounds bounds;
  };
  std::vector<std::vector<Node>> by_zoom_;  // rising focal length; within, falling stop radius
};

}  // namespace contrejour::inline internal::pupils
