// SPDX-License-Identifier: Apache-2.0
// A window of a frame in finer pixels. A ghost in focus lies within a pixel or two; blurred by a small light, its
// place within the pixel shows, which the frame's own pixels do not keep: drawn in them, it would jump from pixel to
// pixel as the light moves.
#pragma once

#include "contrejour/frame.h"
#include "contrejour/image.h"

namespace contrejour::inline internal::area {

struct FineWindow {
  int left = 0, top = 0, width = 0, height = 0;  // in pixels of the frame; without pixels: the ghost is outside
  int level = 0;  // as of the image pyramid, negative: pixels are 2^level as long along each side as the frame's
  // By how many fine pixels pictures are displaced to the right and down, so that the spot lies in the middle of one: a
  // pixel does not keep where in it a smaller spot lies.
  Vec2 moved;
};

// The window around a spot whose light falls within `radius_px`, and as much farther as other wavelengths may take it.
[[nodiscard]] FineWindow window_around(Vec2 at_px, double radius_px, const Frame& frame, int level);

// Its pictures are displaced.
[[nodiscard]] Frame fine_frame(const FineWindow& window, const Frame& frame);

// The picture of a window in the frame's pixels, each of which holds the flux of the finer ones.
[[nodiscard]] Image gathered(const FineWindow& window, const Image& fine);

}  // namespace contrejour::inline internal::area
