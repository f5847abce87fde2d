// Which lights share a starburst. Up to kOwnStarbursts of them have one each; of more, those whose images lie in the
// same cell of a grid fixed to the frame share that of their brightest, so that thousands of lights stay affordable.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/render.h"

namespace contrejour {

inline constexpr std::size_t kOwnStarbursts = 24;
inline constexpr int kSharingCells = 6;  // across the frame's longer side

// A light that has an image, and what of its value its starburst holds.
struct ImagedLight {
  std::size_t light = 0;  // of the caller's
  Vec2 centre_px;
  Rgb flux{};  // share of its value that gets through
};

using LightGroup = std::vector<ImagedLight>;  // brightest first

// Groups in the order of their first lights. Lights of different spectra never share, lights of the same place and
// spectrum always do.
[[nodiscard]] std::vector<LightGroup> group_lights(std::span<const Light> lights, std::span<const ImagedLight> imaged,
                                                   const Frame& frame);

}  // namespace contrejour
