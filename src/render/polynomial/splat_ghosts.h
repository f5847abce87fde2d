// SPDX-License-Identifier: Apache-2.0
// Draws ghosts by random points, as sabatschus2022 draws dense ones, to compare with cells: each point's light is added
// to the pixel that it falls on. docs/physics/polynomial.md, "Random points".
#pragma once

#include "render/planning/frame_plan.h"
#include "render/pupils/ray_source.h"

namespace contrejour::inline internal {

// Errors: InvalidArgument for a number of points out of range; Unsupported for what points cannot draw: ringing, an
// iris with half-tones, dirt.
[[nodiscard]] Result<void> check_splatting(const PlannedFrame& planned, int points);

// points: along each side of the bounds of a ghost's light on the entrance plane, for each light and wavelength; they
// are evaluated where `fitted` has the ghost, traced elsewhere. The same picture for any number of threads. The only
// error is Cancelled.
[[nodiscard]] Result<DrawnFlare> splat_ghosts(const PlannedFrame& planned, int points,
                                              const pupils::FittedGhosts& fitted, const Context& context);

}  // namespace contrejour::inline internal
