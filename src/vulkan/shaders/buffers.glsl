// SPDX-License-Identifier: Apache-2.0
// The buffers of all shaders. Sizes and layouts are those of src/vulkan/layout.h.
#define FAILED 3.0e38  // relative height of a ray that fails
#define MAX_CROSSINGS 3

layout(std430, set = 0, binding = 0) readonly buffer Floats { float floats[]; };    // of paths, in float
layout(std430, set = 0, binding = 1) readonly buffer Integers { int integers[]; };  // of paths
layout(std430, set = 0, binding = 2) readonly buffer Tables { float tables[]; };    // reflectances
// By ray: pixel coordinates, transmission, relative height.
layout(std430, set = 0, binding = 3) buffer Rays { vec4 rays[]; };
layout(std430, set = 0, binding = 4) buffer Crossings { vec2 crossings[]; };  // MAX_CROSSINGS a ray, stop radii
layout(std430, set = 0, binding = 5) buffer Sums { uint sums[]; };            // low and high words by pixel and channel
layout(std430, set = 0, binding = 6) buffer Counters { uint counters[]; };    // counts.glsl
layout(std430, set = 0, binding = 7) writeonly buffer Picture { float picture[]; };
layout(std430, set = 0, binding = 8) readonly buffer Bounds { float bounds[]; };  // of the iris, 8 each
layout(std430, set = 0, binding = 9) buffer Large { uint large[]; };              // 16 words a polygon
layout(std430, set = 0, binding = 10) buffer LargeCorners { vec2 large_corners[]; };
layout(std430, set = 0, binding = 11) buffer Blocks { float blocks[]; };  // of merged cells
layout(std430, set = 0, binding = 13) buffer Vertices { vec2 vertices[]; };  // by ray: irradiance, blocked
layout(std430, set = 0, binding = 21) buffer TileCounts { uint tile_counts[]; };  // by tile: polygons, and those listed
layout(std430, set = 0, binding = 22) buffer TileFirst { uint tile_first[]; };    // by tile: where its list begins
layout(std430, set = 0, binding = 23) buffer TileLists { uint tile_lists[]; };    // polygons by tile
layout(std430, set = 0, binding = 24) buffer Indirect { uint indirect[]; };       // group counts of dispatches
layout(std430, set = 0, binding = 26) buffer Wide { uint wide[]; };  // polygons
layout(std430, set = 0, binding = 28) buffer TileTasks { uvec4 tile_tasks[]; };  // lists/task.glsl
#ifdef DOUBLE
layout(std430, set = 0, binding = 12) readonly buffer Doubles { double doubles[]; };  // of paths, in double
#define real double
#define reals doubles
#else
#define real float
#define reals floats
#endif

#define FLAG_CIRCLE 1u      // the iris is the unit circle

float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }
bool failed(vec4 ray) { return ray.w >= 0.5 * FAILED; }
float irradiance_at(uint ray) { return vertices[ray].x; }  // 0 where the map is not smooth
bool passes(uint ray) { return vertices[ray].y <= 0.0; }
vec2 crossing(uint ray, uint c) { return crossings[ray * MAX_CROSSINGS + c]; }

// The number of an invocation in a dispatch of one or more rows of groups.
uint linear_invocation() {
  return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}
