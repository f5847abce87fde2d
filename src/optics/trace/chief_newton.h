// SPDX-License-Identifier: Apache-2.0
// Finds a light's chief ray through any lens, by Newton's method in both coordinates of the first vertex's plane.
#pragma once

#include <optional>

#include "contrejour/expert/trace.h"

namespace contrejour::inline internal {

inline constexpr double kAimed = 1e-10;  // of the stop radius, off its centre
inline constexpr int kAimSteps = 40;

struct ChiefRay {
  Vec2 at_mm;  // in that plane
  Vec2 image_mm;
};

// Starts from a first guess of its point in that plane. None if the iteration does not converge.
[[nodiscard]] std::optional<ChiefRay> aim_chief(const OpticalPath& path, const LightSource& source, Vec2 at_mm);

}  // namespace contrejour::inline internal
