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

// For questions that films have no part in: to design those of a coating takes milliseconds.
[[nodiscard]] inline LensSettings without_films() { return {.coating = Coating{}}; }

// For questions that rims and f-number have no part in.
inline constexpr double kNoRim_mm = 1e-3, kAnyFNumber = 8.0;

// What is left of a semi-diameter that a file tells; less, and its other numbers are wrong.
inline constexpr double kLeastShare = 0.75;

// A prescription as a reader found it, made whole and checked:
// - semi-diameters of 0, not told, become what the beam needs by first-order optics, the widest field unvignetted;
// - where neighbours cross at their rims, or a surface ends before its rim, the smaller semi-diameters shrink to where
//   they do not, those told to least_share of themselves at the least; where that is not enough and they cross by some
//   hundredths of a millimetre, as two radii given for one contact do, their gap becomes so much wider;
// - an f-number of 0 becomes that of the ray parallel to the axis that just passes the stop's whole opening.
// Each change that a file's own numbers suffer is a warning. Errors: those of validate(), and none of an image behind
// the lens where the f-number is wanted.
[[nodiscard]] Result<Prescription> completed(Prescription lens, const std::optional<Beam>& beam = std::nullopt,
                                             double least_share = kLeastShare);

}  // namespace contrejour
