// SPDX-License-Identifier: Apache-2.0
// The area over which a ghost's light is spread, by parts of the light that each are a Gaussian.
#pragma once

#include <span>

#include "base/linear_map.h"

namespace contrejour::inline internal::area {

struct GhostPart {
  Vec2 at_px;
  LinearMap covariance = kZeroMap;
  double light = 0.0;  // relative to all light of the ghost
};

// The area of a uniform ellipse with that covariance.
[[nodiscard]] double ellipse_px(const LinearMap& covariance);

// The light of these parts, blurred by this covariance, over its mean level, weighted by light: most of a ghost's light
// may be in a small part of its extent. At least about one pixel. For a uniform ellipse that is one part, it is the
// ellipse's area.
[[nodiscard]] double light_area_px(std::span<const GhostPart> parts, const LinearMap& blur);

}  // namespace contrejour::inline internal::area
