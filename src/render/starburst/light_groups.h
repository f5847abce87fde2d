// SPDX-License-Identifier: Apache-2.0
// Groups the lights that share a starburst. Up to kOwnStarbursts lights have one each; with more lights, those with
// images in the same cell of a grid fixed to the frame share the starburst of the brightest, so that thousands of
// lights stay affordable.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/render.h"

namespace contrejour::inline internal {

inline constexpr std::size_t kOwnStarbursts = 24;
inline constexpr int kSharingCells = 6;  // across the frame's longer side

// A light that has an image, and the flux of its starburst.
struct ImagedLight {
  std::size_t light = 0;  // index among the caller's lights
  Vec2 centre_px;
  Rgb flux{};  // the part of its value that gets through
};

using LightGroup = std::vector<ImagedLight>;  // brightest first

// Returns groups in the order of their first lights. Lights of different spectra never share a starburst; lights of the
// same point and spectrum always do.
[[nodiscard]] std::vector<LightGroup> group_lights(std::span<const Light> lights, std::span<const ImagedLight> imaged,
                                                   const Frame& frame);

}  // namespace contrejour::inline internal
