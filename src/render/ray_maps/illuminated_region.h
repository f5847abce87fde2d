// SPDX-License-Identifier: Apache-2.0
// The part of a box of the pupil whose light may get through and land in the frame, found from a set of its rays.
#pragma once

#include <optional>
#include <span>

#include "contrejour/frame.h"
#include "render/ray_maps/lobatto_rays.h"

namespace contrejour::inline internal::ray_maps {

// The bounds of all cells between nodes whose light may do so at any wavelength of the ray sets, which are of one box;
// empty if there is none. The iris counts as its circumscribed circle. with_mirror_image: the light of the mirror image
// counts, too.
[[nodiscard]] std::optional<Rectangle> illuminated_region(std::span<const LobattoRays> ray_sets,
                                                          const LightFrame& light, const Frame& frame,
                                                          bool with_mirror_image);

}  // namespace contrejour::inline internal::ray_maps
