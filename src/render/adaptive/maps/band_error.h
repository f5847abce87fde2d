// How wrong edges are that several wavelengths show side by side, where all are drawn at one place.
#pragma once

#include <span>

namespace contrejour::adaptive {

// One wavelength's edge, on a line across it.
struct SpectralEdge {
  double place_px = 0;
  double light = 0;  // its step
};

// Squared difference of the edges, a pixel wide each, and one with the light of all at `drawn_px`: summed over the
// line's pixels, in the mean over where these may lie.
[[nodiscard]] double band_error(std::span<const SpectralEdge> edges, double drawn_px);

// Where one edge errs least: displacements much less than a pixel then cancel.
[[nodiscard]] double middle_of_light(std::span<const SpectralEdge> edges);

}  // namespace contrejour::adaptive
