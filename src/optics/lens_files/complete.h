// SPDX-License-Identifier: Apache-2.0
// Completes what other programs' files omit or draw too large, so that all readers decide alike.
#pragma once

#include <optional>

#include "contrejour/lens.h"

namespace contrejour::inline internal {

// The beam for which a lens's surfaces must be large enough.
struct Beam {
  double pupil_diameter_mm = 0;  // entrance pupil
  double half_field_rad = 0;     // of a distant object
};

// Settings for computations that do not depend on films: designing a coating takes milliseconds.
[[nodiscard]] inline LensSettings without_films() { return {.coating = Coating{}}; }

// Values for computations that do not depend on rims and f-number.
inline constexpr double kNoRim_mm = 1e-3, kAnyFNumber = 8.0;

// The smallest fraction to which a stated semi-diameter may shrink; if less is needed, other numbers of the file are
// wrong.
inline constexpr double kMinRimFraction = 0.75;

// Completes and checks a prescription:
// - unknown semi-diameters, 0, become what the beam needs by first-order optics, with the widest field unvignetted;
// - where neighbours cross at their rims, or a surface ends before its rim, the smaller semi-diameters shrink until
// they
//   do not, known ones to min_fraction of themselves at most; where that is not enough and they cross by some
//   hundredths of a millimetre, as two radii for one contact surface do, their gap is widened by that;
// - an f-number of 0 becomes that of the ray parallel to the axis that just passes the stop's whole opening.
// Each change of a file's own numbers is a warning. Errors: those of validate(), and a lens without an image behind it
// if the f-number must be computed.
[[nodiscard]] Result<Prescription> completed(Prescription lens, const std::optional<Beam>& beam = std::nullopt,
                                             double min_fraction = kMinRimFraction);

}  // namespace contrejour::inline internal
