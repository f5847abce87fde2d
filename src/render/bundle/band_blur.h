// hullin2011 4.2, spectral rendering: a few wavelength bands, each blurred along the way to its neighbours so that
// the gaps between them are bridged.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contrejour/frame.h"
#include "render/bundle/flux_box.h"
#include "render/bundle/map_figures.h"

namespace contrejour::bundle {

// With more bands than this the gaps are small, and nothing is blurred.
inline constexpr std::size_t kMostBlurredBands = 7;

// Where a point of a ghost in one band lies in a neighbouring one, by the ghosts' centres and sizes in both.
struct BandMotion {
  Vec2 centre_px;    // in this band
  Vec2 to_before{}, to_after{};              // displacement of the centre to the middle of the gap, pixels
  Vec2 growth_before{}, growth_after{};      // and of a point one pixel from the centre

  [[nodiscard]] Vec2 start(Vec2 p) const;    // of the line that a point is spread over
  [[nodiscard]] Vec2 end(Vec2 p) const;
};

// One for each band, in order of wavelength; bands without light (nullopt) and those without neighbours stay as
// they are. At either end of the spectrum the line goes as far out as in.
[[nodiscard]] std::vector<std::optional<BandMotion>> band_motions(std::span<const std::optional<MapFigures>> bands,
                                                                  const Frame& frame);

// The farthest that flux moves from its pixel, anywhere in the full frame.
[[nodiscard]] double longest_way_px(const BandMotion& motion, const Frame& frame);

// Every pixel's flux spread evenly over its line. The band is drawn with a border of so many pixels around the
// frame; what leaves the frame is lost.
// Differs: the paper's kernel is one for the whole ghost; here it follows the ghost's growth as well.
[[nodiscard]] FluxBox blurred(const FluxBox& band, const BandMotion& motion, const Frame& frame, int border);

}  // namespace contrejour::bundle
