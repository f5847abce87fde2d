// SPDX-License-Identifier: Apache-2.0
// Which colour a pixel of a Bayer mosaic sees.
// Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstddef>

#include "contrejour/expert/capture.h"

namespace contrejour::inline internal {

// Channels (0 red, 1 green, 2 blue) of a block's four pixels: top left, top right, bottom left, bottom right.
[[nodiscard]] constexpr std::array<std::size_t, 4> channels_of(BayerPattern pattern) {
  switch (pattern) {
    case BayerPattern::Rggb: return {0, 1, 1, 2};
    case BayerPattern::Bggr: return {2, 1, 1, 0};
    case BayerPattern::Grbg: return {1, 0, 2, 1};
    case BayerPattern::Gbrg: return {1, 2, 0, 1};
  }
  return {0, 1, 1, 2};
}

[[nodiscard]] constexpr std::size_t channel_at(BayerPattern pattern, int x, int y) {
  return channels_of(pattern)[static_cast<std::size_t>(2 * (y % 2) + x % 2)];
}

}  // namespace contrejour::inline internal
