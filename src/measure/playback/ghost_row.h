// SPDX-License-Identifier: Apache-2.0
// Distances from a ghost's outline, and the ghost added to pixels of a row, for a SIMD packet of pixels at a time.
// Accuracy: distances within 2e-3 pixels + 1e-5 of the ghost's size of those of nearest_point(); levels within 2e-3 of
// the border's. Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstddef>

#include "contrejour/expert/measured_flare.h"

namespace contrejour::inline internal {

// A ghost as the kernels take it. Lengths are in pixels. x is along the line from the optical centre to the light, y
// perpendicular to it; both are relative to the middle of the ghost's axis.
struct GhostPacket {
  std::array<std::array<float, 4>, 2> x{}, y{};  // left and right cubic: coefficients of 1, t, t^2, t^3
  float fade_in = 0, fade_out = 0, slope_in = 1, slope_out = 1;
  std::array<float, 3> border{}, inside{};  // levels of a pixel
  // The profile is added to the inside's level (ghost_profile.h): its terms, and the places' scales: 1 / half axis.
  bool has_profile = false;
  std::array<std::array<float, kProfileTerms>, 3> profile{};
  float clip_x = 0, clip_radius = 0;  // the circle that cuts the outline; radius 0: none
  float per_left = 0, per_right = 0, per_height = 0;
};

// Points of a line across the picture: the first, and the step to the next.
struct PixelLine {
  float x = 0, y = 0;
  float step_x = 0, step_y = 0;
};

void ghost_distances(const GhostPacket& ghost, const PixelLine& line, std::size_t count, float* distances);

// Adds the ghost to `count` pixels of three floats.
void add_ghost(const GhostPacket& ghost, const PixelLine& line, std::size_t count, float* rgb);
// The same where the inside's weight is 1.
void add_inside(const GhostPacket& ghost, const PixelLine& line, std::size_t count, float* rgb);

}  // namespace contrejour::inline internal
