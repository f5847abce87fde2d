// A ghost of a light, or of a piece of one, as a frame shows it: where it lies, how bright it is, how it is blurred,
// and what is wrong where one linear map of the light's directions stands for the motion of all its parts.
#pragma once

#include <vector>

#include "contrejour/frame.h"
#include "render/area/blur_error.h"
#include "render/area/ghost_motion.h"
#include "render/area/light_pieces.h"

namespace contrejour::area {

// GhostFeature in pixels of the frame.
struct BlurFeature {
  Vec2 normal, at_px;
  Vec2 shift_px;  // along the normal, by tangents
  double height = 0.0;  // how much brighter one side of it is than the other once blurred, at most; pixel values
  double length_px = 0.0;  // of the lines that it stands for
};

struct GhostBlur {
  LinearMap px = kNowhere;  // of the frame, from tangents: the map that suits its features best
  LinearMap motion_px = kNowhere;  // likewise, with its orientation where `px` leaves that out
  Vec2 blur_px, size_px;  // radii across the shorter and the longer axis: of the light under that map, of the ghost
  Vec2 at_px;
  double area_px = 1.0;  // of the blurred ghost
  double level = 0.0;  // its brightness, a pixel's value; 0: none is in the frame
  double flux = 0.0;  // of all of it, pixel values
  std::vector<BlurFeature> features;

  // Over the picture's peak.
  [[nodiscard]] BlurredGhost over(double peak) const { return {blur_px, size_px, peak > 0.0 ? level / peak : 0.0}; }
};

// value: a pixel's, for an irradiance over the light's. shift_mm: that the ghost is set off by.
[[nodiscard]] GhostBlur blur_of(const GhostMotion& motion, const LightPiece& piece, const Frame& frame, Vec2 shift_mm,
                                double value);

// The same as if of the soft piece (light_pieces.h), as wide as this one.
[[nodiscard]] GhostBlur softened(GhostBlur ghost, const LightPiece& piece);

// Errors squared and summed over the frame's pixels, in squares of the peak, where the light is blurred by that map.
// is_exact: the map's orientation counts; else, for discs and soft pieces of lights, only how wide it makes them.
[[nodiscard]] double map_error(const GhostBlur& ghost, const LinearMap& px, const LightPiece& piece, double peak);

// The level that the brightest kPeakShare of the frame reach, with ghosts as even discs.
inline constexpr double kPeakShare = 0.002;
[[nodiscard]] double peak_of(const std::vector<GhostBlur>& ghosts, const Frame& frame);

// Radii across the shorter and the longer axis of a disc with that covariance: twice the standard deviation.
[[nodiscard]] Vec2 radii_of(const LinearMap& covariance);

}  // namespace contrejour::area
