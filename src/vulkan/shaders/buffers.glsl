// SPDX-License-Identifier: Apache-2.0
// The buffers of all shaders. Sizes and layouts are those of src/vulkan/layout.h.
#define FAILED 3.0e38  // relative height of a ray that fails
#define MAX_CROSSINGS 3

// By ray: pixel coordinates, transmission (of grids times Parameters::triangle_weight), relative height.
layout(std430, set = 0, binding = 3) buffer Rays { vec4 rays[]; };
layout(std430, set = 0, binding = 4) buffer Crossings { vec2 crossings[]; };  // MAX_CROSSINGS a ray, stop radii
layout(std430, set = 0, binding = 5) buffer Sums { uint sums[]; };            // low and high words by pixel
layout(std430, set = 0, binding = 6) buffer Counters { uint counters[]; };    // counts.glsl
layout(std430, set = 0, binding = 7) buffer Picture { float picture[]; };
layout(std430, set = 0, binding = 9) buffer Large { uint large[]; };              // 16 words a polygon
layout(std430, set = 0, binding = 10) buffer LargeCorners { vec2 large_corners[]; };
layout(std430, set = 0, binding = 11) buffer Blocks { float blocks[]; };  // of merged cells
layout(std430, set = 0, binding = 13) buffer Vertices { vec2 vertices[]; };  // by ray: irradiance, > 0 where blocked
layout(std430, set = 0, binding = 18) buffer TileCounts { uint tile_counts[]; };  // by tile: polygons, and those listed
layout(std430, set = 0, binding = 19) buffer TileFirst { uint tile_first[]; };    // by tile: where its list begins
layout(std430, set = 0, binding = 20) buffer TileLists { uint tile_lists[]; };    // polygons by tile
layout(std430, set = 0, binding = 21) buffer Indirect { uint indirect[]; };       // group counts of dispatches
layout(std430, set = 0, binding = 23) buffer Wide { uint wide[]; };  // polygons
layout(std430, set = 0, binding = 25) buffer TileTasks { uvec4 tile_tasks[]; };  // lists/task.glsl
// The buffers above under other names, for shaders that read what others have written. lavapipe reads these for all
// invocations at once, and storage buffers in a loop over them. A shader that writes a buffer reads it by its own name.
layout(set = 0, binding = 28) uniform samplerBuffer table_texels;  // by value of reflectances: it and the next
layout(set = 0, binding = 29) uniform samplerBuffer ray_texels;
layout(set = 0, binding = 30) uniform samplerBuffer crossing_texels;
layout(set = 0, binding = 31) uniform samplerBuffer vertex_texels;
layout(set = 0, binding = 32) uniform samplerBuffer bound_texels;  // of the iris, two a bound
layout(set = 0, binding = 33) uniform usamplerBuffer large_texels;  // four a polygon
layout(set = 0, binding = 34) uniform samplerBuffer corner_texels;
layout(set = 0, binding = 35) uniform usamplerBuffer list_texels;
layout(set = 0, binding = 36) uniform samplerBuffer block_texels;
layout(set = 0, binding = 37) uniform samplerBuffer float_texels;     // of paths: numbers, four a texel
layout(set = 0, binding = 38) uniform isamplerBuffer integer_texels;  // of paths, four a texel

// Whether the device is a processor, which wants other code where this constant is asked for.
layout(constant_id = 3) const bool ON_PROCESSOR = false;

#ifdef DOUBLE
#define real double
#else
#define real float
#endif

#define FLAG_CIRCLE 1u      // the iris is the unit circle

float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }
bool failed(vec4 ray) { return ray.w >= 0.5 * FAILED; }
#ifdef READ_TEXELS
vec4 ray_of(uint ray) { return texelFetch(ray_texels, int(ray)); }
vec2 vertex_of(uint ray) { return texelFetch(vertex_texels, int(ray)).xy; }
vec2 crossing(uint ray, uint c) { return texelFetch(crossing_texels, int(ray * MAX_CROSSINGS + c)).xy; }
uvec4 large_quarter(uint k) { return texelFetch(large_texels, int(k)); }  // four quarters a polygon
vec2 large_corner(uint k) { return texelFetch(corner_texels, int(k)).xy; }
#else
vec4 ray_of(uint ray) { return rays[ray]; }
vec2 vertex_of(uint ray) { return vertices[ray]; }
vec2 crossing(uint ray, uint c) { return crossings[ray * MAX_CROSSINGS + c]; }
uvec4 large_quarter(uint k) { return uvec4(large[4u * k], large[4u * k + 1u], large[4u * k + 2u], large[4u * k + 3u]); }
vec2 large_corner(uint k) { return large_corners[k]; }
#endif
vec4 bound_half(uint k) { return texelFetch(bound_texels, int(k)); }  // two halves a bound
float irradiance_at(uint ray) { return vertex_of(ray).x; }  // 0 where the map is not smooth
bool passes(uint ray) { return vertex_of(ray).y <= 0.0; }

// The number of an invocation in a dispatch of one or more rows of groups.
uint linear_invocation() {
  return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}
