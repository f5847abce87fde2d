// SPDX-License-Identifier: Apache-2.0
#include "sums.glsl"

// Adds flux to a pixel of the frame.
void add_light(int x, int y, float flux) {
  uint at = 6u * (uint(y) * uint(p.width) + uint(x));
  for (uint c = 0u; c < 3u; ++c) add_to_channel(at + 2u * c, flux * p.gain[c]);
}
