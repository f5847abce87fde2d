// SPDX-License-Identifier: Apache-2.0
// The error of drawing the edges of several wavelengths, which lie side by side, at one position.
#pragma once

#include <span>

#include "contrejour/expert/colour.h"

namespace contrejour::inline internal::adaptive {

// The edge of one wavelength, on a line across it.
struct SpectralEdge {
  double position_px = 0;
  Rgb light{};  // height of its step, by channel
};

// The sum of its channels.
[[nodiscard]] constexpr double all_light(const SpectralEdge& edge) {
  return edge.light[0] + edge.light[1] + edge.light[2];
}

// The squared difference between the edges, each a pixel wide, and one edge with the light of all at `drawn_px`: summed
// over the pixels of the line, averaged over their positions and over the channels. In the sum of the channels, the
// displacements of a ghost's red and blue rims would cancel.
[[nodiscard]] double band_error(std::span<const SpectralEdge> edges, double drawn_px);

// The position at which one edge for all makes the least error: displacements much smaller than a pixel then cancel.
[[nodiscard]] double middle_of_light(std::span<const SpectralEdge> edges);

}  // namespace contrejour::inline internal::adaptive
