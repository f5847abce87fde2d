// SPDX-License-Identifier: Apache-2.0
// The point at which a ray crosses the plane of the first vertex: DirtSite::front_point(). Included after
// item_start.glsl.

// The point in the lens's frame, mm. entrance: from the window's lower corner.
vec2 front_point(uint item, vec2 entrance) {
  vec3 along = vec3(start_real_of(item, START_DX), start_real_of(item, START_DY), start_real_of(item, START_DZ));
  if (start_real_of(item, START_DIVERGES) != 0.0) along.xy += entrance * start_real_of(item, START_PER_DISTANCE);
  vec2 from = vec2(start_real_of(item, START_X), start_real_of(item, START_Y));
  return from + entrance + along.xy * (p.front_gap / along.z);
}
