// SPDX-License-Identifier: Apache-2.0
// The aperture stop of a lens whose file marks none.
#pragma once

#include "contrejour/lens.h"

namespace contrejour::inline internal {

// Adds a stop at the position that the rims imply, with a warning that names it; a lens with a stop is not changed.
// Rims are large enough for the axial beam and the oblique beams of the field, and an oblique beam passes the stop in
// its middle: the stop is put where the chief ray of one field fits all rims best (docs/formats/flaresim.md). A plane
// opening next to that position becomes the stop. If no gap is wide enough for an iris, the stop is in front of the
// first surface. The beam is that of lens.f_number, or for 0 the widest that the rims transmit. Semi-diameters of 0 are
// unknown. Errors: Unsupported for rows that form no image of distant objects behind them, or none near the stated
// focus (teleconverters, mirror lenses without their mirrors); those of validate().
[[nodiscard]] Result<void> place_missing_stop(Prescription& lens);

}  // namespace contrejour::inline internal
