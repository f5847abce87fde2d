// SPDX-License-Identifier: Apache-2.0
// The light for which a design is made, computed once its surfaces are known: entrance pupil, field, image.
#pragma once

#include "contrejour/lens.h"
#include "optics/lens_files/complete.h"
#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour::inline internal {

struct DesignLight {
  Beam beam;
  double f_number = 0;  // for distant objects; 0: determined by the stop's opening
  double focal_length_mm = 0;
  double focus_mm = 0;  // of distant objects, from the last row
  double image_radius_mm = 0;  // of the widest field; 0: the design has none but the axis
  bool stop_is_open = false;  // its size is unknown: the other surfaces limit the pupil
};

// object_mm: from the first row to the object, infinite for distant ones. Errors: those of configure_lens, and an
// aperture that leads to no pupil.
[[nodiscard]] Result<DesignLight> light_of(const SequentialDesign& design, Prescription rows, double object_mm);

}  // namespace contrejour::inline internal
