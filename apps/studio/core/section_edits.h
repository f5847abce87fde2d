// SPDX-License-Identifier: Apache-2.0
// Surfaces as they are dragged in the section. Rows count from 0. Errors: those of the prescription's table (a gap that
// would be negative, a rim that the sphere does not reach). Thread-safety: pure functions.
#pragma once

#include "contrejour/expert/vec.h"
#include "contrejour/lens.h"

namespace contrejour::studio {

enum class SurfaceGrip {
  Vertex,  // along the axis: the gaps before and behind change, all other surfaces stay
  Rim,  // along the axis, with the vertex where it is: the radius changes
};

// The part of a surface that is held in the section: its rim, from half its height on.
[[nodiscard]] SurfaceGrip grip_at(const Surface& surface, double height_mm);

// The lens with the surface's grip moved by so much. Errors: also the first vertex, from which z counts, and the stop's
// rim; a zoom's gap, which differs from position to position; an asphere's rim.
[[nodiscard]] Result<Prescription> with_surface_dragged(const Prescription& lens, std::size_t row, SurfaceGrip grip,
                                                        double along_mm);

}  // namespace contrejour::studio
