// SPDX-License-Identifier: Apache-2.0
// The second difference of a ray's values along a side of a cell, from four rays in a row, of which the side joins the
// second and the third: the mean of those at its two ends. Rays beyond a rim may meet surfaces at angles at which these
// reflect much more: beside one, the smaller difference of the light and of heights counts more if the two differ much
// (the limiter of van Albada, van Leer and Roberts, 1982). exists: whether there are the first and the last one.
vec4 bend_of_side(vec4 rays[4], bvec2 exists) {
  vec4 before = rays[0] - 2.0 * rays[1] + rays[2], after = rays[1] - 2.0 * rays[2] + rays[3];
  if (!exists.x) return exists.y ? after : vec4(0.0);
  if (!exists.y) return before;
  vec4 bend = 0.5 * (before + after);
  if (max(rays[0].w, rays[3].w) <= 1.0) return bend;
  vec2 squared_before = before.zw * before.zw, squared_after = after.zw * after.zw;
  bend.zw = (before.zw * squared_after + after.zw * squared_before) / max(squared_before + squared_after, vec2(1e-30));
  return bend;
}
