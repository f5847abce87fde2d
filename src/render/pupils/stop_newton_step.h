// SPDX-License-Identifier: Apache-2.0
// A Newton step onto the stop: predicts the region of the entrance plane whose rays cross the stop inside its rim, from
// a grid of rays that is too coarse to resolve it. The stop is nearly an affine image of a small pupil.
#pragma once

#include <optional>

#include "render/pupils/clearance_grid.h"

namespace contrejour::inline internal::pupils {

struct StopNewtonStep {
  // Contains the rays that cross inside the stop's rim, up to an error of a tenth of its half size: slopes are of
  // second order over cells many times as large. Boxes are searched about it with twice that margin.
  Rectangle box;
  double error = 0;  // estimated error of the map, stop radii; the box is enlarged by it
};

// Uses the differences about the ray of a piece that crosses closest to the middle of the stop. None if they are not
// conclusive: rays that fail, a map that folds or is too nonlinear, other cells that may transmit light.
[[nodiscard]] std::optional<StopNewtonStep> newton_step_to_stop(const ClearanceGrid& grid,
                                                                const std::vector<GridCell>& piece);

}  // namespace contrejour::inline internal::pupils
