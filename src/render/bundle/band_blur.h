// SPDX-License-Identifier: Apache-2.0
// hullin2011 4.2, spectral rendering: a few wavelength bands, each blurred along the displacement to its neighbours so
// that the gaps between them are bridged.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/frame.h"
#include "render/bundle/flux_box.h"
#include "render/bundle/map_figures.h"

namespace contrejour::inline internal::bundle {

// With more bands than this the gaps are small, and no band is blurred.
inline constexpr std::size_t kMaxBlurredBands = 7;

// The displacement of a ghost's points from one band to its neighbours, from the ghosts' centres and sizes in both.
struct BandMotion {
  Vec2 centre_px;    // in this band
  Vec2 to_before{}, to_after{};              // displacement of the centre to the middle of the gap, pixels
  Vec2 growth_before{}, growth_after{};      // what the displacement gains per pixel from the centre

  [[nodiscard]] Vec2 start(Vec2 p) const;    // of the line that a point is spread over
  [[nodiscard]] Vec2 end(Vec2 p) const;
};

// One for each band, in order of wavelength; bands without light (nullopt) and bands without neighbours are not
// blurred. At either end of the spectrum the line is extended outwards by as much as inwards.
[[nodiscard]] std::vector<std::optional<BandMotion>> band_motions(std::span<const std::optional<MapFigures>> bands,
                                                                  const Frame& frame);

// The longest distance that flux moves from its pixel, anywhere in the full frame.
[[nodiscard]] double longest_shift_px(const BandMotion& motion, const Frame& frame);

struct BlurOptions {
  int border = 0;  // the pixels around the frame with which the band was drawn
  const Context& context;  // once it is cancelled, the result is incomplete
};

// Spreads every pixel's flux evenly over its line. Light that leaves the frame is lost.
// Differs: the paper's kernel is one for the whole ghost; here it follows the ghost's growth as well.
[[nodiscard]] FluxBox blurred(const FluxBox& band, const BandMotion& motion, const Frame& frame,
                              const BlurOptions& options);

}  // namespace contrejour::inline internal::bundle
