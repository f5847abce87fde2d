// Boxes of the pupil behind a screen: how bright their light is at the most.
#pragma once

#include <optional>

#include "ghosts/light_frame.h"
#include "render/adaptive/maps/rays.h"
#include "render/screens/band_screen.h"

namespace contrejour::adaptive {

// About the largest irradiance on the sensor, per mm^2, between rays of a sheet that arrive, for a gain of 1; beside
// rays that fail it is taken to be as bright as anywhere. Where it is above `enough`, something above that.
// with_mirror_image: or of mirrored(sheet). unit: of the sheet's stop coordinates, in stop radii. None: nowhere do four
// rays side by side arrive.
[[nodiscard]] std::optional<double> brightest_passed(const RaySheet& sheet, bool with_mirror_image,
                                                     const screens::BandScreen& screen, double unit,
                                                     const LightFrame& light, double enough);

}  // namespace contrejour::adaptive
