// SPDX-License-Identifier: Apache-2.0
// The image of a distant point through a pupil at one wavelength: the Fraunhofer pattern, in absolute units.
// Irradiance (flux per mm^2) at points of the plane where the pupil's wave converges, at a pitch that the caller
// chooses. Its integral over the plane is the given flux. Rows from the top, x right, y up, the axis in the middle, in
// the orientation of the pupil (a lens inverts both on the sensor, so this pattern is upright in the image). Accuracy:
// exact for the samples of the mask up to |x| < lambda d / (2 mask pitch), where it starts to repeat. Errors:
// InvalidArgument for lengths that are not positive and masks that let nothing through, Cancelled. Thread-safety: pure
// functions. Source: Goodman 2005 eq. 4-25, 5-14; hullin2011 eq. 2.
#pragma once

#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/pupil_mask.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

struct PatternGrid {
  int side = 512;
  double pitch_mm = 1e-3;
};

struct FraunhoferSettings {
  double distance_mm = 50.0;  // exit pupil to sensor; the mask is as large as the exit pupil
  double lambda_nm = 550.0;
  double flux = 1.0;
  PatternGrid grid;
};

struct FraunhoferPattern {
  PatternGrid grid;
  std::vector<double> irradiance_per_mm2;  // [row * side + column]
};

[[nodiscard]] CONTREJOUR_API Result<FraunhoferPattern> fraunhofer_pattern(const PupilMask& mask,
                                                                          const FraunhoferSettings& settings,
                                                                          const Context& context = {});

}  // namespace contrejour
