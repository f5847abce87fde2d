// A light's chief ray through a lens of any kind, by Newton's steps in both directions of the plane of the first
// vertex.
#pragma once

#include <optional>

#include "contrejour/trace.h"

namespace contrejour {

inline constexpr double kAimed = 1e-10;  // of the stop radius, off its centre
inline constexpr int kAimSteps = 40;

struct ChiefRay {
  Vec2 at_mm;  // in that plane
  Vec2 landing_mm;
};

// From a first guess of its place. None if it gets lost.
[[nodiscard]] std::optional<ChiefRay> aim_chief(const OpticalPath& path, const LightSource& source, Vec2 at_mm);

}  // namespace contrejour
