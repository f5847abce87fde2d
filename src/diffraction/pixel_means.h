// SPDX-License-Identifier: Apache-2.0
// Rings averaged over pixels: a pixel is a square, whose chords across a direction are a trapezoid (pixel_profile.h).
// Means are taken along each ring, and across rings where rings are narrower than pixels.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "diffraction/starburst_rings.h"

namespace contrejour::inline internal {

// Extra rows in front of an octave's first and behind its last, so that pixels there are complete.
inline constexpr std::size_t kRowMargin = 2;
inline constexpr std::size_t kRowsGiven = kRowsPerOctave + 1 + 2 * kRowMargin;

// Computes one row of StarburstOctave::rgb0 from the bins' mean densities, [((row + kRowMargin) * bins + bin) * 4 +
// channel]; first_px: the octave's first radius.
void average_over_pixels(std::span<const float> bins_rgb0, std::size_t bins, double first_px, std::size_t row,
                         float* to);

}  // namespace contrejour::inline internal
