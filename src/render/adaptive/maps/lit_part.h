// The part of a box of the pupil whose light may get through and land in the frame, from a sheet of its rays.
#pragma once

#include <optional>
#include <span>

#include "contrejour/frame.h"
#include "render/adaptive/maps/rays.h"

namespace contrejour::adaptive {

// Bounds of the cells between the nodes that may do so at any wavelength of the sheets, which are of one box; none if
// none may. The iris counts as its circumscribed circle. with_mirror_image: or whose mirror image's light may.
[[nodiscard]] std::optional<Rectangle> lit_part(std::span<const RaySheet> sheets, const LightFrame& light,
                                                const Frame& frame, bool with_mirror_image);

}  // namespace contrejour::adaptive
