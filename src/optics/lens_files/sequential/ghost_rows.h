// A ghost's path as the surfaces of a sequential design: each as often as the light meets it, mirrors where it turns.
#pragma once

#include "contrejour/ghost_id.h"
#include "contrejour/lens.h"
#include "contrejour/result.h"
#include "optics/lens_files/sequential/design_writer.h"

namespace contrejour {

// Surfaces as they stand in the lens, gaps along the axis: negative where the light goes back. The stop is where the
// light crosses it first; its other crossings are plane openings as large. Errors: InvalidArgument for a ghost that the
// lens cannot have; Unsupported for an order of diffraction at the sensor.
[[nodiscard]] Result<WritableDesign> ghost_rows(const LensState& lens, const Ghost& ghost);

}  // namespace contrejour
