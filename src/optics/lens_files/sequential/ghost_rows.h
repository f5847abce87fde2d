// SPDX-License-Identifier: Apache-2.0
// A ghost's path as the surfaces of a sequential design: each as often as the light meets it, mirrors where it
// reflects.
#pragma once

#include "contrejour/expert/ghost_id.h"
#include "contrejour/lens.h"
#include "contrejour/result.h"
#include "optics/lens_files/sequential/design_writer.h"

namespace contrejour::inline internal {

// Surfaces have the poses of the lens, gaps are along the axis and negative where light travels back. The stop is at
// the first crossing; the other crossings are plane openings of the same size. Errors: InvalidArgument for a ghost that
// the lens cannot have; Unsupported for an order of diffraction at the sensor.
[[nodiscard]] Result<WritableDesign> ghost_rows(const LensState& lens, const Ghost& ghost);

}  // namespace contrejour::inline internal
