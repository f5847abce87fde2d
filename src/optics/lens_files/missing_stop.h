// The aperture stop of a lens whose file marks none.
#pragma once

#include "contrejour/lens.h"

namespace contrejour {

// Puts a stop where the rims say, with a warning that names the place; a lens that has a stop stays as it is.
// Rims are large enough for the beam along the axis and the tilted ones of the field, and a tilted beam passes the stop
// in its middle: the stop is put where one field's chief ray explains all rims best (docs/formats/flaresim.md). A plane
// opening beside that place becomes the stop. Where no gap has room for an iris it stands in front of the first
// surface. The beam is that of lens.f_number, 0: the widest that the rims let through. Semi-diameters of 0 are not
// told. Errors: Unsupported for rows that form no image of distant objects behind them, or none near the stated one
// (teleconverters, mirror lenses without their mirrors); those of validate().
[[nodiscard]] Result<void> place_missing_stop(Prescription& lens);

}  // namespace contrejour
