// SPDX-License-Identifier: Apache-2.0
// Flare programs' files give each surface a height, which is the radius of the clear aperture in some files and the
// diameter in others, even of one program.
#pragma once

#include <optional>

#include "contrejour/lens.h"
#include "optics/lens_files/complete.h"

namespace contrejour::inline internal {

enum class HeightMeaning { SemiDiameter, Diameter, Unusable };

// Determines the meaning of the heights, which are stored as semi-diameters (0: unknown):
// - if the widest f-number is known, by the ratio of the stop's height to that of the real marginal ray: from 1.7 on
//   heights are diameters, since a stop may be a little wider than the ray but not much narrower. This does not apply
//   if the computed focal length deviates from the stated one by more than a fifth, or the ratio is not 0.7 to 3;
// - else radii, if the file says so and with these no surface ends and no neighbours cross within three quarters of
//   their rims;
// - else diameters, if they pass this test; else they are unusable.
[[nodiscard]] HeightMeaning meaning_of_heights(const Prescription& lens, std::optional<double> f_number,
                                               HeightMeaning stated = HeightMeaning::SemiDiameter);

// Converts the heights to semi-diameters; unusable ones become 0, which completed() sizes for a beam.
void apply_heights(Prescription& lens, HeightMeaning meaning);

// The beam of the stated focal length and f-number, for the corner of a full frame; none unless both are known.
[[nodiscard]] std::optional<Beam> full_frame_beam(const Prescription& lens);

// Puts the sensor at the stated back focal distance, with a warning, if the lens forms no image behind it because of
// wrong numbers. Any other lens is not changed.
void keep_sensor_without_image(Prescription& lens);

// Moves an opening, a plane with the same medium on both sides, to the vertex of the following surface if the gap
// behind it is negative.
void place_openings(Prescription& lens);

}  // namespace contrejour::inline internal
