// SPDX-License-Identifier: Apache-2.0
// The tables of stop patterns and dirt, which dim light besides rims and a sharp iris, and the bits of a dispatch's
// flags. Included after ../buffers.glsl.
layout(std430, set = 0, binding = 24) readonly buffer Patterns { uint patterns[]; };  // records, then tables
layout(std430, set = 0, binding = 26) readonly buffer Dirt { uint dirt[]; };  // dirt.glsl

// Whether the iris is a picture: the code for it is long, and other frames are compiled without.
layout(constant_id = 1) const bool HAS_PICTURE = false;

// Bits of the flags, besides FLAG_CIRCLE.
#define FLAG_DIRT_IN_STOP 16u
#define FLAG_DIRT_ON_FRONT 32u
#define FLAG_HALF_TONES 64u  // of a picture as the iris
#define FLAG_DIRT_BY_SQUARES 128u  // grids of rays: dirt is no outlines of shapes
