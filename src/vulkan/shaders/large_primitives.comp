// SPDX-License-Identifier: Apache-2.0
// Draws the listed primitives, one tile a workgroup, one pixel an invocation: as large_cells.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "bindings.glsl"
#include "tile.glsl"
#include "iris.glsl"
#include "primitive.glsl"

void main() {
  ivec2 pixel = begin_tile();
  uint count = min(counters[COUNT_LARGE], p.large_capacity);
  for (uint from = 0u; from < count; from += TILE_PIXELS) {
    uint reaching = find_reaching(from, count);
    for (uint k = 0u; k < reaching; ++k) {
      uint word = 16u * reaching_polygons[k];
      if (!contains(word, pixel)) continue;
      uint flags = large[word + 8u];
      Primitive q = Primitive(uvec4(large[word], large[word + 1u], large[word + 2u], large[word + 3u]),
                              vec4(word_float(word + 4u), word_float(word + 5u), word_float(word + 6u), word_float(word + 7u)),
                              (flags & 1u) != 0u, (flags & 2u) != 0u);
      float flux = light_at(q, pixel, flags >> 2u);
      if (flux != 0.0) add_to_pixel(flux, word + 9u);
    }
    barrier();
  }
  end_tile(pixel);
}
