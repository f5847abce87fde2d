// Where a ghost's light enters, and what bounds it: by grids of rays over the entrance window, each in the lit part of
// the one before.
#pragma once

#include <optional>
#include <vector>

#include "optics/trace/lens_steps.h"
#include "render/area/linear_map.h"
#include "render/interface/light_frame.h"

namespace contrejour::area {

inline constexpr int kRims = kMaxStopCrossings;  // after the stop's crossings

struct GhostPupil {
  int bound = 0;  // what most of its border is: a crossing of the stop, or kRims
  double bound_share = 1.0;
  bool is_open = false;  // false: no ray gets through, and what follows is of the one that is blocked least
  // Start of a ray that gets through: near the middle of the stop where that is nearly all of the border, else amid
  // all.
  Vec2 at_mm;
  LinearMap covariance = kNowhere;   // of the starts of all that get through, mm^2
  std::vector<Vec2> border_mm;       // starts of the four outermost of these, along the axes
  std::vector<Vec2> beyond_rims_mm;  // and of some rays beside the border that rims block

  [[nodiscard]] bool is_whole() const { return is_open && bound != kRims && bound_share > 0.85; }
};

// At the wavelength of the steps. None where no ray gets through, nor nearly. The iris counts as its circumscribed
// circle. The window is that of the light's frame, the pupil is in place.
[[nodiscard]] std::optional<GhostPupil> find_ghost_pupil(const LensSteps& steps, const Ghost& ghost,
                                                         const LightFrame& light, const EntranceWindow& window);

}  // namespace contrejour::area
