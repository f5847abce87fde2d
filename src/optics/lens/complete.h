// What other programs' files leave open or draw too wide, so that every reader decides it alike.
#pragma once

#include <optional>

#include "contrejour/lens.h"

namespace contrejour {

// The light that passes a lens: what its surfaces must be large enough for.
struct Beam {
  double pupil_diameter_mm = 0;  // entrance pupil
  double half_field_rad = 0;     // of a distant object
};

// A prescription as a reader found it, made whole and checked:
// - semi-diameters of 0, not told, become what the beam needs by first-order optics, the widest field unvignetted;
// - where neighbours cross at their rims, or a surface ends before its rim, the smaller semi-diameters shrink to where
//   they do not, those told by a quarter at most;
// - an f-number of 0 becomes that of the ray parallel to the axis that just passes the stop's whole opening.
// Each change that a file's own numbers suffer is a warning. Errors: those of validate(), and none of an image behind
// the lens where the f-number is wanted.
[[nodiscard]] Result<Prescription> completed(Prescription lens, const std::optional<Beam>& beam = std::nullopt);

}  // namespace contrejour
