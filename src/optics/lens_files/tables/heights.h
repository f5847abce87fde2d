// Flare programs' files give each surface a height, and do not agree, not even with themselves, whether it is the
// radius or the diameter of the clear aperture.
#pragma once

#include <optional>

#include "contrejour/lens.h"
#include "optics/lens_files/complete.h"

namespace contrejour {

enum class HeightMeaning { SemiDiameter, Diameter, Unusable };

// What the heights of a lens mean, which stand in place of its semi-diameters (0: not told):
// - where the widest f-number is known, the stop's own, against what the real marginal ray needs there; unless the
//   computed focal length is more than a fifth off the stated one, or the heights are not 0.7 to 3 times the need. From
//   1.7 on they are diameters; a stop may well be a little wider than it must, but not much narrower;
// - else as told, if so no surface ends and no neighbours cross before three quarters of their rims;
// - else diameters, if as such they do not; else they are no rims at all.
[[nodiscard]] HeightMeaning meaning_of_heights(const Prescription& lens, std::optional<double> f_number,
                                               HeightMeaning told = HeightMeaning::SemiDiameter);

// Makes them semi-diameters; 0 where they are unusable, which completed() sizes for a beam.
void apply_heights(Prescription& lens, HeightMeaning meaning);

// That of the stated focal length and f-number, out to a full frame's corner; none unless both are known.
[[nodiscard]] std::optional<Beam> full_frame_beam(const Prescription& lens);

// A lens whose numbers, misread or mistyped, form no image behind it keeps its sensor at the stated back focal
// distance, with a warning. Any other lens stays as it is.
void keep_sensor_without_image(Prescription& lens);

// Openings of a drawing that neither refract nor block elsewhere: planes with the same medium on both sides. One with a
// negative gap behind it, drawn within the lens that follows, moves to that lens's vertex.
void place_openings(Prescription& lens);

}  // namespace contrejour
