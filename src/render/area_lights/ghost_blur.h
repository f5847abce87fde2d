// SPDX-License-Identifier: Apache-2.0
// A ghost of a light, or of a piece of one, as it appears in a frame: its position, its brightness, its blur, and the
// error of using one linear map of the light's directions for the motion of all its parts.
#pragma once

#include <limits>
#include <vector>

#include "contrejour/frame.h"
#include "render/area_lights/blur_error.h"
#include "render/area_lights/ghost_motion.h"
#include "render/area_lights/light_pieces.h"

namespace contrejour::inline internal::area {

// A GhostLine in pixels of the frame.
struct BlurredLine {
  Vec2 normal, at_px;
  Vec2 shift_px;  // along the normal, for a unit of each tangent
  double height = 0.0;  // largest difference of level across the blurred line; pixel values
  double length_px = 0.0;  // length of the lines that it represents
};

struct GhostBlur {
  LinearMap px = kZeroMap;  // from tangents to pixels of the frame: the map that fits its lines best
  LinearMap motion_px = kZeroMap;  // the same with the map's rotation, where `px` omits it
  Vec2 blur_px, size_px;  // radii across the shorter and the longer axis: of the blur, and of the ghost
  Vec2 at_px;
  double area_px = 1.0;  // over which the light in the frame is spread, blurred
  double level = 0.0;  // brightness of the blurred ghost, a pixel's value; 0: outside the frame
  double flux = 0.0;  // of the whole ghost, pixel values
  double visible = 0.0;  // the fraction of the pupil whose light lands in the frame
  std::vector<BlurredLine> lines;

  // Relative to the picture's peak.
  [[nodiscard]] BlurredGhost over(double peak) const { return {blur_px, size_px, peak > 0.0 ? level / peak : 0.0}; }
};

// The distance of a point from the frame's border; negative outside.
[[nodiscard]] double inside_px(const Frame& frame, Vec2 px);

// The length of the blurred ghost's outline.
[[nodiscard]] double outline_px(const GhostBlur& ghost);

// value: a pixel's value for an irradiance equal to the light's. shift_mm: the ghost's offset.
[[nodiscard]] GhostBlur blur_of(const GhostMotion& motion, const LightPiece& piece, const Frame& frame, Vec2 shift_mm,
                                double value);

// The same ghost, of a light that is so much dimmer.
[[nodiscard]] GhostBlur dimmed(GhostBlur ghost, double factor);

// The same ghost, blurred by the soft piece (light_pieces.h) as widely as by this piece.
[[nodiscard]] GhostBlur softened(GhostBlur ghost, const LightPiece& piece);

// The squared error, summed over the frame's pixels in squares of the peak, of blurring the ghost by this map. For
// discs and soft pieces only the width of the blur counts; for other pieces the map's rotation does, too. An error
// above `enough` may be given as any value above it, which saves the rest of the sum.
[[nodiscard]] double map_error(const GhostBlur& ghost, const LinearMap& px, const LightPiece& piece, double peak,
                               double enough = std::numeric_limits<double>::infinity());

// The ghost as its own map blurs it: its lines move as the map says, and the outline of the blur is among them. Its
// map_error for another map is the difference between pictures drawn with the two maps.
[[nodiscard]] GhostBlur as_drawn(GhostBlur ghost, const LightPiece& piece);

// The radii, across the shorter and the longer axis, of a uniform ellipse with that covariance: twice the standard
// deviations.
[[nodiscard]] Vec2 radii_of(const LinearMap& covariance);

}  // namespace contrejour::inline internal::area
