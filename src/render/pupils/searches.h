// SPDX-License-Identifier: Apache-2.0
// The ways in which find_pupil() searches; its header describes them.
#pragma once

#include "render/pupils/pupil_search.h"

namespace contrejour::inline internal::pupils {

[[nodiscard]] Pupil search_window(PupilRays& rays, const PupilSearch& search, RayGrid& grid);
[[nodiscard]] Pupil search_window_around(PupilRays& rays, const Rectangle& hint, RayGrid& grid);

[[nodiscard]] Pupil search_meridian(const PupilRays& rays, const PupilSearch& search);
// hint: a box that touches y = 0 is symmetric in y, others lie above it; the same holds for the result.
[[nodiscard]] Pupil search_meridian_around(const PupilRays& rays, const Rectangle& hint);

}  // namespace contrejour::inline internal::pupils
