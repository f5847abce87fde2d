// Where a ghost's light enters, and what bounds it: by grids of rays over the entrance window, each in the lit part of
// the one before.
#pragma once

#include <optional>
#include <vector>

#include "ghosts/light_frame.h"
#include "optics/trace/lens_steps.h"
#include "render/area/linear_map.h"

namespace contrejour::area {

inline constexpr int kRims = kMaxStopCrossings;  // after the stop's crossings

// A ray that gets through beside one that does not.
struct BorderRay {
  Vec2 start_mm;
  int bound = 0;  // what blocks the other: a crossing of the stop, or kRims
};

struct GhostPupil {
  int bound = 0;  // what most of its border is
  double bound_share = 1.0;
  bool is_open = false;  // false: no ray gets through, and what follows is of the one that is blocked least
  double outside = 0.0;  // by how much that one is, over what blocks it
  // Start of a ray that gets through: near the middle of the stop where that is nearly all of the border, else amid
  // all.
  Vec2 at_mm;
  LinearMap covariance = kNowhere;  // of the starts of all that get through, mm^2
  double area_mm2 = 0.0;            // that these fill
  double border_mm = 0.0;           // length of its border, about
  std::vector<Vec2> inside_mm;      // starts of some of them, evenly spread
  std::vector<BorderRay> border;    // some of those at the border, likewise

  [[nodiscard]] bool is_whole() const { return is_open && bound != kRims && bound_share > 0.85; }
};

// At the wavelength of the steps. None where all rays fail. The iris counts as its circumscribed circle. The window is
// that of the light's frame, the pupil is in place.
[[nodiscard]] std::optional<GhostPupil> find_ghost_pupil(const LensSteps& steps, const Ghost& ghost,
                                                         const LightFrame& light, const EntranceWindow& window);

}  // namespace contrejour::area
