// Rings averaged over pixels: a pixel is a square, whose chords across a direction are a trapezoid (pixel_profile.h).
// Means are taken along each ring, and across rings where those are narrower than pixels.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "diffraction/starburst_rings.h"

namespace contrejour {

// Rows that are given before an octave's first and after its last, so that pixels there are whole.
inline constexpr std::size_t kRowMargin = 2;
inline constexpr std::size_t kRowsGiven = kRowsPerOctave + 1 + 2 * kRowMargin;

// StarburstOctave::rgb0 from the bins' mean densities, [((row + kRowMargin) * bins + bin) * 4 + channel]; first_px: the
// octave's first radius. One row of it.
void average_over_pixels(std::span<const float> bins_rgb0, std::size_t bins, double first_px, std::size_t row,
                         float* to);

}  // namespace contrejour
