// Newton's step on the stop: where in the entrance plane rays cross the stop inside its rim, from a grid of rays that
// is still too coarse to show it. The stop is nearly an affine image of a small pupil.
#pragma once

#include <optional>

#include "ghosts/pupils/clearance_grid.h"

namespace contrejour::pupils {

struct Aim {
  // Holds what crosses inside the stop's rim but for a tenth of its half: slopes are of the second order, over cells
  // many times as large. Boxes are searched about it with twice that margin.
  Rectangle box;
  double error = 0;  // estimated, of the map, in stop radii; the box is larger by as much
};

// From the differences about that ray of a piece which crosses closest to the middle of the stop. None where these do
// not tell: rays that fail, a map that folds or bends, cells that may let light through elsewhere.
[[nodiscard]] std::optional<Aim> aim_at_stop(const ClearanceGrid& grid, const std::vector<GridCell>& piece);

}  // namespace contrejour::pupils
