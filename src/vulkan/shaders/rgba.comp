// SPDX-License-Identifier: Apache-2.0
// Turns pixels of the picture into RGBA with an alpha of 0, as floats or half floats, one pixel an invocation. Floats
// pass as words, so that no bit of them changes.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 3) writeonly buffer Pixels { uint pixels[]; };  // the memory of Rays, buffers.glsl
layout(std430, set = 0, binding = 7) readonly buffer Picture { uint picture[]; };
// RgbaParameters of src/vulkan/picture_writer.cpp.
layout(push_constant) uniform Parameters {
  uint first, count;  // pixels of the picture
  uint is_half;
}
p;

#define LARGEST_HALF 65504.0

uint half_words(vec2 values) { return packHalf2x16(clamp(values, vec2(-LARGEST_HALF), vec2(LARGEST_HALF))); }

void main() {
  uint k = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (k >= p.count) return;
  uint from = 3u * (p.first + k);
  uvec3 rgb = uvec3(picture[from], picture[from + 1u], picture[from + 2u]);
  if (p.is_half != 0u) {
    pixels[2u * k] = half_words(uintBitsToFloat(rgb.rg));
    pixels[2u * k + 1u] = half_words(vec2(uintBitsToFloat(rgb.b), 0.0));
    return;
  }
  pixels[4u * k] = rgb.r;
  pixels[4u * k + 1u] = rgb.g;
  pixels[4u * k + 2u] = rgb.b;
  pixels[4u * k + 3u] = 0u;
}
